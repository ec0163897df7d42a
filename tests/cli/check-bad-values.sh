# One bad value at a time in an otherwise good file: the whole of stderr.
while IFS= read -r line; do
	key=${line%%:*}
	{
		[[ $key == slope ]] || echo 'slope: 22 deg'
		[[ $key == erodible_bed_thickness ]] || echo 'erodible_bed_thickness: 1.82 mm'
		[[ $key == layers ]] || echo 'layers: 10'
		printf '%b\n' "$line"
	} >collapse.yaml
	echo "$line" >&2
	talus check collapse.yaml && echo "accepted: $line"
	[[ $? == 65 ]] || echo "exit code of: $line"
done <<'END'
layers: 2.5
layers: 1e3
layers: 1.0
layers: 10x
layers: 0x10
layers: nan
layers: ten
layers: 0
layers: 513
layers: 99999999999
layers: -1
layers:
layers: ~
layers: [10]
layers: {n: 10}
layer: 10
Layers: 10
colour: red
domain: {cell: 640}
domain: {colour: red}
cells: 640
x_min: 0 m
grain: {diameter: 1 mm}
slope: 22
slope: 22 degrees
slope: 22 m
slope: 90 deg
slope: -1 deg
slope: 1.58 rad
slope: nan
slope: inf deg
slope: tan(22 deg)
erodible_bed_thickness: -1 mm
erodible_bed_thickness: 1.82 mm thick
erodible_bed_thickness: 1,82 mm
erodible_bed_thickness: 1.82 s
erodible_bed_thickness: nan
erodible_bed_thickness: -inf
erodible_bed_thickness: .inf
erodible_bed_thickness: 0x1p-9
erodible_bed_thickness: 1e999 m
erodible_bed_thickness: 1e-999 m
erodible_bed_thickness: thin
erodible_bed_thickness: ''
erodible_bed_thickness: yes
initial: {height: 0 m}
initial: {height: 14 deg}
initial: {shape: colum}
initial: {front: 4 m}
initial: {front: -1 m}
grains: {density: 2500 kg}
grains: {density: 0 kg/m3}
grains: {solid_fraction: 62 %}
grains: {solid_fraction: 1.2}
rheology: {mu_s: tan(25.5)}
rheology: {mu_s: tan(25.5 deg}
rheology: {mu_s: 25.5 deg}
rheology: {mu_s: 0}
rheology: {mu_s: 0.8}
rheology: {mu_2: 0.3, mu_s: 0.4}
rheology: {i_0: 0}
rheology: {law: coulomb}
regularisation: {strain_rate: 1e-5 m/s}
regularisation: {velocity: 0 m/s}
domain: {x_min: 3 m}
domain: {x_min: 1 m, x_max: 0.5 m}
domain: {cells: 1}
domain: {cells: 2000000}
domain: {cells: 640.0}
domain: {right: open}
domain: {cells: 3}\npressure_solver: {operator: pointwise}
domain: wide
domain: [640]
domain:
time: {end: 0 s}
time: {end: 3 m}
time: {cfl: 1.1}
time: {cfl: 0}
time: {wave_speed: fast}
pressure: nonhydrostatic
pressure: 3 Pa
model: wet
pressure_solver: {method: conjugate-gradients, operator: pointwise}
pressure_solver: {operator: pointwise, method: block-direct}
pressure_solver: {relaxation: 2}
pressure_solver: {residual: 0}
pressure_solver: {norm: l3}
pressure_solver: {norm: max}
pressure_solver: {operator: Symmetric}
pressure_solver: {tolerance: 0}
pressure_solver: {max_iterations: 1.5}
scheme: {friction_reconstruction: dynamic}
scheme: {viscosity_updates: -1}
layers: 1\nscheme: {friction: coulomb, viscosity_updates: 1}
n_ini_guess: 3
n_ini_guess: 10
n_ini_guess: 12
output: {profiles_at: 3 s}
output: {profiles_at: [1 s, 1 s]}
output: {profiles_at: [1 s, 4 s]}
output: {profiles_at: [1 s, [2 s]]}
output: {profiles_at: [1 s, 2 m]}
output: {profiles_at: [-1 s]}
output: {front_threshold: 0 mm}
checkpoint: {every: -1 s}
checkpoint: {every_steps: 0.5}
erodible_bed_thickness: 1e300
topography: {plane_height: 1e300}
topography: {plane_height: -1e300}
topography: {shape: file, points: [[-1, 0], [4, 1e300]]}
domain: {x_max: 1e300}
domain: {x_min: -1e300}
domain: {x_min: 0, x_max: 1e-300}
domain: {x_min: 999999.99, x_max: 1000000, cells: 1000000}
initial: {height: 1e300}
initial: {shape: heap, centre: 1e300}
grains: {diameter: 1e300}
rheology: {mu_2: 1e300}
time: {end: 1e300}
time: {cfl: 1e-300}
output: {gauges: [1e300]}
layers: 20\nlayers: 10
time: {cfl: 0.5}\ntime: {end: 1 s}
time: {cfl: 0.5}\ntime.cfl: 0.6
END
