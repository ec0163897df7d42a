# A campaign completes its runs, tells how they are, and does nothing the second time.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
cat >study.yaml <<'END'
title: A "study"
base: collapse.yaml
runs: [{layers: [4, 2]}, {pressure: hydrostatic}]
END
masked talus campaign status study.yaml
masked talus campaign run -j 1 study.yaml
masked talus campaign status study.yaml | sed -E 's/ +[0-9.]+ +1 *$/  N  1/'
talus campaign status --json study.yaml | python3 -c '
import json, sys
status = json.load(sys.stdin)
print(status["title"], status["counts"])
for run in status["runs"]:
    print(run["settings"], run["state"], run["progress"], run["attempts"], run["wall_left"])'
ls results/study/*
before=$(cat results/study/*/run.h5 | sha256sum)
masked talus campaign run study.yaml
[[ $before == "$(cat results/study/*/run.h5 | sha256sum)" ]] || echo "the second command changed a run"
talus campaign run -o elsewhere --set layers=2 study.yaml >/dev/null && ls elsewhere | mask
