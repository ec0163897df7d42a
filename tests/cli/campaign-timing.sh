# A timing experiment runs one run at a time, also when two commands work on it.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
base: collapse.yaml
timing: true
repeat: 2
set: {domain.cells: 640}
runs: [{layers: [4, 5, 6]}]
END
talus campaign run -j 2 study.yaml >one &
talus campaign run -j 2 study.yaml >two &
most=0
while [[ -n $(jobs -r) ]]; do
	count=$(running study.yaml)
	((count <= most)) || most=$count
done
echo "at most $most at a time"
tail -q -n 1 one two
