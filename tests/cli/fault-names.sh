# Odd names of files and folders, and links in results, are names and nothing else.
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
write_small small.yaml
long=$(printf 'long%.0s' {1..60})
names=('two words' "it's" '"quoted"' '`touch stolen`' '$(touch stolen)' '; touch stolen' '-leading' '--help'
	$'new\nline' '%s%n' 'ünïcode' '*' "$long")
for name in "${names[@]}"; do
	cp small.yaml "./$name.yaml"
	talus run --quiet -- "$name.yaml" || echo "run $name: $?"
	talus verify "results/$name" >/dev/null || echo "verify $name: $?"
	printf 'base: small.yaml\ntables: [{name: "t; touch stolen", rows: layers, metric: steps}]\n' \
		>"./$name-study.yaml"
	[[ $name == "$long" ]] || talus campaign run -o "$name results" "./$name-study.yaml" >/dev/null ||
		echo "campaign $name: $?"
	[[ $name == "$long" ]] || talus campaign status -- "$name-study.yaml" >/dev/null || echo "status $name: $?"
	[[ $name == "$long" ]] || talus-tables -o "$name results" -- "$name-study.yaml" >tables ||
		echo "tables $name: $?"
	again=$(sed -n 's/^Again with: //p' tables)
	[[ $name == *$'\n'* ]] || eval "$again" >again.out 2>&1 || echo "again $name: $again: $(cat again.out)"
done
find . -name stolen
ls -d ./*results | sort | head -n 3

echo '== a name that is too long'
talus run small.yaml -o "$long$long" 2>&1 | sed -E 's/(long)+/LONG/'
echo "exit ${PIPESTATUS[0]}"

echo '== names that would lie outside of results'
cp small.yaml ...yaml
cp small.yaml ..yaml
for command in run 'campaign run' 'campaign status'; do
	for name in ...yaml ..yaml; do
		# shellcheck disable=SC2086
		talus $command "$name"
		echo "exit $?"
	done
done 2>&1

echo '== links'
mkdir elsewhere scratch
echo precious >elsewhere/file
ln -s scratch linked
talus run --quiet small.yaml -o linked/run && ls scratch/run
for name in run.lock run.log run.h5.tmp status.yaml.tmp config.yaml.tmp config.yaml status.yaml; do
	mkdir "links-$name"
	ln -s "$PWD/elsewhere/file" "links-$name/$name"
	talus run --quiet small.yaml -o "links-$name" 2>&1
	echo "$name: $?"
	cmp elsewhere/file <<<precious
done
mv scratch/run/run.h5 elsewhere/archived.h5
ln -s "$PWD/elsewhere/archived.h5" scratch/run/run.h5
cp elsewhere/archived.h5 before.h5
talus run small.yaml -o linked/run | clocks
cmp before.h5 elsewhere/archived.h5 && echo untouched

echo '== titles'
cat >titles.yaml <<'END'
title: |
  two
  lines, "quotes", `backticks`
base: small.yaml
tables: [{name: t, rows: layers, metric: steps}]
END
talus campaign run titles.yaml >/dev/null
for format in text markdown csv; do
	talus-tables -f $format titles.yaml | grep -e lines
done
printf 'title: "\\e]0;owned\\a"\nbase: small.yaml\n' >titles.yaml
talus campaign run titles.yaml
echo "exit $?"
printf 'base: small.yaml\npublished: {"\\e[31m": 1}\n' >titles.yaml
talus campaign run titles.yaml

echo '== texts that speak to the terminal, in the files of a run'
printf 'base: small.yaml\nruns: [{layers: [2, 1]}]\n' >speaks.yaml
talus campaign run speaks.yaml >/dev/null
"${PYTHON:-/usr/bin/python3}" - <<'END'
import h5py
with h5py.File('before.h5', 'a') as file:
    file.attrs['created'] = b'\033]0;owned\a'
END
for run in results/speaks/*; do
	sed -i 's/^reason:.*/reason: "\\e]0;owned\\a"/; s/^state:.*/state: failed/' "$run/status.yaml"
	printf '\e]0;owned\a\n' >>"$run/run.log"
	rm "$run"/run*.h5
	cp before.h5 "$run/run.h5" # made from another config
done
echo damaged >"$run/run.h5"
for command in 'campaign status speaks.yaml' 'campaign why speaks.yaml' 'campaign run speaks.yaml' \
	'campaign watch speaks.yaml' 'info before.h5'; do
	# shellcheck disable=SC2086
	talus $command >out 2>&1
	echo "exit $?: $command: $(grep -c owned out) owned, $(grep -c $'[\e\a]' out) spoken"
done
