# a direct method on a grid that hardly any machine has the memory for (105 GB): exit 70, which key, and what would do
for method in block-direct lapack-band; do
	talus run "$TALUS_ROOT/configs/granular-collapse.yaml" -o $method -s pressure_solver.method=$method \
		-s layers=512 -s domain.cells=50000 -s n_ini_guess=0 2>errors
	echo "$?"
	sed -E 's/and [0-9.]+ GB are/and G GB are/' errors
	ls $method
done
