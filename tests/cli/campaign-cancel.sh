# cancel stops all campaigns in a folder, with checkpoints written; the next command goes on.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: long.yaml\nset: {time.end: 30 s}\nruns: [{layers: [8, 7, 6, 5]}]\n' >study.yaml
talus campaign cancel study.yaml
talus campaign run -j 1 study.yaml >/dev/null 2>one &
first=$!
talus campaign run -j 1 study.yaml >/dev/null 2>two &
second=$!
wait_for 30 begun 2 results/study || echo "two runs never ran"
talus campaign cancel study.yaml
echo "exit $?"
wait $first
echo "exit $?"
wait $second
echo "exit $?"
cat one two
talus campaign status study.yaml | tail -n 1
