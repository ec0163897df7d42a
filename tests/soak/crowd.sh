#!/bin/bash
# Several campaign commands at once on one folder, with SIGKILL for commands and runs at random: each run
# is started once, goes on where it was, and completes once, with the bits of a campaign left in peace.
#
# usage: tests/soak/crowd.sh [COMMANDS [KILLS [SEED]]]      (8, 50, the clock)
#
# A command that was killed is replaced by another. `talus` is taken from PATH. Exit codes: 0, 1.
set -uo pipefail

commands=${1:-8}
kills=${2:-50}
seed=${3:-$(($(date +%s) % 32768))}
RANDOM=$seed
work=$(mktemp -d)
trap 'kill -KILL ${crowd[*]} 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CDPATH
exec 3>&2 # bash tells on 2 of every process that was killed

cat >base.yaml <<'END'
slope: 22 deg
erodible_bed_thickness: 1.82 mm
layers: 6
domain: {x_min: -0.2 m, x_max: 3 m, cells: 200, right: outflow}
time: {end: 0.4 s, cfl: 0.2}
output: {profiles_at: [0.1 s, 0.4 s], series_every: 1 ms}
checkpoint: {every: 0, every_steps: 10}
END
printf 'base: base.yaml\nruns: [{layers: [2, 3, 4, 5, 6, 7], time.cfl: [0.2, 0.15]}]\n' >study.yaml

fail() # WORDS
{
	echo "crowd: $* (seed $seed)" >&3
	exit 1
}

# One start, at most one completion and nothing after it, steps that never fall back.
check_log() # RUN-LOG
{
	awk '
		/ attempt [0-9]+: (started|resumed) at step / {
			step = $0
			sub(/.* at step /, "", step)
			step += 0
			if (/ started / && begun++) fault = "started twice"
			if (step < last) fault = "resumed at step " step " after step " last
			if (complete) fault = "gone on with after its completion"
			last = step
		}
		/ attempt [0-9]+: complete: / && complete++ { fault = "completed twice" }
		/ attempt [0-9]+: failed: / { fault = $0 }
		END { if (fault) print fault; exit fault != "" }' "$1"
}

check_round()
{
	local run fault

	talus campaign run study.yaml >log 2>&1 || fail "the last command: $(cat log)"
	for run in results/study/*; do
		fault=$(check_log "$run/run.log") || fail "$run was $fault"
		talus verify "$run" >log 2>&1 || fail "$run: $(cat log)"
		talus diff "$run" "undisturbed/${run##*/}" >log 2>&1 || fail "$run differs: $(cat log)"
	done
	(($(find results/study -mindepth 1 -maxdepth 1 -type d | wc -l) == 12)) || fail "$(ls results/study)"
}

crowd=()
fill() # the crowd up to its number; commands that ended well are not replaced
{
	while ((${#crowd[@]} < commands)); do
		talus campaign run -j 2 study.yaml >"log.${#crowd[@]}" 2>&1 &
		crowd+=($!)
	done
}

# Kill one of the commands or of their runs. False when all commands have ended.
kill_one()
{
	local victims pid

	sleep "0.0$((RANDOM % 10))"
	victims=($(ps -o pid= -p "$(IFS=,; echo "${crowd[*]}")" --ppid "$(IFS=,; echo "${crowd[*]}")"))
	((${#victims[@]})) || return 1
	pid=${victims[RANDOM % ${#victims[@]}]}
	kill -KILL "$pid" || return 0
	killed=$((killed + 1))
	for i in "${!crowd[@]}"; do
		[[ ${crowd[i]} != "$pid" ]] || {
			wait "$pid"
			talus campaign run -j 2 study.yaml >"log.$i" 2>&1 &
			crowd[i]=$!
		}
	done
	return 0
}

talus campaign run -o undisturbed study.yaml >log 2>&1 || fail "the undisturbed campaign: $(cat log)"
killed=0 rounds=0
while ((killed < kills)); do
	crowd=()
	fill
	while ((killed < kills)) && kill_one; do
		:
	done
	for pid in "${crowd[@]}"; do
		wait "$pid"
		code=$?
		# 75: a run of its own was killed
		((code == 0 || code == 75)) || fail "a command ended with $code: $(cat log.*)"
	done
	crowd=()
	check_round
	rm -rf results
	rounds=$((rounds + 1))
done 2>/dev/null
echo "crowd: $commands commands at once, $killed kills in $rounds campaigns; each run completed once," \
	"all results are bit-identical"
