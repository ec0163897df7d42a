# Files that are no config at all: the whole of stderr.
check() # NAME: a file of that text from stdin
{
	cat >"$1.yaml"
	talus check "$1.yaml"
	[[ $? == 65 ]] || echo "exit code of $1"
}

check empty </dev/null
check comment <<<'# nothing else'
check no-slope <<<$'erodible_bed_thickness: 1.82 mm\nlayers: 10'
check no-bed <<<$'slope: 22 deg\nlayers: 10'
check no-layers <<<$'slope: 22 deg\nerodible_bed_thickness: 1.82 mm'
check list <<<'- layers: 10'
check word <<<'layers'
check alias <<<$'slope: &s 22 deg\nlayers: *s'
check alias-alone <<<'layers: *s'
check tag <<<'layers: !!int 10'
check complex-key <<<'{[a]: 1}'
check duplicate <<<$'layers: 10\nslope: 22 deg\nlayers: 10'
check two-documents <<<$'layers: 10\n---\nlayers: 20'
check unclosed <<<'domain: {cells: 640'
check tabs <<<$'domain:\n\tcells: 640'
check bracket <<<$'domain: ]'
check deep <<<"layers: $(printf '[%.0s' {1..17})"
head -c 200000 /dev/zero | tr '\0' '[' | check brackets
head -c 200000 /dev/zero | tr '\0' '{' | check braces
head -c 2000000 /dev/zero | tr '\0' '#' | check long
check nul < <(printf 'layers: 10\0\n')
check nul-escape <<<'layers: "1\0"'
check latin1 < <(printf 'layers: 10 # \xe9tages\n')
check utf16 < <(printf '\xff\xfel\0a\0')
check binary < <(printf '\x89HDF\r\n\x1a\n\0\0')
check escape <<<'"lay\e[31mers": 10'
mkdir folder.yaml
for path in folder.yaml missing.yaml missing/a.yaml ''; do
	talus check "$path"
	[[ $? == 65 ]] || echo "exit code of '$path'"
done
