# The help, its example, and every wrong way to call.
cd "$TALUS_ROOT" || exit
talus check --help
for arguments in '' '--frobnicate a.yaml' '-x' '--set' '--help=3' '--reference a.yaml' '--reference --set layers=3'; do
	# shellcheck disable=SC2086 # words
	talus check $arguments
	echo "exit $?"
done
talus check --set layers=20 configs/granular-collapse.yaml | grep layers
