# Two commands on one folder at the same moment run each run once, and both end well.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: collapse.yaml\nset: {domain.cells: 320}\nruns: [{layers: [2, 3, 4, 5, 6, 7]}]\n' >study.yaml
talus campaign run -j 2 study.yaml >one 2>&1 &
talus campaign run -j 2 study.yaml >two 2>&1
echo "exit $?"
wait $!
echo "exit $?"
tail -q -n 1 one two
for run in results/study/*; do
	[[ $(grep -c 'started at step 0' "$run/run.log") == 1 ]] || echo "$run was not started once"
	! grep -q resumed "$run/run.log" || echo "$run was run twice"
	[[ -z $(ls "$run" | grep -v -e '^run\.' -e '^config.yaml$' -e '^status.yaml$') ]] || ls "$run"
done
