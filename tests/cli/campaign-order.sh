# The longest expected run comes first, unless the order of the experiment is asked for.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
base: collapse.yaml
runs: [{layers: [2, 8], time.end: [0.3 s, 0.2 s]}, {pressure: hydrostatic, layers: 5}]
END
masked talus campaign run -j 1 study.yaml | sed 's/:.*//'
masked talus campaign run -j 1 -o given --order given study.yaml | sed 's/:.*//'
talus campaign run --order backwards study.yaml
echo "exit $?"
talus campaign status --timeout 3 study.yaml
echo "exit $?"
talus campaign run --timeout 3m study.yaml
echo "exit $?"
