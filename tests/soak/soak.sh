#!/bin/bash
# SIGKILL a campaign at random moments, again and again, and show that nothing is lost: every run goes
# on from its last checkpoint, and ends with the bits of a campaign that was left in peace.
#
# usage: tests/soak/soak.sh [KILLS [SEED]]      (100, the clock)
#
# Half of the kills hit the campaign alone, whose runs then stop by themselves; half hit the campaign and
# its runs at one stroke, as a lost machine does. `talus` is taken from PATH. Exit codes: 0, 1.
set -uo pipefail

kills=${1:-100}
seed=${2:-$(($(date +%s) % 32768))}
RANDOM=$seed
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CDPATH
exec 3>&2 # bash tells on 2 of every process that was killed

cat >base.yaml <<'END'
slope: 22 deg
erodible_bed_thickness: 1.82 mm
layers: 8
domain: {x_min: -0.2 m, x_max: 3 m, cells: 400, right: outflow}
time: {end: 0.8 s, cfl: 0.2}
output: {profiles_at: [0.1 s, 0.4 s, 0.8 s], series_every: 1 ms}
pressure_solver: {start: previous}
checkpoint: {every: 0, every_steps: 20}
END
cat >study.yaml <<'END'
base: base.yaml
runs:
  - {layers: [8, 6], n_ini_guess: [0, 2]}
  - {pressure: hydrostatic, layers: 20}
END

fail() # WORDS
{
	echo "soak: $* (seed $seed)" >&3
	exit 1
}

none_running()
{
	! talus campaign status study.yaml | tail -n 1 | grep -q running
}

# Where the attempts of a run began: only the first starts, steps never fall back. Prints how many
# resumed, and how many of those above step 0.
check_log() # RUN-LOG
{
	awk '
		/ (started|resumed) at step / {
			step = $0
			sub(/.* at step /, "", step)
			step += 0
			if (/ started / && begun) { print "started again at step 0"; bad = 1 }
			if (step < last) { print "resumed at step " step " after step " last; bad = 1 }
			if (/ resumed /) { resumes++; above += step > 0 }
			begun = 1
			last = step
		}
		END { if (!bad) print resumes + 0, above + 0; exit bad }' "$1"
}

check_round() # counts into $resumes and $above
{
	local run counts

	for run in results/study/*; do
		counts=$(check_log "$run/run.log") || fail "$run: $counts"
		resumes=$((resumes + ${counts% *}))
		above=$((above + ${counts#* }))
		talus verify "$run" >log 2>&1 || fail "$run is damaged: $(cat log)"
		talus diff "$run" "undisturbed/${run##*/}" >log 2>&1 || fail "$run differs: $(cat log)"
	done
}

kill_at_random() # PID of the campaign; false when it had ended before
{
	local victims=$1

	sleep "0.$((RANDOM % 6))$((RANDOM % 10))"
	((RANDOM % 2)) || victims="$victims $(ps -o pid= --ppid "$1")"
	# shellcheck disable=SC2086 # a list
	kill -KILL $victims
	wait "$1"
	(($? == 137))
}

talus campaign run -o undisturbed study.yaml >log 2>&1 || fail "the undisturbed campaign: $(cat log)"
killed=0 resumes=0 above=0 campaigns=1
while ((killed < kills)); do
	talus campaign run study.yaml >log 2>&1 &
	if kill_at_random $! 2>/dev/null; then
		killed=$((killed + 1))
	else
		grep -q failed log && fail "$(cat log)"
		check_round
		rm -rf results
		campaigns=$((campaigns + 1))
	fi
	until none_running; do sleep 0.02; done
done 2>/dev/null
talus campaign run study.yaml >log 2>&1 || fail "the last command: $(cat log)"
check_round
((above > 0 && (kills < 50 || above * 2 > resumes))) || fail "only $above of $resumes resumes were above step 0"
echo "soak: $killed kills in $campaigns campaigns, $resumes resumes, $above of them above step 0;" \
	"all results are bit-identical"
