# docs/experiments.md is what `talus tables --reference` prints, and its example reads.
talus tables --reference | diff - "$TALUS_ROOT/docs/experiments.md" && echo same
sed -n '/^```yaml/,/^```/p' "$TALUS_ROOT/docs/experiments.md" | grep -v '```' | sed "s|\.\./configs|$TALUS_ROOT/configs|" >example.yaml
talus campaign run --dry-run example.yaml | tail -n 1 | sed 's/about .*/.../'
# a config and an experiment that were mixed up
talus run example.yaml
echo "exit $?"
talus check example.yaml
echo "exit $?"
printf 'slope: 22 deg\nlayers: 4\n' >config.yaml
talus campaign run config.yaml
echo "exit $?"
