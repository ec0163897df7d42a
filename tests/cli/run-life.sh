# start, complete, refuse another config, tell and verify
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
talus run small.yaml | clocks
ls results/small
talus run small.yaml
talus run small.yaml --set checkpoint.every_steps=7
talus run small.yaml --quiet
talus run small.yaml --set layers=4 --set time.cfl=0.5
echo "$?"
talus run small.yaml -o other --set layers=4 --set time.cfl=0.5 | clocks
talus info results/small | clocks
talus info --config results/small >again.yaml
talus run again.yaml --quiet && talus diff results/small results/again && echo the same bits
talus diff results/small other >differences
echo "$?"
sed -E "s/, first.*//" differences | grep -E "config_hash|shape 2|/h:|only"
talus verify results/small other/run.h5
