# A later time.end: runs go on from those with an earlier one, in a folder of their own, to the same bits;
# of one experiment with several ends, too. Timed runs begin at 0.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: collapse.yaml\nruns: [{layers: [4, 2]}]\n' >study.yaml
talus campaign run study.yaml >/dev/null
sed -i 's/end: 0.2 s/end: 0.3 s/' collapse.yaml
masked talus campaign run --dry-run study.yaml
masked talus campaign why study.yaml layers-4 | sed 's|results/study/layers-4-HASH|OLD|'
echo "-- a key that changed"
talus campaign why study.yaml -s time.cfl=0.4 -s time.end=0.2 | masked sed -E 's|(study/layers-.)-.*|\1-OLD|; s/-[0-9a-f]{8}$/-NEW/'
talus campaign why study.yaml "$(ls results/study | head -n 1)" | mask
echo "-- what is gone on from is kept"
masked talus campaign prune study.yaml --yes | sed -E 's/[0-9.]+ s of CPU time, [0-9.]+ [kM]B/.../'
masked talus campaign run -j 1 study.yaml
grep -h -o 'continued at step [0-9]' results/study/*/run.log
talus campaign run -o straight study.yaml >/dev/null
for run in straight/*; do talus diff "$run" "results/study/${run##*/}" && echo same; done
echo "-- until then"
masked talus campaign prune study.yaml --yes | sed -E 's/[0-9.]+ s of CPU time, [0-9.]+ [kM]B/.../; s/[0-9.]+ [kM]B, .*/.../'
ls results/study | mask

cat >ends.yaml <<'END'
base: collapse.yaml
runs: [{time.end: [0.4 s, 0.2 s, 0.3 s]}]
END
masked talus campaign run --dry-run ends.yaml
talus campaign run -j 2 ends.yaml >/dev/null
grep -h -o -E '(started|continued) at step [0-9]' results/ends/*/run.log | sed 's/[1-9]$/N/'
talus run -q collapse.yaml -o one -s time.end=0.4
talus diff one results/ends/end-0.4s-* && echo same
sed -i 's/^runs/timing: true\nruns/' ends.yaml
talus campaign run --dry-run -o timed ends.yaml | mask
