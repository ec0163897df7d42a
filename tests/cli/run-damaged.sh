# damage is seen, the previous generation is used with a warning, and two damaged ones are 65
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
talus run small.yaml --quiet --set checkpoint.every_steps=4
talus run small.yaml --quiet -o straight
printf damage | dd of=results/small/run.h5 bs=1 seek=3000 conv=notrunc status=none
talus verify results/small
echo "$?"
talus info results/small | head -n 3
talus run small.yaml | clocks
talus diff results/small straight && echo the same bits
for file in run run.previous; do
	printf damage | dd of=results/small/$file.h5 bs=1 seek=3000 conv=notrunc status=none
done
for command in "run small.yaml" "info results/small" "diff straight results/small" \
	"verify results/small" "info absent" "verify absent small.yaml"; do
	# shellcheck disable=SC2086
	talus $command
	echo "$command: $?"
done
ls results/small
h5repack straight/run.h5 copy.h5 || exit
talus info copy.h5 | head -n 2
talus diff straight copy.h5 && echo the same bits
