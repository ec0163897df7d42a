# A table from real runs in every format, with a published column and a note that makes it again.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
title: Thickness, by "layers" | pressure
source: P9 Table 1
base: collapse.yaml
runs: [{layers: [4, 2], pressure: [non-hydrostatic, hydrostatic]}]
tables:
  - name: t
    rows: layers
    columns: pressure
    metric: [steps, l2-difference]
    reference: {layers: 4, pressure: non-hydrostatic}
    at: 0.1 s
  - {name: u, rows: [layers, pressure], metric: steps, title: 'Steps, and more'}
published:
  t: [[[1, null], [null, 2.5]], [null, [3, 4]]]
END
talus campaign run study.yaml >/dev/null
notes() { sed -E 's/(Made by talus) .*/\1 BUILD/; s/(Made on) .*/\1 HOST/'; }
talus-tables study.yaml | notes
talus-tables --format markdown --table t study.yaml | notes
talus tables --format csv --table t study.yaml | tr '\r' '$'
talus-tables --format csv --table u study.yaml | tr '\r' '$'
talus tables --format latex --table t study.yaml | notes
talus tables --format json --table t study.yaml | notes | sed 's/Made by talus .*/Made by talus BUILD",/; s/Made on .*/Made on HOST",/'
rm -r results/study/layers-2_pressure-hydrostatic-*
talus tables --format json --table t study.yaml 2>err >table.json
echo "exit $?"
python3 -c 'import json
table = json.load(open("table.json"))
print([column["values"] for column in table["columns"]], [column.get("missing") for column in table["columns"]])'
talus-tables --table u --set time.end=0.1 --set 'output.profiles_at=[0.1 s]' study.yaml >/dev/null 2>err
echo "exit $?"
mask err
