# The lock is the kernel's: what a lock file says, clocks and process numbers decide nothing.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
sed -i 's/end: 1 s/end: 100 s/' long.yaml

echo '== a lock file that was left behind, by a process that lives on this machine, in the future'
mkdir -p stale
printf 'process 1 on %s\n' "$(hostname)" >stale/run.lock
touch -d 2100-01-01 stale/run.lock
talus run --quiet collapse.yaml -o stale
echo "exit $?"

echo '== a living run whose lock file tells of another machine and a dead process, from long ago'
talus run --quiet long.yaml -o living 2>/dev/null &
run=$!
wait_for 20 grep -qs started living/run.log
printf 'process 999999 on another\n' >living/run.lock
touch -d 1990-01-01 living/*
talus run --quiet long.yaml -o living
echo "exit $?"
kill -KILL "$run"
wait "$run" 2>/dev/null
talus run --quiet long.yaml --set time.end=0.01 -o living 2>&1 | sed 's/(.*)/(...)/' # free, and asks for another config
echo "exit ${PIPESTATUS[0]}"

echo '== two machines of one name, on which the runs have the same process number'
unshare --fork --kill-child --pid --user --map-root-user true 2>/dev/null || {
	echo "no process numbers of our own may be had here"
	exit 77
}
unshare --fork --kill-child --pid --user --map-root-user talus run --quiet long.yaml -o same 2>/dev/null &
wait_for 20 grep -qs started same/run.log
cat same/run.lock | sed 's/ on .*//'
unshare --fork --kill-child --pid --user --map-root-user talus run --quiet long.yaml -o same 2>&1 | sed 's/on .*/on HOST/'
echo "exit ${PIPESTATUS[0]}"
printf 'base: long.yaml\nruns: [{layers: [7]}]\n' >study.yaml
unshare --fork --kill-child --pid --user --map-root-user talus campaign run study.yaml >/dev/null 2>&1 &
wait_for 20 begun 1 results/study
unshare --fork --kill-child --pid --user --map-root-user talus campaign run --dry-run study.yaml | mask | head -n 1
kill $(ps -o pid= --ppid "$(jobs -p | paste -sd,)") 2>/dev/null
wait

echo '== a reader that holds a lock of HDF5 on the run file'
talus run --quiet collapse.yaml --set checkpoint.every_steps=5 -o read
talus run --quiet collapse.yaml --set checkpoint.every_steps=5 --set time.end=0.3 -o reading 2>/dev/null &
wait_for 20 test -e reading/run.h5
flock -x reading/run.h5 talus verify reading >/dev/null
echo "verify: exit $?"
wait
flock -x read/run.h5 talus info read >/dev/null
echo "info: exit $?"
/usr/bin/python3 - <<'END'
import h5py, subprocess
with h5py.File("read/run.h5", "r") as file:
    print("under h5py:", subprocess.run(["talus", "run", "--quiet", "collapse.yaml", "--set",
        "checkpoint.every_steps=5", "-o", "read"]).returncode, file.attrs["status"])
END
