# Titles, names and values of an experiment from a stranger are shown as they stand: nothing in them is a
# command, neither for gnuplot nor for a shell, nor an element of the SVG.
source "$TALUS_ROOT/tests/cli/campaign-parts.bash"
# init files of whoever draws, and of where it is drawn, are not read
export HOME=$PWD GNUPLOT_LIB=$PWD GNUTERM=dumb
echo 'system("touch hacked-init")' | tee .gnuplot >gnuplotrc
cat >study.yaml <<'END'
title: "`touch hacked` ${HOME} $(touch hacked) '; system('touch hacked') #"
source: "\"`touch hacked`\" '\nsystem(\"touch hacked\")\n' \\"
base: collapse.yaml
runs: [{layers: [4, 2]}]
plots:
  - name: nasty
    title: "'`touch hacked`' \"`touch hacked`\" \nsystem('touch hacked')\n!touch hacked\n <script>x</script> & {/=90 big}_{sub}^@ ]]>"
    kind: profile
    y: h
    at: 0.1 s
    lines: layers
    names: {'4': "'. system(\"touch hacked\") .'", '2': "`touch hacked` \\"}
    x_label: "{/Symbol a} `touch hacked` ' . system('touch hacked') . '"
    y_label: "@macro $data \"\\\"`touch hacked`"
    published: [{title: "'\n!touch hacked\n'", points: [[0, 0.1]]}]
END
talus campaign run study.yaml >/dev/null
mkdir drawn
cp .gnuplot drawn/
talus plot -o drawn study.yaml
echo "exit $?"
find . -name 'hacked*'
python3 - <<'END'
import xml.etree.ElementTree as tree
names = {element.tag.split('}')[1] for element in tree.parse('drawn/nasty.svg').iter()}
print('script' in names)
for text in tree.parse('drawn/nasty.svg').iter('{http://www.w3.org/2000/svg}text'):
    words = ''.join(text.itertext()).strip()
    if any(letter.isalpha() for letter in words):
        print(words)
END
for name in ../up 'a b' "a'b" .hidden ''; do
	sed "s|name: nasty|name: \"$name\"|" study.yaml >named.yaml
	talus plot named.yaml
	echo "exit $?"
done
