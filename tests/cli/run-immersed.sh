# The immersed model from config to file: what is refused, what is recorded, killed in the middle of an
# adaptive run and resumed to the same bits, and a step that fails with the state before it saved.
config=$TALUS_ROOT/configs/immersed-low-viscosity.yaml
talus check --quiet "$config" "$TALUS_ROOT/configs/immersed-high-viscosity.yaml"
talus check --set n_ini_guess=2 "$config"
talus check --set layer_fractions=[0.5,0.4] --set layers=2 "$config"
talus check --set layer_fractions=[0.5,0.5] "$config"
talus check --set fluid.density=2600 "$config"
talus check --set rheology.law=linear "$TALUS_ROOT/configs/granular-collapse.yaml"
talus check --reference=wet

steps() # mask a number that hangs on the last bit of an error
{
	sed -E 's/[0-9]+ steps to t = /N steps to t = /'
}
talus run --set layers=4 -o straight "$config" | sed 's/, [0-9.]* s of CPU time//' | steps
talus info straight | sed -n '/model/p; /preserves/,$p'
ncdump -h straight/run.h5 | grep -E '^	(double|int64|int) (max_speed|v|p_s|steps)\(|^	(layer|interface|x) ='
talus verify straight | steps

# finer, so that it takes long enough to be killed in between
finer=(talus run --quiet --set time.tolerance=1e-9 --set checkpoint.every_steps=500 "$config" -o)
"${finer[@]}" whole
"${finer[@]}" killed &
until talus info killed 2>/dev/null | grep -qE 'done +[1-9]'; do sleep 0.01; done
kill -KILL $!
wait $! 2>/dev/null
talus info killed | grep -E 'status|done' | sed 's/[0-9]* steps to t = .*/some steps/'
"${finer[@]}" killed
talus diff whole killed && echo "same bits"
talus info killed | grep -o 'in [0-9]* attempts'

# 100 times too long a step: the state before the failure is in the file
talus run --set time.scheme=semi-implicit --set time.step=1e-3 --set output.profiles_at=[] -o fails "$config" \
	2>&1 | sed 's/ = [-+0-9.einfa]*/ = #/g'
talus info fails | grep -E 'status|done' | sed 's/[0-9]* steps to t = .*/some steps/'
talus verify fails
