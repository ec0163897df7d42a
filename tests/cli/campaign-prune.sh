# prune removes run folders that no experiment names, after showing them, and nothing else.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
sizes()
{
	sed -E 's/[0-9.]+ s of CPU time/T s of CPU time/g; s/[0-9.]+ [kM]B/S kB/g' | mask
}
printf 'base: collapse.yaml\nruns: [{layers: [4, 3, 2, 1]}]\n' >study.yaml
talus campaign run study.yaml >/dev/null
talus campaign prune study.yaml | sizes
printf 'base: collapse.yaml\nruns: [{layers: 4}]\n' >study.yaml
printf 'base: collapse.yaml\nruns: [{layers: 3}]\n' >other.yaml
cd results/study || exit
touch "$(echo layers-2-*)/notes.txt"        # somebody's own
mkdir mine-01234567                         # looks like one of ours
cp -r layers-1-* old-89abcdef               # not under its own hash
ln -s "$PWD/layers-1-"* link-"$(ls -d layers-1-* | tail -c 9)"
touch timing.lock stray
cd ../..
echo "-- nobody to ask"
talus campaign prune study.yaml other.yaml </dev/null | sizes
ls results/study | mask
echo "-- yes"
talus campaign prune --yes study.yaml other.yaml | sizes
echo "-- a run that is being computed"
printf 'base: long.yaml\nset: {time.end: 30 s}\nruns: [{layers: 8}]\n' >long_study.yaml
talus campaign run -o results/study long_study.yaml >/dev/null 2>&1 &
wait_for 30 begun 5 results/study
talus campaign prune --yes study.yaml other.yaml | sizes
kill -TERM $!
wait $!
talus campaign prune --yes study.yaml | sed 's/.*: /RUN: /' | sizes
ls results/study | mask
echo "-- answers on a terminal"
talus campaign run other.yaml -o results/study >/dev/null
for answer in n y; do
	# the terminal echoes the answer before or after the question
	echo $answer | script -qec 'talus campaign prune study.yaml' /dev/null | tr -d '\r\n' |
		sed -E 's/.*(remove them\? \[y\/N\]) [ny]?/\1 /; s/ ?$/\n/'
	ls results/study | grep -c layers
done
