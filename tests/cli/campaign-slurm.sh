# The executor of clusters with commands in the place of Slurm's: the script, what is submitted and what is
# not, queue states beside run states. (make slurm-check has a real Slurm.)
source "$TALUS_ROOT/tests/cli/slurm-parts.bash"
cat >study.yaml <<'EOF'
title: "A study\n#SBATCH --wrap=none"
base: collapse.yaml
runs: [{layers: [4, 2, 3]}]
slurm:
  partition: short
  time: 90 min
  grace: 2 min
  memory: 2 GB
  throttle: 2
  directives: {account: granular, exclusive: true, hint: false}
EOF
program=$(command -v talus)

echo '--- without Slurm'
mkdir none
PATH=$PWD/none "$program" campaign run -e slurm study.yaml
echo "exit $?"
PATH=$PWD/none "$program" campaign run -e slurm --dry-run study.yaml | slurm_mask
ls results/study/slurm 2>&1

PATH=$PWD/shim:$PATH

echo '--- submitted in two arrays, one after the other'
echo 'Invalid partition name' >refuse
talus campaign run -e slurm study.yaml 2>&1 | slurm_mask
rm refuse
talus campaign run -e slurm study.yaml 2>&1 | slurm_mask
sed "s|$PWD|PWD|g" calls | slurm_mask
mask results/study/slurm/*.runs | sort | uniq -c
talus campaign status study.yaml | mask

echo '--- what is in the queue is not submitted again, what has left it is; --jobs is the throttle'
talus campaign run -e slurm study.yaml
rm queue/2
sed -i 's/PENDING/RUNNING/; s/Resources/None/' queue/3
talus campaign run -e slurm -n -j 7 study.yaml | grep -E 'array|job-name' | slurm_mask
talus campaign run -e slurm -j 7 study.yaml 2>&1 | slurm_mask
talus campaign status study.yaml | mask
talus campaign status --json study.yaml | python3 -c '
import json, sys
print(json.load(sys.stdin)["runs"][2]["queue"])'

echo '--- a timed run waits for all that is in the queue'
{ cat study.yaml && echo 'timing: true'; } >timed.yaml
sed -i '$d' queue/4
talus campaign run -e slurm -o results/study timed.yaml | mask | sed "s/([^)]*)/(NAME)/"
tail -n 1 calls | grep -o 'array=.*afterany[:0-9]*'

echo '--- runs that are complete or failed, a queue that is silent, two submissions at once'
rm queue/*
talus campaign run -j 1 study.yaml >/dev/null
talus campaign run -e slurm study.yaml
shim squeue 'echo "squeue: error: Unable to contact slurm controller" >&2; exit 1'
talus campaign run -e slurm study.yaml
echo "exit $?"
talus campaign status study.yaml | tail -n 1
rm -r results/study/layers-*
shim squeue true
talus campaign run -e slurm --set time.cfl=0.4 -o out/ study.yaml >/dev/null && ls out/slurm | wc -l
python3 - <<'EOF'
import fcntl, struct, subprocess
lock = open("results/study/slurm/submit.lock", "r+")
fcntl.fcntl(lock, 37, struct.pack("hhqqi", fcntl.F_WRLCK, 0, 0, 0, 0)) # F_OFD_SETLK
code = subprocess.run(["talus", "campaign", "run", "-e", "slurm", "study.yaml"], stderr=subprocess.PIPE)
print(b"is locked by" in code.stderr, code.returncode)
EOF
