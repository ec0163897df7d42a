# What talus-tables refuses, and what it calls missing.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
try() # ARGUMENT...
{
	masked talus-tables "$@"
	echo "exit $?" >&2
}
try
try none.yaml
try --format html study.yaml
try --table
printf 'base: collapse.yaml\n' >study.yaml
try study.yaml
cat >>study.yaml <<'END'
runs: [{layers: [4, 2]}]
tables:
  - {name: t, rows: layers, metric: steps}
  - {name: u, rows: layers, metric: speed-up, baseline: {layers: 2}}
END
try study.yaml extra
try --table v study.yaml
try --format csv study.yaml
printf 'base: collapse.yaml
runs: [{domain.x_max: [0.3, 0.4]}]
tables: [{name: t, rows: domain.x_max, metric: l2-difference, at: 0.1 s, reference: {domain.x_max: 0.3}}]\n' >domains.yaml
talus campaign run domains.yaml >/dev/null
try domains.yaml 2>&1 | grep -E 'domain|exit' | mask
printf 'base: collapse.yaml\nruns: [{layers: 4}]\n' >one.yaml
talus campaign run -o results/study one.yaml >/dev/null
try --table t study.yaml | sed -E 's/(Made by talus) .*/\1 BUILD/; s/(Made on) .*/\1 HOST/'
try --table u --format csv study.yaml
