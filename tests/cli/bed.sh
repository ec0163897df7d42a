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
# as spreadsheets and old editors write it: a byte order mark, lines that end with CR
printf '\xEF\xBB\xBF-0.1, 0\r# the step\r0.1, 0.02\r0.3, 0.01\r' >beds/bed.txt
talus check beds/small.yaml | grep points:
printf '\xEF\xBB\xBF-0.1, 0\r\n0.1, 0.02 m\r\n' >beds/bed.txt
talus check beds/small.yaml >/dev/null
printf -- '-0.1, 0\r0.1 one\r' >beds/bed.txt
talus check beds/small.yaml >/dev/null
printf '# x in m, b in m\n-0.1 0\n0.1 0.02\n0.3 0.01\n' >beds/bed.txt

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
refuse 'topography.points=[[-1, 0], [1, 1000.1 km]]'
refuse initial.shape=file 'initial.points=[[0, 0.1], [0.1, -0.1]]'
refuse initial.shape=heap initial.centre=50 erodible_bed_thickness=0
refuse initial.shape=level 'initial.surface_slope=-89.9999999999 deg'
refuse domain.left=periodic domain.right=periodic
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
