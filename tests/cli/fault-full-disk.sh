# A disk that is full, or read-only, or gone: 73 or 74 with the room that is needed, the last good
# checkpoint whole, and with room again the same bits. On a small tmpfs, which takes a mount of our own.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
if [[ ! ${MOUNTED:-} ]]; then
	unshare --mount --map-root-user true 2>/dev/null || {
		echo "no mounts may be made here"
		exit 77
	}
	MOUNTED=1 exec unshare --mount --map-root-user bash "$0"
fi
mkdir disk
full() # KILOBYTES: a disk of that size
{
	mount -t tmpfs -o "size=$1k,mode=700" none disk || exit
}
# checkpoints every few steps, each larger than the last
config=(collapse.yaml --quiet --set checkpoint.every_steps=20 --set output.profiles_at="[0.02, 0.05, 0.1, 0.15]")
talus run "${config[@]}" -o straight || exit
size=$(($(stat -c %s straight/run.h5) / 1024))

echo '== a run at every stage'
declare -A ends
for ((room = 4; room < 4 * size; room += 4 + size / 9)); do
	full $room
	talus run "${config[@]}" -o disk/run 2>message
	code=$?
	if ((code == 0)); then
		umount disk
		break
	fi
	((code == 73 || code == 74)) || echo "room for $room kB: exit $code"
	grep -q 'No space left on device; [0-9.]* [kM]*B* *b*y*t*e*s* *are needed' message || cat message
	[[ ! -e disk/run/run.h5.tmp && ! -e disk/run/status.yaml.tmp ]] || ls disk/run
	at=start
	if [[ -e disk/run/run.h5 ]]; then
		at=checkpoint
		talus verify disk/run >log || cat log
		mount -o remount,size=64m disk
		talus run "${config[@]}" -o disk/run || echo "room for $room kB: no resume"
		talus diff disk/run straight
	fi
	ends[$at]=$((ends[$at] + 1))
	umount disk
done
for at in start checkpoint; do
	((ends[$at] > 1)) || echo "the disk was full ${ends[$at]} times at the $at"
done

echo '== a campaign'
printf 'base: collapse.yaml\nset: {checkpoint.every_steps: 20}\nruns: [{layers: [4, 5, 6, 7, 8]}]\n' >study.yaml
full $((2 * size))
masked talus campaign run -j 1 --order given --retry 3 -o disk/study study.yaml >out 2>message
echo "exit $?"
grep -c complete out
grep -c 'are needed' message
grep -c 'tried again' message
tail -n 1 message | sed -E 's/[0-9.]+ kB/S kB/'
talus campaign status -o disk/study study.yaml | tail -n 1 | grep -o '[0-9]* complete'
mount -o remount,size=64m disk
talus campaign run -j 1 -o disk/study study.yaml | tail -n 1
umount disk

echo '== figures and tables'
full 64
printf 'base: collapse.yaml\ntables: [{name: t, rows: layers, metric: steps}]\n' >table.yaml
talus campaign run table.yaml >/dev/null
for format in svg png pdf; do
	talus plot -f $format -o disk/figures straight >out 2>message
	code=$?
	((code == 74)) && grep -q '^talus: disk/figures/.* cannot write: No space left on device; .* needed$' message ||
		echo "$format: exit $code: $(cat message)"
	# what is said to be there is whole
	ls -A disk/figures | sed 's|^|disk/figures/|' | diff <(sort out) - && [[ ! $(find disk/figures -size -1k) ]] || ls -l disk/figures
	head -c 64k /dev/zero >disk/rest 2>/dev/null
	talus plot -f $format -o disk/figures straight 2>/dev/null || echo "exit $?"
	rm -r disk/figures disk/rest
done
head -c 64k /dev/zero >disk/rest
talus tables table.yaml >disk/table
echo "exit $?"
umount disk

echo '== read-only'
full 4096
talus run "${config[@]}" --set time.end=0.1 --set output.profiles_at=[] -o disk/run
mount -o remount,ro disk
talus run "${config[@]}" --set time.end=0.1 --set output.profiles_at=[] -o disk/run 2>&1
echo "exit $?"
talus run "${config[@]}" -o disk/other 2>&1
echo "exit $?"
masked talus campaign run -o disk/study study.yaml 2>&1
echo "exit $?"
umount disk

echo '== gone in the middle'
cat >longer.yaml <<<"$(sed 's/end: 1 s/end: 100 s/' long.yaml)"
mkdir -p gone
talus run --quiet longer.yaml --set checkpoint.every_steps=5 -o gone/run 2>message &
wait_for 20 grep -qs started gone/run/run.log
mv gone away
wait $!
echo "exit $?"
cat message
talus verify away/run >log || cat log
talus run --quiet longer.yaml --set checkpoint.every_steps=5 -o away/run 2>message &
wait_for 20 grep -qs resumed away/run/run.log
rm away/run/run.lock
wait $!
echo "exit $?"
cat message
printf 'base: longer.yaml\nset: {checkpoint.every_steps: 5}\nruns: [{layers: [7, 6, 5]}]\n' >study.yaml
talus campaign run -j 1 study.yaml >out 2>message &
wait_for 20 begun 1 results/study
mv results away
wait $!
echo "exit $?"
sed -n '$p' message
