# Everything that README.md shows to be typed about runs and their files works as it stands there.
readme=$TALUS_ROOT/README.md

# the code of the n-th block in that language
block() # LANGUAGE N
{
	awk -v open="\`\`\`$1" -v wanted="$2" '
		$0 == open { n++; inside = n == wanted; next }
		/^```/ { inside = 0 }
		inside' "$readme"
}

# the commands of a section, indented by four blanks, with bin/ on PATH and the repository's files
commands() # TITLE
{
	awk -v title="## $1" '$0 == title { inside = 1; next } /^## / { inside = 0 }
		inside && /^    / { print substr($0, 5) }' "$readme" | sed 's|^bin/||'
}

ln -s "$TALUS_ROOT/configs" "$TALUS_ROOT/experiments" .
commands 'One run' >run.sh
grep -c . run.sh
bash run.sh >run.out 2>run.err
echo "exit $?"
tail -n 1 run.out
commands 'Figures' >figures.sh
grep -c . figures.sh
bash figures.sh 2>&1 | grep figures/
commands 'Laws, bottom, walls and ends' >laws.sh
grep -c . laws.sh
bash laws.sh >laws.out 2>&1
echo "exit $?"
commands 'Grains in a fluid' >fluid.sh
grep -c . fluid.sh
bash fluid.sh >fluid.out 2>&1
echo "exit $?"
tail -n 1 fluid.out
block python 1 >read.py
grep -c . read.py
/usr/bin/python3 read.py | sed 's/\([0-9]\.[0-9]\)[0-9]*/\1/g'
block sh 1 >read.sh
grep -c . read.sh
bash read.sh | grep -c 'front_velocity'
grep '^    bin/talus campaign.*--dry-run' "$readme" | sed 's|^ *bin/||' | bash | tail -n 1 | sed 's/, about.*//'
grep -oE '(`|^    )make [a-z0-9-]+' "$readme" | sed 's/.*make //' | sort -u | while read -r target; do
	make -C "$TALUS_ROOT" -n "$target" >/dev/null 2>&1 || echo "no target $target"
done
