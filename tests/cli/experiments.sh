# Every file in experiments/ runs to its tables, on a coarse grid.
cp -r "$TALUS_ROOT/experiments" "$TALUS_ROOT/configs" .
for experiment in experiments/*.yaml; do
	talus campaign run --set domain.cells=40 "$experiment" >out 2>err || cat out err
	talus-tables --set domain.cells=40 "$experiment" >out || echo "exit $?"
	grep -A 3 ": " out | sed -n 1p
done
