# Every target that is no file stands in the help, and nothing else does.
make -C "$TALUS_ROOT" -s help >help || exit
make -C "$TALUS_ROOT" -npq help | sed -n 's/^\.PHONY: *//p' | tr ' ' '\n' | grep -vx FORCE | sort -u >targets
sed -n 's/^  \([a-z0-9-]*\) .*/\1/p' help | sort -u >listed
diff targets listed && grep -c '^  check ' help
