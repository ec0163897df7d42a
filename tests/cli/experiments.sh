# Every file in experiments/ runs to its tables and its figures, on a coarse grid.
cp -r "$TALUS_ROOT/experiments" "$TALUS_ROOT/configs" .
for experiment in experiments/*.yaml; do
	talus campaign run --set domain.cells=40 "$experiment" >out 2>err || cat out err
	if grep -q '^tables:' "$experiment"; then
		talus-tables --set domain.cells=40 "$experiment" >out || echo "exit $?"
		grep -A 3 ": " out | sed -n 1p
	fi
	if grep -q '^plots:' "$experiment"; then
		talus plot -f svg --set domain.cells=40 "$experiment" || echo "exit $?"
	fi
done
