# The life of a campaign in a queue: what goes on from a shorter run waits for it, retry submits the
# failed runs alone, cancel takes all back, and why, watch and status tell of the queue.
source "$TALUS_ROOT/tests/cli/slurm-parts.bash"
PATH=$PWD/shim:$PATH
submit() # ACTION OPTION...: what is said, what sbatch is told, and what the tasks tell `talus run`
{
	rm -f calls
	talus campaign "$1" -e slurm "${@:2}" study.yaml 2>&1 | slurm_mask
	sed -E 's/.*(--array=[^ ]*)( --dependency=[^ ]*)?.*/\1\2/' calls
	sed -E 's/.*--job-name=([^ ]*).*/\1/' calls | while read -r name; do
		mask "results/study/slurm/$name.runs"
	done
}

echo '--- a longer run waits for the shorter one, also for one that an earlier command submitted'
printf 'base: collapse.yaml\nruns: [{layers: [2, 1], time.end: [0.2 s, 0.3 s, 0.4 s]}]\n' >study.yaml
submit run
rm queue/3
mv queue/2 queue/22 && sed -i s/^2_/22_/ queue/22
submit run
talus campaign why study.yaml layers-2_end-0.4s | grep -E 'state|queue|next'
echo '--- where nothing lies ahead it goes on from what is there'
rm queue/*
printf 'base: collapse.yaml\nruns: [{layers: [2, 1], time.end: 0.2 s}]\n' >short.yaml
talus campaign run -j 2 -o results/study short.yaml >/dev/null
submit run
sed -i 's/0.2 s, 0.3 s, //' study.yaml
rm queue/*
submit run

echo '--- retry: the failed run alone, whatever else is to be done'
rm -r queue/* results
printf 'base: collapse.yaml\nset: {pressure_solver.method: block-gauss-seidel}\nruns: [{pressure_solver.max_iterations: [1, 2, 20000]}]\n' >study.yaml
talus campaign run -j 1 -m 1 --order given study.yaml >/dev/null 2>&1
submit retry
talus campaign status study.yaml | mask | sed -E 's/(talus: step).*/\1/' | cut -c 1-100
rm queue/*
submit run --retry 1

echo '--- cancel'
shim scancel 'echo "scancel $*" >>calls; rm -f queue/*'
talus campaign cancel study.yaml
echo "exit $?"
tail -n 1 calls
talus campaign status study.yaml | tail -n 1
shim squeue 'echo "squeue: error: Unable to contact slurm controller" >&2; exit 1'
talus campaign cancel study.yaml
echo "exit $?"
talus campaign why study.yaml 2>&1 >/dev/null

echo '--- what a queue cannot do'
talus campaign run -e slurm --timeout 2h study.yaml
echo "exit $?"
talus campaign retry -e slurm --max-failures 3 study.yaml
echo "exit $?"

echo '--- words of the queue do not speak to the terminal'
shim squeue 'cat queue/* 2>/dev/null; :'
rm -rf queue/* results
REASON=$'\e]0;owned\a' talus campaign run -e slurm study.yaml >/dev/null
for action in status why; do
	talus campaign $action study.yaml >out 2>&1
	echo "$action: $(grep -c owned out) owned, $(grep -c $'[\e\a]' out) spoken"
done
