# A pipe that nobody writes to, in the place of every file that is read or written, is refused at once.
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
printf 'base: small.yaml\n' >study.yaml
try() # COMMAND...
{
	timeout 5 "$@" 2>&1 | clocks
	echo "exit ${PIPESTATUS[0]}"
}
mkfifo pipe.yaml
try talus check pipe.yaml
try talus run pipe.yaml
try talus campaign run pipe.yaml
printf 'base: pipe.yaml\n' >piped.yaml
try talus campaign run piped.yaml
talus check <(cat small.yaml) >/dev/null && echo "a pipe with a config is read"
for name in run.h5 run.previous.h5 run.log run.lock status.yaml config.yaml run.h5.tmp status.yaml.tmp; do
	echo "== $name"
	rm -rf results
	mkdir -p results/small
	mkfifo "results/small/$name"
	try talus run small.yaml
	try talus info results/small >/dev/null
	timeout 5 talus verify results/small >/dev/null 2>&1
	(($? != 124)) || echo "verify hangs"
	rm -rf results
	talus campaign run --dry-run study.yaml >plan
	mkdir -p "results/study/$(sed -n '1s/:.*//p' plan)"
	mkfifo "results/study/$(sed -n '1s/:.*//p' plan)/$name"
	timeout 5 talus campaign status study.yaml >/dev/null || echo "status: $?"
	timeout 5 talus campaign run study.yaml >/dev/null 2>&1
	echo "campaign: exit $?"
done
