# A failed run does not stop the others; it is reported with the end of its log, is left alone by the
# next command, and is started anew by --retry.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
base: collapse.yaml
set: {pressure_solver.method: block-gauss-seidel}
runs: [{pressure_solver.max_iterations: [1, 20000]}, {layers: 2}]
tables: [{name: t, rows: [pressure_solver.max_iterations, layers], metric: iterations}]
END
masked talus campaign run -j 1 study.yaml
echo "exit $?"
masked talus campaign run -j 1 study.yaml
echo "exit $?"
talus campaign run -j 1 --retry 1 study.yaml >/dev/null 2>&1
grep -h -o 'attempt 2: [a-z]*' results/study/*/run.log
talus campaign run --dry-run --retry 9 study.yaml | mask
masked talus-tables study.yaml | sed -E 's/(Made by talus) .*/\1 BUILD/; s/(Made on) .*/\1 HOST/'
