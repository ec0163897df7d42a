# SIGTERM writes a checkpoint and exits 75; the same command goes on, to the same bits
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
long=(--set domain.cells=400 --set layers=10 --set checkpoint.every_steps=1)
for signal in TERM INT USR1; do
	talus run small.yaml "${long[@]}" -o stopped-$signal 2>message &
	while [ ! -e stopped-$signal/run.previous.h5 ]; do sleep 0.01; done
	kill -$signal $!
	wait $!
	echo "$signal: $?"
	clocks <message | sed -E 's/(step|=) [0-9.]+/\1 N/g'
	sed -n -E 's/^(state|attempts):/&/p' stopped-$signal/status.yaml
	talus run small.yaml "${long[@]}" -o stopped-$signal --quiet
	echo "resumed: $?"
	grep -c 'resumed at step [1-9]' stopped-$signal/run.log
done
talus run small.yaml "${long[@]}" -o straight --quiet
for signal in TERM INT USR1; do
	talus diff straight stopped-$signal && echo the same bits
done
