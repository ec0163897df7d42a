# What the batch script does with signals, with commands in the place of Slurm's: USR1 stops the run and
# puts it back into the queue, TERM of a cancelled job does not, and the third time it is complete.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: long.yaml\nruns: [{layers: [8, 7]}]\n' >study.yaml
mkdir shim
for name in sbatch scontrol squeue; do
	printf '#!/bin/bash\necho "%s $*" >>"$CALLS"\n' $name >shim/$name && chmod +x shim/$name
done
echo 'echo 1' >>shim/sbatch
echo 'cat "$CALLS.state"' >>shim/squeue
export PATH=$PWD/shim:$PATH CALLS=$PWD/calls
: >calls.state
talus campaign run -e slurm study.yaml >/dev/null || exit
: >calls
export SLURM_ARRAY_TASK_ID=1 SLURM_JOB_ID=7
run=$(echo results/study/layers-7*)

task() # SIGNAL STATE
{
	echo "$2" >calls.state
	begun=$(attempts)
	bash results/study/slurm/*.sh &
	wait_for 30 at_work || { echo "the run does not begin" && exit; }
	[[ ! $1 ]] || kill -s "$1" $!
	wait $!
	echo "exit $?, $(talus campaign status study.yaml | awk '/^layers-7/ {print $2}')"
}

attempts()
{
	cat "$run/run.log" 2>/dev/null | grep -c 'at step'
}

at_work() # has it begun once more, and had time for some steps?
{
	(($(attempts) > begun)) && sleep 0.2
}

task USR1 'SIGNALING None'
task TERM 'COMPLETING None'
task USR1 'COMPLETING TimeLimit'
grep -v user calls | sort | uniq -c
task '' 'RUNNING None'
talus run "$run/config.yaml" -o straight -q && talus diff "$run" straight >/dev/null && echo same
# It waits for a run that takes its time to stop.
cat >slow <<'EOF'
#!/bin/bash
trap 'sleep 1; echo "stopped by $1" >"$STOPPED"; exit 75' USR1
echo 'begun at step 0'
while :; do sleep 0.05; done
EOF
chmod +x slow
export STOPPED=$PWD/stopped
sed -i "s|^program=.*|program=$PWD/slow|" results/study/slurm/*.sh
task USR1 'RUNNING None' >/dev/null
cat stopped

mv "$run/run.log" kept && ln -s "$PWD/outside" "$run/run.log"
bash results/study/slurm/*.sh | sed "s|$PWD|PWD|" | mask
echo "exit ${PIPESTATUS[0]}"
[[ ! -e outside ]] || echo "it wrote through a link"
rm -r "$run"
bash results/study/slurm/*.sh | sed "s|$PWD|PWD|" | mask
