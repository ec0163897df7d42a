# What `talus plot` refuses, and how it says so.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
bad() # LINES OF A PLOT
{
	printf 'base: collapse.yaml\nruns: [{layers: [4, 2]}]\nplots:\n  - name: p\n%s\n' "$1" >bad.yaml
	talus plot bad.yaml
	echo "exit $?"
}
bad '    kind: serie
    y: h'
bad '    y: h'
bad '    kind: series'
bad '    kind: profile
    y: h
    line: layers'
bad '    kind: profile
    y: h'
bad '    kind: profile
    y: h
    lines: layers
    at: 0.15 s'
bad '    kind: profile
    y: h
    lines: layers
    at: 3 m'
bad '    kind: metric
    y: runout'
bad '    kind: metric
    y: runaut
    x: layers'
bad '    kind: metric
    y: runout
    x: pressure
    lines: layers'
bad '    kind: series
    y: h
    x: layers'
bad '    kind: profile
    y: [h, u]
    lines: layers
    above_bed: true'
bad '    kind: metric
    y: final-thickness
    x: layers
    above_bed: true'
bad '    kind: gauge
    y: h
    layer: 0
    lines: layers'
bad '    kind: series
    y: h
    log: z'
bad '    kind: series
    y: h
    x_range: [2, 1]'
bad '    kind: series
    y: h
    published: [{points: [[1, x]]}]'
bad '    kind: series
    y: h
    published: [{title: nothing}]'
bad '    kind: series
    y: h
    split: layers
    published: [{points: [[1, 2]]}]'
talus campaign run bad.yaml >/dev/null
echo "exit $?"
sed -i '/published/d; s/split/lines/; s/y: h/y: [none, front_position]/' bad.yaml
talus campaign run bad.yaml >/dev/null
talus plot bad.yaml | mask
masked talus plot bad.yaml >/dev/null
echo "exit $?"
sed -i 's/y: .*/y: front_position/; s/lines:/y_unit: kg\n    lines:/' bad.yaml
talus plot bad.yaml
echo "exit $?"
talus plot
talus plot -f gif bad.yaml
talus plot -f png, bad.yaml
talus plot -p other bad.yaml
talus plot bad.yaml bad.yaml
talus plot -p p results/bad
talus plot collapse.yaml
talus plot absent
echo "exit $?"
talus plot study/absent.yaml
sed -i '/y_unit/d' bad.yaml
echo >file
talus plot -o file/figures bad.yaml
echo "exit $?"
mkdir path
PATH=$(dirname "$(command -v talus)"):$PWD/path
talus plot bad.yaml
echo "exit $?"
printf '#!/bin/bash\necho "unknown or ambiguous terminal type; type just set terminal for a list" >&2\nexit 1\n' >path/gnuplot
/bin/chmod +x path/gnuplot
talus plot bad.yaml
echo "exit $?"
