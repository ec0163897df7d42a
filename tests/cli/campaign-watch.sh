# watch tells changes line by line, and on a terminal draws a table that fits; status fits it, too.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: long.yaml\nset: {time.end: 0.5 s}\nruns: [{layers: [8, 7], output.front_threshold: 1 mm}]\n' >study.yaml
talus campaign watch --interval 0.1 study.yaml >out &
watch=$!
script -qec 'stty columns 80 rows 24; talus campaign watch -i 0.1 study.yaml' /dev/null >screen </dev/null &
talus campaign run -j 2 study.yaml >/dev/null
wait $watch
echo "exit $?"
wait
head -n 1 out
grep -E '^layers' out | mask | sort
tail -n 1 out
grep -c -E 'layers-8-[0-9a-f]{8}  +running +\[#*-*\] +[0-9]+ %  [0-9.]+ s left' screen >/dev/null && echo drawn
tr -d '\r' <screen | grep complete | tail -n 1 | sed 's/\x1b.*//'
cat >wide.yaml <<'END'
base: collapse.yaml
runs: [{output.front_threshold: [0.000123456789 m, 0.000223456789 m], pressure_solver.max_iterations: [1, 1000], time.cfl: [0.3123456789, 0.5]}]
END
talus campaign run wide.yaml >/dev/null 2>&1
script -qec 'stty columns 80 rows 24; talus campaign status wide.yaml' /dev/null </dev/null | tr -d '\r' | mask |
	sed -E 's/( +[0-9.]+ %) +[0-9.]+ +1$/\1/'
script -qec 'stty columns 80 rows 12; talus campaign status wide.yaml' /dev/null </dev/null | tr -d '\r' | grep -c .
script -qec 'stty columns 80 rows 24; talus campaign status wide.yaml' /dev/null </dev/null | tr -d '\r' |
	awk 'length > 80 && !/talus campaign/ { print "wider than the screen: " $0 }'
