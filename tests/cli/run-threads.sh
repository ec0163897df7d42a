# Threads share a run and change nothing in it: no bit of what it records, and not the hash, so that a
# run is found whatever their number.
case=$TALUS_ROOT/configs/granular-collapse.yaml
settings=(--set output.profiles_at=[] --set domain.cells=600 --set time.end=0.02 --set layers=5 --quiet
	--set n_ini_guess=0)

for pressure in hydrostatic non-hydrostatic; do
	for threads in 1 2 3; do
		talus run "$case" "${settings[@]}" --set pressure=$pressure --set threads=$threads -o $pressure-$threads
	done
	talus diff $pressure-1 $pressure-2 && talus diff $pressure-1 $pressure-3 && echo "$pressure: the same"
done
talus run "$case" "${settings[@]}" --set pressure=hydrostatic --set threads=4 -o hydrostatic-1 && echo complete
talus diff hydrostatic-1 non-hydrostatic-1 >/dev/null || echo other physics, other numbers
talus check --quiet "$case" --set threads=0
talus check --quiet "$case" --set threads=257
