# One broken run folder never hides the others: status, why, run and the tables go on.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
base: collapse.yaml
runs: [{layers: [1, 2, 3, 4, 5, 6, 8]}]
tables: [{name: t, rows: layers, metric: steps}]
END
talus campaign run study.yaml >/dev/null
cd results/study || exit
for file in layers-1-*/run*.h5; do echo rubbish >"$file"; done
rm -r layers-2-* && touch "$(talus campaign status --json ../../study.yaml -o . | grep -o 'layers-2-[0-9a-f]*' | head -n 1)"
rm layers-3-*/run*.h5 && mkdir "$(echo layers-3-*)/run.h5"
printf '\0\0\0' >"$(echo layers-4-*)/status.yaml"
rm layers-5-*/run*.h5 && ln -s nowhere "$(echo layers-5-*)/run.h5"
printf 'x: [' >"$(echo layers-6-*)/config.yaml"
cd ../..
talus campaign status study.yaml | mask | sed -E 's/ +[0-9.]+ %.*(  [^ ])/ \1/; s/ +[0-9.]+ %.*//'
masked talus campaign run -j 1 --order given study.yaml 2>&1 | sed -E 's/[0-9T:Z-]{20} attempt/DATE attempt/'
echo "exit ${PIPESTATUS[0]}"
talus campaign why study.yaml | mask | grep -E '^(layers|  (state|next))'
talus campaign prune study.yaml
talus-tables study.yaml 2>/dev/null | head -n 12
