# --dry-run tells what would be done with each run and changes nothing.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
base: collapse.yaml
runs: [{layers: [4, 2], n_ini_guess: [0, 1]}]
END
masked talus campaign run --dry-run -j 3 study.yaml
[[ ! -e results ]] || echo "a folder was made"
talus campaign run --set layers=2 study.yaml >/dev/null
masked talus campaign run --dry-run study.yaml
