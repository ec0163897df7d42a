# shellcheck shell=bash
# limit SECONDS COMMAND...: run the command with a time limit; its exit code, or 124 when out of time.
# A stop of the shell ends the command and all it started. The command sees SIGINT as usual, although
# the shell ignores it for what runs in the background.
limit()
{
	local status=0

	env --default-signal=INT,QUIT timeout -k 10 "$@" &
	# shellcheck disable=SC2064 # this process, now
	trap "kill $! 2>/dev/null; wait $!; exit 130" INT TERM
	{ wait $! || status=$?; } 2>/dev/null # the shell would report a crash with a process number
	trap - INT TERM
	return "$status"
}
