talus campaign --help
for action in run status watch why retry cancel prune; do
	echo "-- $action"
	talus campaign $action --help
	echo "-- exit $?"
done
