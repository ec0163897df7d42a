# Figures of runs and of an experiment with every kind of plot, in the formats asked for.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
title: Every kind
source: P9 Figure 1
base: collapse.yaml
runs: [{layers: [4, 2], pressure: [non-hydrostatic, hydrostatic]}]
plots:
  - name: lines
    columns: 2
    lines: [pressure, layers]
    names: {hydrostatic: H, non-hydrostatic: NH}
    panels:
      - {kind: series, y: [front_position, front_velocity], only: {layers: 4}, lines: pressure}
      - {kind: profile, y: h, at: 0.1 s, x_unit: mm, title: Profiles}
      - {kind: column, y: u, at: [0.1 s, 0.2 s], at_x: 1 cm, only: {layers: 4}, lines: pressure}
      - {kind: gauge, y: u, at_x: 5 mm, layer: [1, top], only: {layers: 2}, lines: pressure}
      - {kind: map, y: h, only: {layers: 2, pressure: hydrostatic}, lines: []}
  - name: over
    kind: metric
    x: layers
    y: runout
    lines: pressure
    dimensionless: true
    log: [x, y]
    published: [{line: hydrostatic, points: [[2, 1], [4, 1.5]]}]
  - name: times
    kind: metric
    x: at
    y: l2-difference
    at: [0.1 s, 0.2 s]
    reference: {layers: 4, pressure: non-hydrostatic}
    lines: [layers, pressure]
  - {name: bare, kind: profile, y: h, at: 0.1 s, lines: [layers, pressure], x_range: [0.2, 0.4], y_unit: mm}
  - {name: above, kind: profile, y: h, at: 0.1 s, lines: [layers, pressure], x_range: [0.2, 0.4], y_unit: mm,
     above_bed: true}
  - name: split
    kind: profile
    y: [h, static_height]
    at: all
    split: [layers, at]
    lines: pressure
    x_range: [-0.2, 0.5]
END
talus plot study.yaml
echo "exit $? without runs"
talus campaign run study.yaml >/dev/null
masked talus plot study.yaml
echo "exit $?"
file_kind() # FILE: what it is by its first bytes
{
	case $(head -c 200 "$1" | tr -d '\0') in
	*'<svg'*) echo SVG ;;
	$'\x89PNG'*) echo PNG ;;
	%PDF*) echo PDF ;;
	*) echo nothing known ;;
	esac
}
for figure in results/study/figures/*; do
	echo "$figure: $(file_kind "$figure" 2>/dev/null)"
done
ls -A results/study/figures | grep -c '^\.'
svg() { python3 - "$1" <<'END'
import sys, xml.etree.ElementTree as tree
for text in tree.parse(sys.argv[1]).iter('{http://www.w3.org/2000/svg}text'):
    print(''.join(text.itertext()).strip())
END
}
svg results/study/figures/over.svg | grep -E '[a-z]' | sort -u
svg results/study/figures/times.svg | grep -E '[a-z]' | sort -u
for name in bare above; do
	svg results/study/figures/$name.svg | grep -E '^-?[0-9.]+$' | paste -sd ' '
done
svg results/study/figures/split.svg | grep -E '[a-z]' | sort -u
talus plot --format png,svg -o drawn -p over study.yaml
talus plot -f pdf results/study/layers-4_pressure-hydrostatic-* -o one
run=$(echo results/study/layers-4_pressure-hydrostatic-*)
talus plot -f svg "$run/run.h5" results/study/layers-2_pressure-hydrostatic-* | mask
svg "$run/figures/profiles.svg" | grep -c 't = '
