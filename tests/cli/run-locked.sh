# a run that another process is at says by whom, and exits 75
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
talus run small.yaml --quiet --set domain.cells=400 --set layers=10 &
while ! grep -qs 'started at step 0' results/small/run.log; do sleep 0.01; done
kill -STOP $!
talus run small.yaml 2>message
echo "$?"
clocks <message
kill -CONT $!
wait $!
echo "$?"
