# A run whose generations are both damaged: told by every command with the way out, 65, and the others
# go on; --retry starts it anew and keeps what is damaged.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: collapse.yaml\nruns: [{layers: [2, 3]}]\n' >study.yaml
talus campaign run study.yaml >/dev/null
damaged=$(echo results/study/layers-3*)
for name in run run.previous; do
	truncate -s -1 "$damaged/$name.h5"
done
rm -r results/study/layers-2*
masked talus campaign run --dry-run study.yaml
masked talus campaign run study.yaml
echo "exit $?"
masked talus run "$damaged/config.yaml" -o "$damaged"
echo "exit $?"
masked talus campaign status study.yaml
masked talus campaign run --dry-run --retry study.yaml
masked talus campaign run --retry study.yaml
echo "exit $?"
ls "$damaged"
