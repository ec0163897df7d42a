# No `runs` are one run of the base config.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: collapse.yaml\nruns: []\n' >study.yaml
masked talus campaign run study.yaml
