# Two and eight commands at once with kills, in small; `make soak` has more.
"$TALUS_ROOT/tests/soak/crowd.sh" 2 3 | sed 's/,.*;/ .../'
"$TALUS_ROOT/tests/soak/crowd.sh" 8 5 | sed 's/,.*;/ .../'
