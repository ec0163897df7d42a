# folders and files that cannot be written: 73 where nothing could be created, 74 later
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
talus run small.yaml -o small.yaml/folder
echo "$?"
mkdir -p taken/run.h5.tmp
talus run small.yaml -o taken
echo "$?"
(
	ulimit -f 8 # blocks of 1024 bytes; the signal would end the process
	trap '' XFSZ
	talus run small.yaml -o full 2>&1
	echo "$?"
) | sed -E 's/[0-9.]+ kB/S kB/'
ls full
talus run small.yaml -o full | clocks
