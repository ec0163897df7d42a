#!/bin/bash
# Run the same configs with builds whose kernels have other vector widths, and with threads: every run
# file must be the same but for its clocks, as `talus diff` sees it.
#
# usage: tests/widths/widths.sh TALUS...        (the programs to compare with the `talus` of PATH)
# Exit codes: 0, 1.
set -uo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
config=$TALUS_ROOT/configs/granular-collapse.yaml
failed=0

run() # FOLDER PROGRAM SETTING...
{
	local folder=$work/$1 program=$2 setting settings=()

	shift 2
	for setting; do settings+=(--set "$setting"); done
	"$program" run "$config" --quiet -o "$folder" --set output.profiles_at=[] --set time.end=0.05 \
		"${settings[@]}"
}

compare() # NAME SETTING...
{
	local name=$1 program
	shift

	run reference talus "${settings[@]}" || failed=1
	run other "$@" "${settings[@]}" || failed=1
	talus diff "$work/reference" "$work/other" || {
		echo "FAILED: $name: ${settings[*]}"
		failed=1
	}
	rm -rf "${work:?}"/*
}

while read -r -a settings; do
	for program; do
		compare "$program" "$program"
	done
	compare "3 threads" talus threads=3
done <<'END'
layers=20 n_ini_guess=10
layers=10 n_ini_guess=0 erodible_bed_thickness=0 domain.right=wall slope=0deg
layers=1 n_ini_guess=0
layers=3 n_ini_guess=0 pressure_solver.operator=pointwise domain.cells=601
layers=40 n_ini_guess=0 pressure_solver.method=block-direct domain.cells=320
layers=33 n_ini_guess=0 pressure_solver.method=red-black-line-relaxation domain.cells=320
layers=41 n_ini_guess=0
layers=40 n_ini_guess=0 pressure_solver.method=conjugate-gradients domain.cells=1280
layers=20 n_ini_guess=10 domain.left=periodic domain.right=periodic domain.cells=641
layers=20 n_ini_guess=0 pressure=hydrostatic time.end=1s
layers=7 n_ini_guess=0 pressure=hydrostatic domain.cells=1001 domain.left=outflow time.end=1s
layers=10 n_ini_guess=0 pressure=hydrostatic erodible_bed_thickness=0 time.end=1s
layers=10 n_ini_guess=0 pressure=hydrostatic scheme.friction_reconstruction=printed time.end=1s
END
((failed)) || echo "the same bits, whichever the width of the vectors"
exit "$failed"
