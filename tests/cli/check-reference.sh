# The reference config is the one in the tree, and a config itself.
talus check --reference >reference.yaml
cmp reference.yaml "$TALUS_ROOT/configs/reference.yaml" && talus check --quiet reference.yaml
