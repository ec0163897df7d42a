# The runner of these cases: what passes, fails, is skipped and is written.
mkdir cases
run="$TALUS_ROOT/tests/cli/run --cases cases"
cat >cases/places.sh <<'END'
echo "$PWD $TALUS_ROOT"
command -v talus
ls -A
printf 'no newline' >&2
exit 3
END
echo 'echo right' >cases/text.sh
printf '# stdout\nwrong\n# stderr\n# exit 0\n' >cases/text.out
echo 'echo no such machine; exit 77' >cases/skip.sh
echo 'sleep 60' >cases/slow.sh

TEST_TIMEOUT=1 $run
echo "exit $?"
rm cases/slow.sh
$run --update
echo "exit $?"
cat cases/places.out
$run
echo "exit $?"
$run tex
$run text.sh
$run --nonsense
echo "exit $?"
