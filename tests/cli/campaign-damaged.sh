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
masked talus campaign run --dry-run --retry 1 study.yaml
masked talus campaign run --retry 1 study.yaml
echo "exit $?"
ls "$damaged"

# damage behind good trailers shows when the run reads its files
damaged=$(echo results/study/layers-2*)
cp "$damaged/run.previous.h5" "$damaged/run.h5"
for name in run run.previous; do
	printf x | dd of="$damaged/$name.h5" bs=1 seek=3000 conv=notrunc status=none
done
masked talus campaign run study.yaml 2>&1 | head -n 3
masked talus campaign run --retry 1 study.yaml 2>&1 | sed 's/ early.*/ early .../'
ls "$damaged" | grep damaged
masked talus verify "$damaged"
