# SIGKILL of the campaign: its runs write their checkpoints and stop, and the next command resumes them.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: long.yaml\nruns: [{layers: [8, 7]}]\n' >study.yaml
talus campaign run -j 2 study.yaml >/dev/null 2>&1 &
campaign=$!
wait_for 30 begun 2 results/study || echo "two runs never ran"
disown
kill -KILL "$campaign"
wait_for 10 none_running study.yaml || echo "a run was left behind"
talus campaign status study.yaml | awk 'NR > 1 {print $2}' | sort | uniq -c
talus campaign run study.yaml | tail -n 1
grep -h -o 'attempt 2: resumed at step [1-9]' results/study/*/run.log | sed 's/[1-9]$/N/'
