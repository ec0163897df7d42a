# Gauges and stations in figures of a run and of an experiment; what is left out of figures, and said so.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
svg() # FILE: its texts, those with letters
{
	python3 - "$1" <<'PYTHON' | grep -E '[a-z]' | sort -u
import sys, xml.etree.ElementTree as tree
for text in tree.parse(sys.argv[1]).iter('{http://www.w3.org/2000/svg}text'):
    print(''.join(text.itertext()).strip())
PYTHON
}
talus run -q collapse.yaml -o run --set 'output.gauges=[0 m, 10 cm]' --set 'output.velocity_at=[0.05]'
talus plot -f svg run
echo "exit $?: two profiles are no map"
svg run/figures/gauges.svg
svg run/figures/velocities.svg
talus plot -d -f svg -o plain run 2>/dev/null
svg plain/gauges.svg
svg plain/energy.svg

talus run -q "$TALUS_ROOT/configs/immersed-low-viscosity.yaml" -o grains --set time.end=1 \
	--set 'output.profiles_at=[]'
talus plot -f svg -o both run grains
echo "exit $?: another model"

cat >study.yaml <<'END'
base: collapse.yaml
set: {output: {gauges: [0 m, 10 cm], velocity_at: [5 cm]}}
runs: [{layers: [4, 2]}]
plots:
  - {name: gauge, kind: series, y: h_gauge, at_x: 10 cm, lines: layers, dimensionless: true}
  - {name: column, kind: column, y: [u_station, w_station], at: [0.05 s, 0.2 s], split: y, lines: layers}
  - {name: nowhere, kind: series, y: h_gauge, at_x: 20 cm, lines: layers}
END
talus campaign run study.yaml >/dev/null
masked talus plot -f svg study.yaml
echo "exit $?"
svg results/study/figures/gauge.svg
svg results/study/figures/column.svg
talus plot -d study.yaml
echo "exit $?"

# what is drawn where nothing lies on the erodible bed: 0, also in the other coordinates
cat >bed.yaml <<'END'
base: collapse.yaml
set: {output: {profiles_at: [0.05 s], gauges: [0.3 m], velocity_at: [0.3 m]}, time.end: 0.05 s}
runs: [{layers: 2}]
plots:
  - {name: same, kind: profile, y: h, at: 0.05 s, above_bed: true}
  - {name: turned, kind: profile, y: h, at: 0.05 s, above_bed: true, coordinates: cartesian}
  - {name: gauge, kind: series, y: h_gauge, above_bed: true}
  - {name: station, kind: series, y: h_station, above_bed: true}
END
talus campaign run bed.yaml >/dev/null
mkdir path
# shellcheck disable=SC2016 # for the script
printf '#!/bin/bash\ntee -a %q | %q "$@"\n' "$PWD/drawn" "$(command -v gnuplot)" >path/gnuplot
chmod +x path/gnuplot
PATH=$PWD/path:$PATH talus plot -f svg bed.yaml
awk '/<< END/ {inside = 1; next} /^END/ {inside = 0; printf "%.1f mm\n", 1000 * (last < 0 ? -last : last)} inside {last = $2}' drawn
