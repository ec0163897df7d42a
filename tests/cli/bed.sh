# a bed from a file: what is refused and where, and that a run needs the file no more once it has begun
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
mkdir beds
write_small beds/small.yaml
echo 'topography: {shape: file, points: bed.txt}' >>beds/small.yaml
talus check beds/small.yaml
for text in '# x b\n0 1\n' '' '0 1\n1 one\n' '0 1\n1\n' '0, 1, 2\n' '0 1\n\n0 2\n' '0 nan\n1 0\n' \
	'0 0\n0.2 0.1\n' 'a\0b'; do
	printf '%b' "$text" >beds/bed.txt
	talus check beds/small.yaml >/dev/null
	echo "$?"
done
printf '# x in m, b in m\r\n-0.1, 0\r\n0.1\t0.02 # the step\r\n\r\n0.3; 0.01' >beds/bed.txt
talus check beds/small.yaml | grep -A 7 topography

refuse() # SETTING...
{
	local -a settings=()
	for setting; do settings+=(--set "$setting"); done
	talus check beds/small.yaml "${settings[@]}" >/dev/null
}
refuse topography.points=
refuse 'topography.points=[[0, 1]]'
refuse 'topography.points=[[0, 1], [2]]'
refuse 'topography.points=[[0 m, 1 deg], [2, 0]]'
refuse 'topography.points={x: 1}'
refuse topography.shape=plane
refuse topography.shape=random topography.points=[] domain.x_min=-4
refuse topography.shape=random topography.points=[] topography.coordinates=cartesian
refuse topography.shape=bump topography.points=[]
refuse initial.shape=file
refuse gate.speed=1 pressure=hydrostatic
refuse gate.speed=1 topography.coordinates=cartesian
refuse scheme.friction=coulomb
refuse scheme.friction=coulomb layers=1 bottom=no-slip
talus run beds/small.yaml --quiet -o cliff --set coordinates=cartesian \
	--set topography.coordinates=local --set 'topography.points=[[-1, 0], [0, 0.5], [0.1, 0], [1, 0]]'
echo "$?"
talus run beds/small.yaml --quiet -o short --set topography.coordinates=cartesian
echo "$?"

talus run beds/small.yaml --quiet -o straight
talus run beds/small.yaml --quiet -o stopped --set time.end=0.2
rm beds/bed.txt
talus info --config straight >again.yaml
talus run again.yaml --quiet -o stopped
talus run again.yaml --quiet -o again && talus diff straight again && echo the same bits
for coordinates in local cartesian; do
	talus run again.yaml --quiet -o $coordinates --set coordinates=$coordinates --set slope='0 deg'
done
talus diff local cartesian | grep -v config_hash
