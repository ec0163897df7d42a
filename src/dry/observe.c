/* What a dry run records: series per step and profiles at chosen times. */
#include <math.h>
#include <string.h>

#include "dry/dry.h"

enum {
	FRONT_POSITION,
	FRONT_VELOCITY,
	MAX_SPEED,
	MAX_THICKNESS,
	MASS,
	MASS_OUTFLOW,
	ENERGY,
	KINETIC_ENERGY,
	POTENTIAL_ENERGY,
	PRESSURE_ITERATIONS,
	COARSE_ITERATIONS,
	PRESSURE_RESIDUAL,
	PRESSURE_METHOD,
	CPU_TRANSPORT,
	CPU_FRICTION,
	CPU_PRESSURE,
	STEADY_MAX_SPEED,
	BAGNOLD_ERROR,
};

const struct series dry_series[DRY_SERIES_COUNT] = {
	[FRONT_POSITION] = {.name = "front_position",
		.units = "m",
		.long_name = "rightmost crossing of the front threshold",
		.slope_of = -1},
	[FRONT_VELOCITY] = {.name = "front_velocity",
		.units = "m s-1",
		.long_name = "slope of the front position over the trailing 0.02 s",
		.slope_of = FRONT_POSITION,
		.window = 0.02},
	[MAX_SPEED] = {.name = "max_speed",
		.units = "m s-1",
		.long_name =
			"largest layer velocity along the slope, where the grains are 10 um thick or more",
		.slope_of = -1},
	[MAX_THICKNESS] = {.name = "max_thickness",
		.units = "m",
		.long_name = "largest thickness",
		.slope_of = -1},
	[MASS] = {.name = "mass",
		.units = "kg m-1",
		.long_name = "mass in the domain per unit width",
		.slope_of = -1},
	[MASS_OUTFLOW] = {.name = "mass_outflow",
		.units = "kg m-1",
		.long_name = "mass that has left through the ends per unit width",
		.slope_of = -1},
	[ENERGY] = {.name = "energy",
		.units = "J m-1",
		.long_name = "kinetic and potential energy per unit width (P1 Theorem 1)",
		.slope_of = -1},
	[KINETIC_ENERGY] = {.name = "kinetic_energy",
		.units = "J m-1",
		.long_name = "kinetic energy per unit width",
		.slope_of = -1},
	[POTENTIAL_ENERGY] = {.name = "potential_energy",
		.units = "J m-1",
		.long_name = "potential energy per unit width, 0 at the right end of the reference plane",
		.slope_of = -1},
	[PRESSURE_ITERATIONS] = {.name = "pressure_iterations",
		.units = "1",
		.long_name = "iterations of the pressure solver in the step",
		.whole = true,
		.slope_of = -1},
	[COARSE_ITERATIONS] = {.name = "coarse_iterations",
		.units = "1",
		.long_name = "iterations of the coarse system behind the first guess",
		.whole = true,
		.slope_of = -1},
	[PRESSURE_RESIDUAL] = {.name = "pressure_residual",
		.units = "1",
		.long_name = "true relative residual of the pressure system",
		.slope_of = -1},
	[PRESSURE_METHOD] = {.name = "pressure_method",
		.units = "1",
		.long_name = "method of the pressure solve: 0 none, 1 block-gauss-seidel, 2 "
					 "block-gauss-seidel-factored, 3 red-black-line-relaxation, 4 "
					 "conjugate-gradients, 5 block-direct, 6 lapack-band",
		.whole = true,
		.slope_of = -1},
	[CPU_TRANSPORT] = {.name = "cpu_transport",
		.units = "s",
		.long_name = "CPU time of step 1, transport",
		.slope_of = -1,
		.per_step_sum = true},
	[CPU_FRICTION] = {.name = "cpu_friction",
		.units = "s",
		.long_name = "CPU time of step 2, friction",
		.slope_of = -1,
		.per_step_sum = true},
	[CPU_PRESSURE] = {.name = "cpu_pressure",
		.units = "s",
		.long_name = "CPU time of step 3, non-hydrostatic pressure",
		.slope_of = -1,
		.per_step_sum = true},
	[STEADY_MAX_SPEED] = {.name = "steady_max_speed",
		.units = "m s-1",
		.long_name =
			"velocity of the uppermost layer in the exact steady flow (P3 52) of a uniform "
			"initial height",
		.slope_of = -1},
	[BAGNOLD_ERROR] = {.name = "bagnold_error",
		.units = "1",
		.long_name =
			"relative distance of the velocities from that flow, in the middle of the domain "
			"(P3 53)",
		.slope_of = -1},
};

enum {
	BED,
	THICKNESS,
	STATIC_HEIGHT,
	VELOCITY,
	NORMAL_VELOCITY,
	PRESSURE,
	STRAIN_RATE,
	FRICTION,
	STEADY_VELOCITY,
	STEADY_STRAIN_RATE,
	STEADY_FRICTION,
	BOTTOM_DISSIPATION,
	LAYER_DISSIPATION,
};

const struct profile dry_profiles[DRY_PROFILE_COUNT] = {
	[BED] = {"b", "m", "bed above the reference plane", PROFILE_X, true},
	[THICKNESS] = {"h", "m", "thickness normal to the reference plane", PROFILE_X, false},
	[STATIC_HEIGHT] = {"static_height", "m", "height of the flow/no-flow interface above the bed",
		PROFILE_X, false},
	[VELOCITY] = {"u", "m s-1", "layer velocity along the slope", PROFILE_LAYER_X, false},
	[NORMAL_VELOCITY] = {"w", "m s-1", "layer velocity normal to the slope", PROFILE_LAYER_X,
		false},
	[PRESSURE] = {"p", "Pa", "total pressure at the layer interfaces", PROFILE_INTERFACE_X, false},
	[STRAIN_RATE] = {"strain_rate", "s-1", "shear |d_z u| at the layer interfaces",
		PROFILE_INTERFACE_X, false},
	[FRICTION] = {"mu", "1", "friction coefficient mu(I) at the layer interfaces",
		PROFILE_INTERFACE_X, false},
	[STEADY_VELOCITY] = {"u_steady", "m s-1",
		"layer velocity in the exact steady flow (P3 52) of a uniform initial height",
		PROFILE_LAYER, false},
	[STEADY_STRAIN_RATE] = {"strain_rate_steady", "s-1", "shear in that flow", PROFILE_INTERFACE,
		false},
	[STEADY_FRICTION] = {"mu_steady", "1", "friction coefficient in that flow", PROFILE_INTERFACE,
		false},
	[BOTTOM_DISSIPATION] = {"bottom_dissipation", "W m-2",
		"power of the friction at the bottom (P1 Theorem 1)", PROFILE_X, false},
	[LAYER_DISSIPATION] = {"layer_dissipation", "W m-2",
		"power of the friction between the layers (P1 Theorem 1)", PROFILE_X, false},
};

/* Rightmost crossing of h - h_i = threshold, linear between the cell centres; NaN: none. */
static double front(const struct model_state *s)
{
	double level = s->par.bed + s->par.front_threshold;
	const double *h = s->h;
	int i = s->grid.cells;

	while (i >= 1 && h[i] <= level)
		i--;
	if (i < 1)
		return NAN;
	if (i == s->grid.cells)
		return s->grid.x_min + s->grid.cells * s->grid.dx;
	return grid_centre(&s->grid, i) + s->grid.dx * (h[i] - level) / (h[i] - h[i + 1]);
}

/* P3 (53) over the layers of a cell, weighted by their thickness. */
static double bagnold_error(const struct model_state *s, int i)
{
	double apart = 0, whole = 0;

	for (int a = 0; a < s->layers; a++) {
		double exact = s->steady_u[a], u = s->u[(size_t)a * s->grid.stride + (size_t)i];

		apart += dry_layer(s, a) * (u - exact) * (u - exact);
		whole += dry_layer(s, a) * exact * exact;
	}
	return sqrt(apart / whole);
}

void dry_observe(const struct model_state *s, double *values)
{
	double mass = 0, speed = 0, thickest = 0;

	for (int i = 1; i <= s->grid.cells; i++) {
		mass += s->h[i];
		thickest = s->h[i] > thickest ? s->h[i] : thickest;
		if (s->h[i] >= DRY_NO_PRESSURE) /* a film before a steep toe never quite stops */
			speed = s->fastest[i] > speed ? s->fastest[i] : speed;
	}
	values[FRONT_POSITION] = front(s);
	values[MAX_SPEED] = speed;
	values[MAX_THICKNESS] = thickest;
	values[MASS] = s->par.rho * s->grid.dx * mass;
	values[MASS_OUTFLOW] = s->mass[1];
	values[ENERGY] = dry_energy(s, 0, &values[KINETIC_ENERGY]);
	values[POTENTIAL_ENERGY] = values[ENERGY] - values[KINETIC_ENERGY];
	values[PRESSURE_ITERATIONS] = s->iterations;
	values[COARSE_ITERATIONS] = s->coarse_iterations;
	values[PRESSURE_RESIDUAL] = s->residual;
	values[PRESSURE_METHOD] = s->method;
	values[CPU_TRANSPORT] = s->cpu[0];
	values[CPU_FRICTION] = s->cpu[1];
	values[CPU_PRESSURE] = s->cpu[2];
	values[STEADY_MAX_SPEED] = s->steady_u[s->layers - 1];
	values[BAGNOLD_ERROR] = bagnold_error(s, (s->grid.cells + 1) / 2);
}

/* Height below which the column is slower than the static speed, linear between layer middles. */
static double static_height(const struct model_state *s, int i)
{
	double limit = s->par.static_speed, slower = 0, slower_at = 0, dz = s->h[i] / s->layers;

	for (int a = 0; a < s->layers; a++) {
		double speed = fabs(s->u[(size_t)a * s->grid.stride + (size_t)i]),
			   at = 0.5 * (s->level[a] + s->level[a + 1]) * dz;

		if (speed >= limit)
			return a == 0 ? 0 : slower_at + (at - slower_at) * (limit - slower) / (speed - slower);
		slower = speed;
		slower_at = at;
	}
	return s->h[i];
}

/* Without non-hydrostatic pressure w is what incompressibility makes it, P1 (9d). */
static void diagnose_w(const struct model_state *s, double *values)
{
	int cells = s->grid.cells;
	double width = 2 * s->grid.dx;
	const double *h = s->h, *b = s->bed;

	for (int i = 1; i <= cells; i++) {
		double below = 0;

		for (int a = 0; a < s->layers; a++) {
			const double *u = s->u + (size_t)a * s->grid.stride;
			double flux =
				(h[i + 1] * u[i + 1] - h[i - 1] * u[i - 1]) / (dry_layers_of(s, a) * width);
			double middle =
				(b[i + 1] - b[i - 1] + s->layer_middle[a] * (h[i + 1] - h[i - 1])) / width;

			values[(size_t)a * (size_t)cells + (size_t)(i - 1)] =
				u[i] * middle - below - 0.5 * flux;
			below += flux;
		}
	}
}

/* p/rho below layer a in cell i, m2/s2. */
static double total_pressure(const struct model_state *s, int a, int i)
{
	const double *q = s->q + (size_t)a * (size_t)s->grid.faces + i;
	double fluctuation = a < s->layers ? 0.5 * (q[-1] + q[0]) : 0;

	return s->par.gc * s->h[i] * (s->layers - s->level[a]) / s->layers + fluctuation;
}

/* |d_z u| there as friction takes it: between the middles of the layers, and at the bottom; 1/s. */
static double shear(const struct model_state *s, int a, int i)
{
	const double *u = s->u + (size_t)a * s->grid.stride + i;
	double apart = 1 / dry_bottom_layers(s), jump = 0;

	if (a == 0)
		jump = u[0];
	else if (a < s->layers) {
		jump = u[0] - *(u - s->grid.stride);
		apart = s->layer_middle[a] - s->layer_middle[a - 1];
	}
	return s->h[i] > DRY_NO_MOMENTUM ? fabs(jump) / (apart * s->h[i]) : 0;
}

/* Twice the d_x u that goes with it, P3 (55), as friction takes it. */
static double stretch(const struct model_state *s, int a, int i)
{
	const double *above = s->u + (size_t)a * s->grid.stride + i, *below = above;

	if (a == s->layers || (a == 0 && s->par.friction.no_slip))
		return 0;
	if (a > 0)
		below -= s->grid.stride;
	return 0.5 * (above[1] - above[-1] + below[1] - below[-1]) / s->grid.dx;
}

/* mu(I) there. Where nothing presses and nothing is sheared, as at the surface, it is mu_s. */
static double friction(const struct model_state *s, int a, int i)
{
	double rate = shear(s, a, i), along = s->par.friction.second_order ? stretch(s, a, i) : 0;

	return dry_mu(&s->par, sqrt(rate * rate + along * along), fmax(0, total_pressure(s, a, i)));
}

static void each_interface(const struct model_state *s, double scale,
	double (*value)(const struct model_state *s, int a, int i), double *values)
{
	for (int a = 0; a <= s->layers; a++)
		for (int i = 1; i <= s->grid.cells; i++)
			*values++ = scale * value(s, a, i);
}

static void copy_cells(const struct model_state *s, const double *field, int rows, double *values)
{
	size_t cells = (size_t)s->grid.cells;

	for (int a = 0; a < rows; a++)
		for (size_t i = 0; i < cells; i++)
			values[(size_t)a * cells + i] = field[(size_t)a * s->grid.stride + i + 1];
}

void dry_profile(const struct model_state *s, size_t index, double *values)
{
	switch (index) {
	case BED:
		copy_cells(s, s->bed, 1, values);
		break;
	case THICKNESS:
		copy_cells(s, s->h, 1, values);
		break;
	case STATIC_HEIGHT:
		for (int i = 1; i <= s->grid.cells; i++)
			values[i - 1] = static_height(s, i);
		break;
	case VELOCITY:
		copy_cells(s, s->u, s->layers, values);
		break;
	case NORMAL_VELOCITY:
		if (s->par.non_hydrostatic)
			copy_cells(s, s->w, s->layers, values);
		else
			diagnose_w(s, values);
		break;
	case STRAIN_RATE:
		each_interface(s, 1, shear, values);
		break;
	case FRICTION:
		each_interface(s, 1, friction, values);
		break;
	case STEADY_VELOCITY:
		memcpy(values, s->steady_u, (size_t)s->layers * sizeof *values);
		break;
	case STEADY_STRAIN_RATE:
		memcpy(values, s->steady_strain, ((size_t)s->layers + 1) * sizeof *values);
		break;
	case STEADY_FRICTION:
		memcpy(values, s->steady_mu, ((size_t)s->layers + 1) * sizeof *values);
		break;
	case PRESSURE:
		each_interface(s, s->par.rho, total_pressure, values);
		break;
	default:
		dry_dissipation(s, index == LAYER_DISSIPATION, values);
	}
}
