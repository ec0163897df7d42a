# Several files: each right one is printed, each wrong one is told, and the exit code says so.
printf 'slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: %s\n' 1 >one.yaml
printf 'slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: %s\n' 0 >none.yaml
talus check one.yaml none.yaml one.yaml --set domain.cells=20 | grep -e --- -e layers -e cells
echo "exit ${PIPESTATUS[0]}"
talus check -q one.yaml
echo "exit $?"
talus check one.yaml >/dev/full
