# Ctrl-C stops all runs with their checkpoints written and exits 75; the same command goes on from there,
# to the same bits as a campaign that was never stopped.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: long.yaml\nruns: [{layers: [8, 7, 6]}]\n' >study.yaml
talus campaign run -j 2 -o undisturbed study.yaml >/dev/null
env --default-signal=INT talus campaign run -j 2 study.yaml >out 2>err & # bash lets it ignore SIGINT
wait_for 30 begun 2 results/study || echo "two runs never ran"
kill -INT $!
wait $!
echo "exit $?"
mask out | sort
cat err
none_running study.yaml || echo "a run was left behind"
talus campaign status study.yaml | awk 'NR > 1 {print $2}' | sort | uniq -c
masked talus campaign run -j 1 study.yaml >out
tail -n 1 out
grep -h -o 'attempt 2: resumed at step [1-9]' results/study/*/run.log | sed 's/[1-9]$/N/'
for run in results/study/*; do talus diff "$run" "undisturbed/${run##*/}" >/dev/null || echo "$run differs"; done
