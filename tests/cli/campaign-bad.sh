# What a campaign refuses: the whole of stderr.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
try() # ARGUMENT...
{
	talus campaign "$@"
	echo "exit $?" >&2
}
try
try --help x
try walk study.yaml
try run
try run none.yaml
try run a b
try run -j 0 study.yaml
try run -j many study.yaml
try run --jobs
try run --frob study.yaml
try --json
while IFS= read -r text; do
	[[ $text == base* ]] || text='base: collapse.yaml\n'$text
	printf '%b\n' "$text" >study.yaml
	echo "$text" >&2
	try run study.yaml
done <<'END'
base: none.yaml
runs: [{layers: [4, 2.5]}]
runs: [{layer: 4}]
runs: [{layers: 4, n_ini_guess: 3}]
runs: [{layers: [{a: 4, b: 8}]}]
runs: [{output.profiles_at: [{a: 0.1}]}]
set: {time.end: 5 m}
tables: [{name: t, rows: layrs, metric: iterations}]
tables: [{name: t, rows: layers, metric: iteration}]
tables: [{name: t, rows: layers, metric: speed-up}]
tables: [{name: t, rows: layers, metric: l2-difference, reference: {layers: 20}}]
tables: [{name: t, rows: layers, metric: l2-difference, reference: {layers: 4}, at: later}]
tables: [{name: t, rows: layers, metric: l2-difference, reference: {layers: 4}, at: 0.15 s}]
tables: [{name: t, rows: layers, metric: l2-difference, reference: {layers: 4}, at: 1 m}]
tables: [{name: t, rows: layers, metric: steps, only: {layers: 7}}]
tables: [{name: t, rows: layers, metric: steps, only: {layers: many}}]
runs: [{layers: [2, 4]}]\ntables: [{name: t, rows: slope, metric: steps}]
tables: [{name: t, rows: layers, metric: steps}]\npublished: {u: [1]}
tables: [{name: t, rows: layers, metric: steps}]\npublished: {t: [1, 2]}
tables: [{name: t, rows: layers, metric: steps}]\npublished: {t: 1}
tables: [{name: t, rows: layers, metric: [steps, runout]}]\npublished: {t: [1]}
tables: [{name: t, rows: layers, columns: slope, metric: steps}]\npublished: {t: [[1, 2]]}
tables: [{name: t, rows: layers, metric: steps}]\npublished: {t: [many]}
END
printf 'base: collapse.yaml\n' >study.yaml
try run --set layers=2.5 study.yaml
try run --set layers study.yaml
try run --executor cloud study.yaml
touch blocked
try run -o blocked study.yaml
try run -o blocked/below study.yaml
