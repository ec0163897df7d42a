# A run that another process works on is waited for, and taken over when it stops unfinished.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: long.yaml\n' >study.yaml
folder=results/study/$(talus campaign status --json study.yaml | python3 -c '
import json, sys
print(json.load(sys.stdin)["runs"][0]["run"])')
talus run --quiet long.yaml -o "$folder" 2>/dev/null &
other=$!
wait_for 30 begun 1 results/study || echo "the run never ran"
talus campaign run study.yaml >out 2>&1 &
sleep 0.3
kill -TERM "$other"
wait "$other"
echo "other: exit $?"
wait $!
echo "exit $?"
mask out
grep -o 'attempt .: [a-z]* at' "$folder/run.log"
