#!/bin/bash
# Campaigns on a real Slurm, which this test starts and stops (cluster.bash): throttle and split arrays,
# time limit, requeue, preemption, a killed slurmd, a lost node, cancel and resubmission, failed runs,
# damaged run files, a full disk; all results equal those of the local executor bit for bit.
#
# usage: tests/slurm/slurm.sh      `talus` is taken from PATH. Exit codes: 0, 1.
set -uo pipefail

# A small disk takes a mount of our own.
if [[ ! ${MOUNTED:-} ]] && unshare --mount true 2>/dev/null; then
	MOUNTED=1 exec unshare --mount bash "$0"
fi
here=$(cd "$(dirname "$0")" && pwd -P)
# shellcheck source=tests/slurm/cluster.bash
source "$here/cluster.bash"
exec 3>&2 # bash tells on 2 of every process that was killed
local_pid=''
mounted=''
trap 'kill $local_pid 2>/dev/null; cluster_stop' EXIT

# A path that no script would survive that did not quote it.
work="$cluster/it's 100% \$(touch injected) \`touch injected\` \"x\" #y"
mkdir "$work" && cd "$work" || exit 1

fail() # WORDS
{
	echo "slurm: $*" >&3
	for log in "$cluster"/slurm*.log results/*/slurm/*.log results/*/*/run.log; do
		[[ ! -s $log ]] || { echo "--- $log" && tail -n 25 "$log"; } >&3
	done
	exit 1
}

pass() # WORDS
{
	echo "ok: $* ($SECONDS s)"
}

# STATE QUEUE-STATE JOB of each run, "-" where there is none.
states() # STUDY
{
	talus campaign status --json "$1.yaml" | python3 -c '
import json, sys
for run in json.load(sys.stdin)["runs"]:
    queue = run["queue"] or {"state": "-", "job": "-"}
    print(run["state"], queue["state"], queue["job"])'
}

count() # PATTERN STUDY: runs whose line of states matches
{
	states "$2" | grep -Ec "$1"
}

is_over() # STUDY: has nothing in the queue
{
	(($(count '^[a-z]+ -' "$1") == $(count . "$1")))
}

is_complete() # STUDY
{
	(($(count '^complete' "$1") == $(count . "$1")))
}

computes() # COUNT STUDY: so many of its runs hold their locks, and do some steps
{
	(($(count '^running' "$2") == $1)) && sleep 0.5
}

has_checkpoints() # STUDY: all of its runs do, from above step 0
{
	(($(find "results/$1" -name run.previous.h5 | wc -l) == $(count . "$1")))
}

at_work() # STUDY: all that is not complete computes, and something does
{
	(($(count '^(running|complete)' "$1") == $(count . "$1"))) && ! is_complete "$1" && sleep 0.5
}

says() # STUDY PATTERN: a log of its runs does
{
	cat "results/$1"/*/run.log 2>/dev/null | grep -q "$2"
}

submit() # STUDY OPTION...: what it says is in $said
{
	said=$(talus campaign run --executor slurm "${@:2}" "$1.yaml" 2>&1)
}

submitted() # did it hand anything over?
{
	grep -q '^job [0-9]' <<<"$said"
}

same_as_local() # STUDY
{
	local run

	for run in "local/$1"/*; do
		talus verify "results/$1/${run##*/}" >/dev/null || fail "$1: ${run##*/} is damaged"
		talus diff "$run" "results/$1/${run##*/}" >/dev/null || fail "$1: ${run##*/} differs"
		(($(grep -c 'started at step 0' "results/$1/${run##*/}/run.log") == 1)) ||
			fail "$1: ${run##*/} was started more than once"
	done
}

cat >base.yaml <<'END1'
slope: 22 deg
erodible_bed_thickness: 1.82 mm
layers: 8
domain: {x_min: -0.2 m, x_max: 3 m, cells: 640, right: outflow}
time: {end: 1 s, cfl: 0.02}
pressure_solver: {start: previous}
checkpoint: {every: 0, every_steps: 0}
END1
cat >array.yaml <<'END1'
base: base.yaml
runs: [{layers: [8, 7, 6, 5, 9, 3]}]
slurm: {partition: work, time: 5 min, memory: 100 MB, throttle: 2, directives: {nice: 1}}
END1
cat >limit.yaml <<'END1'
base: base.yaml
set: {time.cfl: 0.002}
slurm: {time: "1:00", grace: 55 s}
END1
cat >storm.yaml <<'END1'
base: base.yaml
set: {time.cfl: 0.0015, checkpoint.every_steps: 500}
runs: [{layers: [8, 7]}]
END1
cat >longer.yaml <<'END1'
base: base.yaml
runs: [{time.end: [0.9 s, 1 s]}]
END1
cat >damaged.yaml <<'END1'
base: base.yaml
set: {time.end: 0.1 s}
runs: [{layers: [3, 2]}]
END1
cat >full.yaml <<'END1'
base: base.yaml
set: {checkpoint.every_steps: 20}
runs: [{layers: [8, 7]}]
END1
cat >broken.yaml <<'END1'
base: base.yaml
set: {pressure_solver: {method: block-gauss-seidel, max_iterations: 3}}
END1

(
	trap 'kill $!; wait; exit 1' TERM
	for study in damaged array full storm limit; do
		talus campaign run -j 1 -o "local/$study" "$study.yaml" >/dev/null &
		wait $! || exit 1
	done
) &
local_pid=$!
cluster_start || fail "the cluster does not start"
pass "a Slurm of our own is up"

# slurmctld looks at time limits every 30 s. The run begins a little before it does so for the first time.
{
	sleep $((21 + slurmctld_began - SECONDS))
	exec talus campaign run --executor slurm limit.yaml >limit.said 2>&1
} &
limit_pid=$!

submit broken
wait_for 30 is_over broken || fail "the broken run stays in the queue"
[[ $(states broken) == 'failed - -' ]] || fail "the broken run: $(states broken)"
submit broken
(($? == 1)) || fail "a failed run: exit code 1 is wanted: $said"
! submitted || fail "a failed run was submitted without --retry: $said"
submit broken --retry 1 || fail "a failed run is not submitted with --retry: $said"
submitted || fail "a failed run is not submitted with --retry: $said"
wait_for 30 is_over broken || fail "the broken run stays in the queue"
grep -q 'attempt 2: started' results/broken/*/run.log || fail "--retry did not start a failed run anew"
submit broken --retry 2 --set layers=2 -o 'results/line
break'
(($? == 64)) || fail "a path with a line break: exit code 64 is wanted: $said"
sed -i '$a slurm: {partition: none}' broken.yaml
submit broken --retry 2
(($? == 69)) && [[ $said == *'Invalid partition'* ]] || fail "no such partition: $said"
pass "failed runs are submitted when asked for alone, and a refusal of sbatch is told"

submit damaged || fail "$said"
wait_for 60 is_complete damaged || fail "damaged: $(states damaged)"
for file in results/damaged/*/run*.h5; do
	truncate -s -100 "$file"
done
[[ $(states damaged | sort -u) == 'damaged - -' ]] || fail "damaged: $(states damaged)"
submit damaged
(($? == 65)) && ! submitted || fail "damaged runs are no reason to start anew without --retry: $said"
submit damaged --retry 1 && submitted || fail "damaged runs are not submitted with --retry: $said"
wait_for 60 is_complete damaged || fail "damaged: $(states damaged)"
for run in results/damaged/layers-*; do
	[[ -e $run/run.damaged.h5 && -e $run/run.previous.damaged.h5 ]] || fail "$(ls "$run"): what was damaged is not kept"
	grep -q 'attempt 2: started' "$run/run.log" || fail "${run##*/} was not started anew"
done
pass "damaged runs are started anew with --retry alone, and what was damaged is kept"

if [[ ${MOUNTED:-} ]]; then
	mkdir -p results/full
	mount -t tmpfs -o size=16m none results/full || fail "mount"
	mounted=$PWD/results/full
	submit full || fail "$said"
	wait_for 60 at_work full && wait_for 20 has_checkpoints full || fail "full: $(states full)"
	cat /dev/zero >results/full/filler 2>/dev/null
	wait_for 60 is_over full || fail "a full disk: the tasks go on: $(states full)"
	[[ $(states full | sort -u) == 'interrupted - -' ]] || fail "a full disk: $(states full)"
	talus verify results/full >/dev/null || fail "a full disk: $(talus verify results/full)"
	cat /dev/zero >results/full/rest 2>/dev/null # what the tasks gave back
	submit full
	code=$?
	((code == 73 || code == 74)) && [[ $said == *'No space left'* ]] && ! submitted ||
		fail "submitting on a full disk: exit code $code: $said"
	rm results/full/filler results/full/rest
	submit full || fail "a full disk used a try: $said"
	[[ $said == *': 2 runs'* ]] || fail "after a full disk: $said"
	wait_for 120 is_complete full || fail "full: $(states full)"
	grep -h 'resumed at step' results/full/*/run.log | grep -qv 'step 0,' || fail "a full disk: not resumed"
	pass "a full disk stops the tasks with their checkpoints whole and uses no try"
else
	echo "skipped: a full disk, as no mounts may be made here"
fi

talus campaign run -e slurm array.yaml >first 2>&1 &
talus campaign run -e slurm array.yaml >second 2>&1
wait $!
(($(cat first second | grep -c '^job') == 2)) || fail "two submissions at once: $(cat first second)"
cat first second | grep -q ': 4 runs' || fail "MaxArraySize is not kept: $(cat first second)"
most=0
until is_over array; do
	now=$(squeue --noheader --array --states=RUNNING --format=%j | grep -c talus-array)
	((now <= most)) || most=$now
	sleep 0.1
	if ! ((now)) || [[ ${asked:-} ]]; then continue; fi
	submit array || fail "submitting once more: $said"
	! submitted || is_over array || fail "what is in the queue was submitted again: $said"
	asked=yes
done
((most == 2)) || fail "throttle: $most tasks at a time"
is_complete array || fail "array: $(states array)"
submit array || fail "all complete: $said"
! submitted || fail "complete runs were submitted: $said"
pass "arrays are split at MaxArraySize and throttled over all of them; nothing is submitted twice"

submit longer || fail "$said"
wait_for 60 is_complete longer || fail "longer: $(states longer)"
says longer 'goes on from ./.*, a run to 0.9 s' || fail "the longer run did not go on from the shorter one"
(($(cat results/longer/*/run.log | grep -c 'started at step 0') == 1)) || fail "the longer run started at 0"
talus diff results/array/layers-8* "$(grep -l 'goes on' results/longer/*/run.log | sed 's|/run.log||')" \
	>/dev/null || fail "the run that went on differs from the one that did not"
pass "a run with a later end waits for the one that it goes on from, and equals one that did not"

wait "$limit_pid" || fail "$(cat limit.said)"
wait_for 90 says limit 'interrupted: .*SIGUSR1' || fail "the time limit stopped nobody"
wait_for 60 says limit 'resumed at step [1-9]' || fail "not resumed after the time limit"
pass "a task near its time limit stops, goes back into the queue and goes on where it was"

submit storm || fail "$said"
wait_for 60 at_work storm || fail "storm: $(states storm)"
other=$(sed 's/process \([0-9]*\) .*/\1/' results/storm/layers-7*/run.lock)
kill -STOP "$other" # it is to be there for what follows
scontrol requeue "$(states storm | awk 'NR == 1 {print $3}')" || fail "scontrol requeue"
wait_for 20 computes 1 storm || fail "requeue: $(states storm)"
wait_for 60 at_work storm || fail "a requeued task does not come back: $(states storm)"
kill -CONT "$other"
grep -q 'resumed at step [1-9]' results/storm/layers-8*/run.log || fail "requeue: not resumed"
pass "a requeued task goes on where it was"

sbatch --partition=urgent --exclusive --output=/dev/null --wrap='sleep 2' >/dev/null || fail "sbatch"
wait_for 30 computes 0 storm || fail "preemption: $(states storm)"
wait_for 60 at_work storm || fail "preempted tasks do not come back: $(states storm)"
(($(grep -l 'resumed at step [1-9]' results/storm/*/run.log | wc -l) == 2)) || fail "preemption: not resumed"
pass "preempted tasks go on where they were"

attempts=$(cat results/storm/*/run.log | grep -c 'ed at step')
kill_slurmd
sleep 1
at_work storm || fail "a killed slurmd: $(states storm)"
start_slurmd
wait_for 30 node_is_up || fail "the node does not come back"
(($(cat results/storm/*/run.log | grep -c 'ed at step') == attempts)) || fail "a killed slurmd stopped runs"
pass "the runs outlive a killed slurmd"

kill_node
wait_for 10 computes 0 storm || fail "the lost node still computes"
wait_for 60 node_is_down || fail "the loss of the node is not seen"
start_slurmd
wait_for 90 at_work storm || fail "the tasks of a lost node do not come back: $(states storm)"
pass "the tasks of a lost node come back"

said=$(talus campaign cancel storm.yaml) || fail "campaign cancel: $said"
[[ $said == '2 runs taken back from the queue'* ]] || fail "campaign cancel: $said"
[[ $(states storm | sort -u) == 'interrupted - -' ]] || fail "campaign cancel: $(states storm)"
submit storm || fail "$said"
[[ $said == *': 2 runs'* ]] || fail "resubmission of 2: $said"
wait_for 60 at_work storm || fail "storm: $(states storm)"
pass "campaign cancel takes tasks back with their checkpoints written, and they are submitted again"

scancel "$(states storm | awk '$3 != "-" {sub("_.*", "", $3); print $3; exit}')"
wait_for 30 is_over storm || fail "cancelled tasks stay in the queue: $(states storm)"
sleep 8 # as long as a requeued task waits
stopped=$(count '^interrupted -' storm)
((stopped)) && (($(count '^(interrupted|complete) -' storm) == 2)) || fail "cancel: $(states storm)"
submit storm || fail "$said"
[[ $said == *": $stopped run"* ]] || fail "resubmission of $stopped: $said"
wait_for 120 is_complete storm || fail "storm: $(states storm)"
pass "a cancelled array stays away until it is submitted again"

wait_for 120 is_complete limit || fail "limit: $(states limit)"
wait "$local_pid" || fail "the local campaigns failed"
for run in local/damaged/*; do
	talus diff "$run" "results/damaged/${run##*/}" >/dev/null || fail "damaged: ${run##*/} differs"
done
for study in array limit storm ${MOUNTED:+full}; do
	same_as_local "$study"
done
[[ ! $(find "$cluster" -name injected) ]] || fail "a path was run as a command"
pass "all results are those of the local executor, bit for bit"
