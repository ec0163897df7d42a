# Standard output that takes nothing is exit code 74, for whatever is printed.
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
printf 'base: small.yaml\ntables: [{name: t, rows: layers, metric: steps}]\n' >study.yaml
talus run --quiet small.yaml
talus run --quiet small.yaml -o different --set time.end=0.2
while read -r command; do
	# shellcheck disable=SC2086
	$command >/dev/full
	echo "$?: $command"
done <<'END'
talus --help
talus --version
talus help
talus check --help
talus check small.yaml
talus check --reference
talus run --help
talus run small.yaml
talus run small.yaml -o other
talus info results/small
talus diff results/small different
talus verify results/small
talus campaign --help
talus campaign run --dry-run study.yaml
talus campaign run study.yaml
talus campaign status study.yaml
talus campaign why study.yaml
talus campaign watch study.yaml
talus-tables study.yaml
talus plot -f svg results/small
END
