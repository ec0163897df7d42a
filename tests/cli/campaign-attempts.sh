# --retry N starts what failed anew until it has failed N times and once more, over commands; why each
# attempt ended is kept. --max-failures, --timeout, `retry`.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
base: collapse.yaml
runs: [{pressure_solver.max_iterations: [1, 2, 3]}, {layers: 2}]
END
attempts()
{
	talus campaign status --json study.yaml | python3 -c '
import json, sys
print(*[(run["state"], run["attempts"], run["failures"]) for run in json.load(sys.stdin)["runs"]])'
}
masked talus campaign run -j 1 --order given --max-failures 2 study.yaml
echo "exit $?"
attempts
masked talus campaign run -j 1 --order given --retry 2 study.yaml >/dev/null
echo "exit $?"
attempts
echo "-- the limit is reached"
talus campaign run --retry 2 study.yaml >/dev/null 2>&1
attempts
run=$(ls results/study | grep iterations-1)
sed -n '/^ended/,$p' "results/study/$run/status.yaml" | mask
echo "-- retry starts one run anew, all the same"
masked talus campaign retry study.yaml max_iterations-1 2>&1 | head -n 2
attempts
masked talus campaign retry --dry-run study.yaml
masked talus campaign retry study.yaml nothing
echo "exit $?"
masked talus campaign retry study.yaml max
echo "exit $?"

echo "-- a time limit stops a run with its checkpoint, and the next command goes on with it"
printf 'base: long.yaml\nset: {time.end: 30 s}\n' >endless.yaml
talus campaign run --timeout 1.5 --retry 1 endless.yaml >out 2>err
echo "exit $?"
mask out
sed -E 's/base-[0-9a-f]*/RUN/; s/t = .*/t = T/' err
grep -h -o -E 'attempt 2: resumed at step [1-9]|campaign: stopped.*' results/endless/*/run.log | sed 's/[1-9]$/N/'
talus campaign status --json endless.yaml | grep -o '"state": "[a-z]*", "progress": 0\.'
