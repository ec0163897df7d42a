#!/bin/bash
# What the pressure solvers cost: every method against the plain block Gauss-Seidel, growth with layers and
# cells, and the roofline, into results/paper/solvers.md. Called by `make bench`, in its own folder
# with bin/ and the bench programs first on PATH; about ten minutes, and goes on where it was stopped as
# long as the build stays the same. A repeat runs every method once before the next repeat begins.
set -euo pipefail

root=$TALUS_ROOT
revision=$(talus --version | tr -cs '[:alnum:].\n-' _)
out=$root/results/paper/solvers.md
[[ $revision != *dirty* ]] || rm -rf "solvers-$revision" # another build may have the same name
mkdir -p "solvers-$revision" "$root/results/paper"
cd "solvers-$revision"

experiments=("$root/experiments/solvers.yaml" "$root/tests/bench/solvers-layers.yaml"
	"$root/tests/bench/solvers-cells.yaml")

# The ratio of the cost of a step for twice as many layers or cells, from a table in CSV.
growth() # EXPERIMENT FOLDER WHAT COUNT
{
	echo
	echo "| $3 | $4 | cost of a step, for each doubling |"
	echo '| :-- | --: | --: |'
	talus-tables "$1" -o "$2" --format csv | awk -F, '
		NR == 1 { gsub(/"[^"]*"/, "spread"); for (i = 1; i <= NF; i++) at[$i] = i; next }
		{ cost = $at["CPU s"] / $at["steps"] }
		$1 == method { printf "| %s | %d to %d | %.2f |\n", $1, size, $2, (cost / last) ^ (log(2) / log($2 / size)) }
		{ method = $1; size = $2; last = cost }'
}

for experiment in "${experiments[@]}"; do
	talus campaign run "$experiment" -o "$(basename "$experiment" .yaml)"
done
{
	echo '# The pressure solvers'
	echo
	echo "By \`make bench\`, on $(date -u +%F), $(nproc) x $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo |
		sed -n 1p), a busy machine being seen in the spread of the repeats. The paper's iteration stops by"
	echo 'its increment (1e-6 m2/s2), the other methods at a true relative residual of 1e-8; shown is the'
	echo 'greatest of all steps.'
	for experiment in "${experiments[@]}"; do
		name=$(basename "$experiment" .yaml)
		echo
		talus-tables "$experiment" -o "$name" --format markdown
		case $name in
		solvers-layers) growth "$experiment" "$name" method layers ;;
		solvers-cells) growth "$experiment" "$name" shape cells ;;
		esac
	done
	echo
	echo '**Roofline: a step by conjugate gradients**'
	echo
	bench_roofline $(for layers in 10 20 40; do
		ls -d solvers/*"layers-${layers}"*conjugate-gradients_repeat-1-*
	done)
	echo
	echo 'Operations and bytes are per cell, layer and step, counted in `tests/bench/bench_roofline.c`; the'
	echo 'time is that of the whole run, recording included. The elimination of the few steep columns is in the'
	echo 'time and not in the counts, so that a little more is reached than stands here.'
} | sed "s|$root/||g" >"$out.tmp"
mv "$out.tmp" "$out"
sed 's/^/  /' "$out"
