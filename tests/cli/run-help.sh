# every command says how it is used, and what is wrong with how it was used
for command in run info diff verify; do
	talus $command --help
	echo "-- $?"
done
for arguments in run "run a b" "run -o" "run --what a" "run -o '' a" info "info -x" diff "diff a" \
	"diff a b c" verify "verify --set a"; do
	eval "talus $arguments"
	echo "$arguments: $?"
done
