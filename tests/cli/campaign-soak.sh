# The soak test with few kills; `make soak` has more.
"$TALUS_ROOT/tests/soak/soak.sh" 5 | sed 's/: .*;/: .../'
