# What the cases of the executor of clusters share: commands in the place of Slurm's. A job is a file of
# queue/ with the lines that squeue has of it. Sourced, not run.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
mkdir shim queue

shim() # NAME SCRIPT
{
	printf '#!/bin/bash\n%s\n' "$2" >"shim/$1" && chmod +x "shim/$1"
}

shim scontrol 'printf "Configuration data\nMaxArraySize            = 2\nMaxJobCount = 9\n"'
shim sbatch '[[ $1 == --version ]] && exit
echo "sbatch $*" >>calls
[[ ! -e refuse ]] || { echo "sbatch: error: Batch job submission failed: $(<refuse)" >&2; exit 1; }
job=$(wc -l <calls) name=${3#--job-name=}
n=0
while read -r run; do
	echo "${job}_$n PENDING $name ${REASON:-Resources}" >>queue/$job
	n=$((n + 1))
done <"${2#--chdir=}/slurm/$name.runs"
echo "$job;cluster"'
shim squeue 'cat queue/* 2>/dev/null; echo "7_1 RUNNING other None"; echo "8 PENDING ../x (null)"; echo nonsense'

slurm_mask()
{
	sed -E "s/(talus-study-)[0-9a-f]{8}/\1NAME/g; s/^folder=.*/folder=.../; s/^program=.*/program=.../; s/-[0-9a-f]{8}(\$|\t)/-HASH\1/g"
}
