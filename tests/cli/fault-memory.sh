# Memory that is merely short is asked for before HDF5 begins, which does not survive that it runs out: at
# every limit between the first at which the program starts and the first at which it has enough, it says
# what it lacks.
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
if [[ ${SANITIZER:-} == asan ]]; then
	echo "the address sanitizer needs more address space than any limit"
	exit 77
fi
write_small small.yaml
talus run --quiet small.yaml -o whole
limited() # KILOBYTES COMMAND...
{
	(ulimit -v "$1" && "${@:2}") >out 2>message
}

least=4096 most=1048576
while ((most - least > 64)); do
	middle=$(((least + most) / 2))
	# below it, even the loader may fall
	if limited $middle talus --version 2>/dev/null; then most=$middle; else least=$middle; fi
done
short() # COMMAND...
{
	local code told=0

	for ((limit = most; limit < most + 65536; limit += 128)); do
		rm -rf run
		limited $limit talus "$@"
		code=$?
		((code)) || break
		((code == 70)) && grep -q '^talus: .*out of memory (' message || echo "$limit kB: exit $code: $(cat message)"
		told=$((told + 1))
	done
	((told > 20)) || echo "only $told limits between nothing and enough"
	echo "exit $code at last: $*"
}
short info whole
short run --quiet small.yaml -o run
short verify whole
