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
