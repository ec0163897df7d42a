# a solver that does not converge: exit 1, the last good checkpoint stays, and only --retry starts anew
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
fails=(--set pressure_solver.method=block-gauss-seidel
	--set pressure_solver.criterion=increment --set pressure_solver.max_iterations=3 --set checkpoint.every_steps=1)
talus run small.yaml "${fails[@]}"
echo "$?"
talus run small.yaml "${fails[@]}"
echo "$?"
talus verify results/small
talus run small.yaml "${fails[@]}" --retry
echo "$?"
grep -E '^(state|attempts|reason):' results/small/status.yaml
talus run small.yaml
echo "$?"
talus run small.yaml --retry | clocks
talus verify results/small
