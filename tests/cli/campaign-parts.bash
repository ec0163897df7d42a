# What the cases of campaigns and tables share: a small collapse, and output without what differs from
# one time to the next.
cat >collapse.yaml <<'END'
slope: 22 deg
erodible_bed_thickness: 1.82 mm
layers: 4
domain: {x_min: -0.2 m, x_max: 1.4 m, cells: 80, right: outflow}
time: {end: 0.2 s, cfl: 0.5}
output: {profiles_at: [0.1 s, 0.2 s]}
END

# A collapse of some seconds of computing (the slowest solver), for what happens in the middle of a run.
cat >long.yaml <<'END'
slope: 22 deg
erodible_bed_thickness: 1.82 mm
layers: 8
domain: {x_min: -0.2 m, x_max: 3 m, cells: 640, right: outflow}
time: {end: 1 s, cfl: 0.2}
pressure_solver: {method: block-gauss-seidel, criterion: increment, start: previous}
END

mask() # FILE...: digits of hashes, times and processes
{
	sed -E -e 's/-[0-9a-f]{8}([^0-9a-f]|$)/-HASH\1/g' -e 's/[0-9.]+ s( CPU|$)/T s\1/' \
		-e 's/[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z/DATE/' "$@"
}

masked() # COMMAND...: run it with its output masked; its exit code
{
	local status=0

	"$@" >.stdout 2>.stderr || status=$?
	mask .stdout
	mask .stderr >&2
	rm -f .stdout .stderr
	return "$status"
}

wait_for() # SECONDS COMMAND...: until it succeeds
{
	local end=$((SECONDS + $1))

	shift
	until "$@"; do
		((SECONDS < end)) || return 1
		sleep 0.02
	done
}

running() # EXPERIMENT: how many of its runs are being computed, by their locks
{
	talus campaign status --json "$1" | python3 -c '
import json, sys
print(json.load(sys.stdin)["counts"]["running"])'
}

begun() # COUNT FOLDER: have this many of its runs been started, and had time for some steps?
{
	(($(cat "$2"/*/run.log 2>/dev/null | grep -c 'started at step 0') >= $1)) && sleep 0.2
}

none_running() # EXPERIMENT
{
	(($(running "$1") == 0))
}
