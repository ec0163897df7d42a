# What scripts/deps says and does on machines that lack something: only the tools of shim/ exist, and
# its apt-get tells how it was called and installs nothing but valgrind, at the second attempt.
shim() # NAME SCRIPT
{
	printf '#!/bin/bash\n%s\n' "$2" >"shim/$1" && chmod +x "shim/$1"
}

deps()
{
	echo "\$ deps $*"
	PATH=$PWD/shim PYTHON=/absent "$TALUS_ROOT/scripts/deps" "$@" 2>&1
	echo "exit $?"
}

mkdir shim
for tool in bash env grep cat chmod; do
	ln -s "$(command -v $tool)" shim/
done
shim sleep 'echo "sleep $*"'
shim id 'echo 1000'

echo 'No apt-get:'
deps build valgrind
deps nonsense

echo 'Neither root nor sudo:'
shim apt-get 'echo "apt-get $*" >&2
case "$*" in
*update) exit ;;
*valgrind) [[ -e failed ]] && { : >shim/valgrind && chmod +x shim/valgrind; exit; }; : >failed ;;
esac
exit 100'
deps valgrind

echo 'With sudo, at the second attempt, and once more with nothing to do:'
shim sudo 'echo "sudo $*"; exec "$@"'
deps valgrind
deps valgrind

echo 'As root, when it cannot be installed:'
shim id 'echo 0'
deps format
