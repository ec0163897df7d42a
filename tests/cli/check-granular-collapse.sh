# The effective config of the annotated one, in SI units; it reads back to itself.
talus check "$TALUS_ROOT/configs/granular-collapse.yaml" | tee effective.yaml
talus check effective.yaml | cmp - effective.yaml
