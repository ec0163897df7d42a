# A later time.end and nothing else changed goes on from what was computed: the bits are those of the long
# run, no step but the last shared ones is taken again, and the finished run stays.
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
talus run small.yaml -o a | clocks
talus run small.yaml -o a -s time.end=0.5 | clocks
talus run small.yaml -o straight -s time.end=0.5 | clocks
talus diff a straight
echo "diff: exit $?"
ls a
talus info a/run.end-0.3.h5 | grep -E '^ +(status|end|time)'
grep -o 'attempt .: [a-z]* at step.*' a/run.log
talus run small.yaml -o b -s time.end=0.5 --continue-from a | clocks
echo "-- other keys, an earlier end, and no such folder"
talus run small.yaml -o c -s time.end=0.7 -s layers=1 --continue-from a | clocks
talus run small.yaml -o d -s time.end=0.7 --continue-from none | clocks
talus run small.yaml -o a
echo "exit $?"
talus run small.yaml -o a -s time.end=0.4
echo "exit $?"
talus run small.yaml -o a -s time.end=0.8 -s output.profiles_at="[0.1, 0.7]"
echo "exit $?"
echo "-- the config keys that differ"
talus diff a a/run.end-0.3.h5 | grep config | sed 's/hash: .*/hash/'
talus diff a d | grep config | sed 's/hash: .*/hash/'
