# What a section `slurm:` may not say: nothing of a stranger's experiment becomes a command, a line of the
# script or a path.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
program=$(command -v talus)
mkdir none
plan() # ARGUMENT...: a dry run where there is no Slurm
{
	PATH=$PWD/none "$program" campaign run -e slurm -n "$@"
}

while IFS= read -r text; do
	printf 'base: collapse.yaml\nslurm: {%b}\n' "$text" >study.yaml
	echo "$text" >&2
	plan study.yaml >script 2>said || sed "\$a exit $?" said >&2
	grep -E 'time=|mem=|constraint=' script >&2
done <<'EOF'
partition: "short\\n#SBATCH --wrap=x"
partition: "short --wrap=x"
partition: [a, b]
partition: ""
partitoin: short
time: 90
time: 90 m
time: 90 min
time: "1-12:30"
time: "1:02:03"
time: "30:00"
time: "1-2-3"
time: "1:2:3:4"
time: "99999999999:00"
time: 30 s
time: 1e300 h
time: $(id)
time: 10 min, grace: 10 min
grace: 0 s
grace: 20 h
memory: 2 GB
memory: 512M
memory: 1 TiB
memory: 2
memory: 2.5 GB
memory: -1 GB
memory: 2 apples
throttle: 0
throttle: many
directives: [account]
directives: {wrap: "touch x"}
directives: {output: /etc/passwd}
directives: {export: LD_PRELOAD=evil.so}
directives: {array: 0-5}
directives: {account: "a b"}
directives: {account: "a\\n#SBATCH --wrap=x"}
directives: {account: "`id`"}
directives: {account: "$(id)"}
directives: {account: "a'b"}
directives: {account: "a#b"}
directives: {"account=x --wrap": y}
directives: {constraint: "[rack1|rack2]&intel"}
EOF

echo '--- paths and names' >&2
printf 'base: collapse.yaml\n' >study.yaml
plan -o $'line\n#SBATCH --wrap=x' study.yaml
echo "exit $?" >&2
plan -o "it's \$(touch injected) \`touch injected\` \"x\"" study.yaml 2>/dev/null | sed -n "s|^folder=.*/it|folder=.../it|p"
cp study.yaml $'a\n#SBATCH --wrap=x $(id).yaml'
plan -o out $'a\n#SBATCH --wrap=x $(id).yaml' 2>/dev/null | grep -E 'job-name|wrap' | sed -E 's/[0-9a-f]{8}/NAME/'
[[ ! -e injected ]]
