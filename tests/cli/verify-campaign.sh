# talus verify on the folder of a campaign: file by file, and which generation is good.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
printf 'base: collapse.yaml\nset: {checkpoint.every_steps: 20}\nruns: [{layers: [2, 3, 4]}]\n' >study.yaml
talus campaign run study.yaml >/dev/null
verify()
{
	talus verify "$@" | sed -E 's/-[0-9a-f]{8}/-HASH/g'
	echo "exit ${PIPESTATUS[0]}"
}
verify results/study
printf damage | dd of="$(echo results/study/layers-2-*/run.h5)" bs=1 seek=3000 conv=notrunc status=none
for file in results/study/layers-3-*/run*.h5; do
	truncate -s -1 "$file"
done
rm results/study/layers-4-*/run.h5
verify results/study
verify results
verify results/study/layers-2-*/run.h5 results/study/layers-4-*
talus verify --help
