# The counter of tests: programs that pass, fail, crash, skip, stop early, print no plan or hang.
program() # NAME: its text from stdin
{
	{
		echo '#!/bin/bash'
		cat
	} >"tests/test_$1" && chmod +x "tests/test_$1"
}

mkdir tests
program good <<<'printf "1..2\nok 1 - a\nok 2 - b\n"'
program skips <<<'printf "1..2\nok 1 - a\nnot ok 2 # SKIP b\n"'
program fails <<<'printf "1..2\nok 1 - a\nnot ok 2 - b\n# why\n"; exit 1'
program leaks <<<'printf "1..1\nok 1 - a\n"; exit 99'
program crashes <<<'printf "1..2\nok 1 - a\n"; kill -SEGV $$'
program stops <<<'printf "1..2\nok 1 - a\n"'
program silent <<<':'
program hangs <<<'sleep 60'
program place <<<'printf "1..1\n"; [[ -z $(ls -A) && -x $TALUS_ROOT/tests/run-all && $PATH == "$BIN":* ]] &&
	trap "echo ok 1 - interrupted" INT && kill -INT $$'

run=$TALUS_ROOT/tests/run-all
$run tests/test_good tests/test_skips tests/test_place
echo "exit $?"
for bad in fails leaks crashes stops silent; do
	$run -l label tests/test_$bad
	echo "exit $?"
done
TEST_TIMEOUT=1 $run -j 2 tests/test_hangs tests/test_good | tail -n 1
$run
echo "exit $?"
