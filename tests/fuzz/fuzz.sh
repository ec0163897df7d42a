#!/bin/bash
# Fuzz each target for a while with libFuzzer and with AFL++, from the committed corpus and from what was
# found before. What crashes, hangs or takes too much memory is kept, named and makes exit 1.
#
# usage: tests/fuzz/fuzz.sh BUILD SECONDS TARGET...
set -uo pipefail

build=$(realpath "$1") seconds=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
export AFL_SKIP_CPUFREQ=1 AFL_NO_UI=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 \
	AFL_NO_AFFINITY=1 AFL_NO_COLOR=1
failed=0
for target; do
	found=$build/fuzz/$target
	mkdir -p "$found"/{corpus,crashes,afl}
	echo "libFuzzer, $target, $seconds s"
	"$build/libfuzzer/fuzz_$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=1024 -max_len=65536 \
		-print_final_stats=1 -artifact_prefix="$found/crashes/" "$found/corpus" "$here/corpus/$target" \
		>"$found/libfuzzer.log" 2>&1 || failed=1
	grep -E '^(stat::number_of_executed_units|stat::peak_rss_mb|SUMMARY|.*Test unit written)' "$found/libfuzzer.log"
	echo "AFL++, $target, $seconds s"
	timeout -k 10 $((seconds + 60)) afl-fuzz -V "$seconds" -t 20000 -i "$here/corpus/$target" -o "$found/afl" \
		-- "$build/afl/fuzz_$target" >"$found/afl.log" 2>&1
	grep -E '^(execs_done|corpus_count|saved_crashes|saved_hangs)' "$found/afl/default/fuzzer_stats" || {
		tail -n 20 "$found/afl.log"
		failed=1
	}
	for file in "$found"/crashes/* "$found"/afl/default/{crashes,hangs}/id*; do
		[[ ! -e $file ]] || {
			echo "found: $file"
			failed=1
		}
	done
done
rm -rf /tmp/talus-fuzz-*
exit "$failed"
