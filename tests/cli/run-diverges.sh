# numbers that are no flow any more: a run on a bed that is too rough for it fails, one whose energy rose a
# little is complete and says so, and what the message asks for carries it
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
rough=("$TALUS_ROOT/configs/granular-collapse.yaml" --quiet --set topography.shape=random
	--set domain.cells=160 --set time.end=1 --set scheme.friction_reconstruction=static --set 'output.profiles_at=[]')
safe=(--set scheme.exchange=upwind --set time.wave_speed=fastest)
numbers() # what is chaos in these
{
	sed -E 's/(step|t =|risen to|rose by) [0-9.e+-]+/\1 N/g'
}
run() # FOLDER SETTINGS...
{
	talus run "${rough[@]}" -o "$@" 2>&1 | numbers
	echo "exit ${PIPESTATUS[0]}"
}
run plain
run faster "${safe[@]}" --set time.cfl=0.5
talus info faster | grep -E '^  (status|reason)' | numbers
run doubtful "${safe[@]}" --set time.cfl=0.5 --set pressure=hydrostatic
grep warning doubtful/run.log | numbers | clocks
talus info doubtful | grep -E '^  (status|energy-rise)' | sed -E 's/0\.[0-9]+$/0.N/'
# a campaign says it, too, and its status keeps it
cat >rough.yaml <<EOF
base: $TALUS_ROOT/configs/granular-collapse.yaml
set:
  topography.shape: random
  domain.cells: 160
  time: {end: 1 s, cfl: 0.5, wave_speed: fastest}
  scheme: {friction_reconstruction: static, exchange: upwind}
  output.profiles_at: []
runs: [{pressure: hydrostatic}]
EOF
talus campaign run rough.yaml 2>&1 | grep warning | numbers | sed -E 's/[0-9a-f]{8}:/HASH:/'
talus campaign status rough.yaml --json | grep -o '"reason": "the energy rose'
run carried "${safe[@]}" --set time.cfl=0.1 --set layers=2
talus verify plain faster doubtful carried | grep -c ': good'
