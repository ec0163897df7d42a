# A quota that is used up, on a btrfs of our own: as a disk that is full (fault-full-disk).
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
if [[ ! ${MOUNTED:-} ]]; then
	MOUNTED=1 exec unshare --mount bash "$0"
fi
PATH=$PATH:/usr/sbin:/sbin
truncate -s 200M image
mkdir disk
if ! { mkfs.btrfs -q image && mount -o loop image disk && btrfs quota enable disk &&
	btrfs subvolume create disk/mine; } >log 2>&1; then
	echo "no file system with quotas can be made here: $(tail -n 1 log)"
	exit 77
fi
id=$(btrfs inspect-internal rootid disk/mine)
trap 'cd / && umount "$OLDPWD/disk"' EXIT
config=(collapse.yaml --quiet --set checkpoint.every_steps=20 --set output.profiles_at="[0.02, 0.05, 0.1, 0.15]")
talus run "${config[@]}" -o straight || exit
size=$(($(stat -c %s straight/run.h5) / 1024))
limit() # KILOBYTES
{
	sync -f disk # what was removed is given back
	btrfs qgroup limit "$1k" "0/$id" disk # from outside: within it even that would be refused
}

for ((room = 16; room < 8 * size; room += 4 + size / 3)); do
	limit $room
	talus run "${config[@]}" -o disk/mine/run 2>message
	code=$?
	((code)) || break
	((code == 73 || code == 74)) || echo "room for $room kB: exit $code"
	grep -q 'Disk quota exceeded' message || cat message
	[[ ! $(find disk/mine -name '*.tmp') ]] || find disk/mine
	stops=$((stops + 1))
	if [[ -e disk/mine/run/run.h5 ]]; then
		talus verify disk/mine/run >log || cat log
		limit 65536
		talus run "${config[@]}" -o disk/mine/run || echo "room for $room kB: no resume"
		talus diff disk/mine/run straight
		resumed=$((resumed + 1))
	fi
	rm -rf disk/mine/run
done
((stops > 2 && resumed)) || echo "stopped $stops times by the quota, $resumed of them with a checkpoint"

# each run takes two generations of at least the size of the first one, and one more while it writes
printf 'base: collapse.yaml\nset: {checkpoint.every_steps: 20, output.profiles_at: [0.02, 0.05, 0.1, 0.15]}
runs: [{layers: [4, 5, 6, 7, 8]}]\n' >study.yaml
limit $((6 * size))
masked talus campaign run -j 1 --order given -o disk/mine/study study.yaml >out 2>message
echo "exit $?"
grep -q 'Disk quota exceeded' message || cat message
complete=$(talus verify disk/mine/study | grep -c ' good, complete')
((complete > 0 && complete < 5)) || echo "$complete runs are complete"
limit 65536
talus campaign run -j 1 -o disk/mine/study study.yaml | tail -n 1
