/* What an immersed run records: series and profiles. */
#include <math.h>

#include "immersed/immersed.h"

enum {
	MAX_SPEED,
	MEAN_SPEED,
	STEADY_MAX_SPEED,
	STEADY_MEAN_SPEED,
	FRACTION,
	EQUILIBRIUM_FRACTION,
	BOTTOM_PRESSURE,
	EXCESS_PRESSURE,
	PRESSURE_ROOT,
	PRESSURE_ERROR,
	HEIGHT,
	FLUID_TRANSFER,
	SOLID_TRANSFER,
	SOLID_MASS,
	MAX_SLIP,
	STEPS,
	REJECTED_STEPS,
	NEWTON_ITERATIONS,
};

const struct series immersed_series[IMMERSED_SERIES_COUNT] = {
	[MAX_SPEED] = {.name = "max_speed",
		.units = "m s-1",
		.long_name = "largest layer velocity of the grains (v_max)",
		.slope_of = -1},
	[MEAN_SPEED] = {.name = "mean_speed",
		.units = "m s-1",
		.long_name = "velocity of the grains, mean over the height",
		.slope_of = -1},
	[STEADY_MAX_SPEED] = {.name = "steady_max_speed",
		.units = "m s-1",
		.long_name =
			"velocity of the uppermost layer in the exact steady flow of the present height",
		.slope_of = -1},
	[STEADY_MEAN_SPEED] = {.name = "steady_mean_speed",
		.units = "m s-1",
		.long_name = "velocity in the exact steady flow of the present height, mean over it",
		.slope_of = -1},
	[FRACTION] = {.name = "fraction",
		.units = "1",
		.long_name = "volume share of the grains, mean over the height",
		.slope_of = -1},
	[EQUILIBRIUM_FRACTION] = {.name = "equilibrium_fraction",
		.units = "1",
		.long_name = "volume share of the grains at which they would neither dilate nor contract, "
					 "mean over the height (P4 eq. 10)",
		.slope_of = -1},
	[BOTTOM_PRESSURE] = {.name = "bottom_pressure",
		.units = "Pa",
		.long_name = "solid pressure at the bottom",
		.slope_of = -1},
	[EXCESS_PRESSURE] = {.name = "excess_pressure",
		.units = "Pa",
		.long_name = "excess pore fluid pressure at the bottom",
		.slope_of = -1},
	[PRESSURE_ROOT] = {.name = "bottom_pressure_root",
		.units = "Pa",
		.long_name = "solid pressure at the bottom, root of P4 eq. 45 for the present velocities",
		.slope_of = -1},
	[PRESSURE_ERROR] = {.name = "pressure_error",
		.units = "1",
		.long_name =
			"relative distance of the solid pressure from that root, largest over the interfaces",
		.slope_of = -1},
	[HEIGHT] = {.name = "height",
		.units = "m",
		.long_name = "height of the mixture",
		.slope_of = -1},
	[FLUID_TRANSFER] = {.name = "fluid_transfer",
		.units = "m s-1",
		.long_name = "fluid that enters the mixture through its surface",
		.slope_of = -1},
	[SOLID_TRANSFER] = {.name = "solid_transfer",
		.units = "m s-1",
		.long_name = "grains that enter the mixture through its surface",
		.slope_of = -1},
	[SOLID_MASS] = {.name = "solid_mass",
		.units = "kg m-2",
		.long_name = "mass of the grains per area",
		.slope_of = -1},
	[MAX_SLIP] = {.name = "max_slip",
		.units = "m s-1",
		.long_name = "largest difference between the velocities of fluid and grains in a layer",
		.slope_of = -1},
	[STEPS] = {.name = "steps",
		.units = "1",
		.long_name = "steps since the start",
		.whole = true,
		.slope_of = -1},
	[REJECTED_STEPS] = {.name = "rejected_steps",
		.units = "1",
		.long_name = "steps since the start that were tried and made shorter",
		.whole = true,
		.slope_of = -1},
	[NEWTON_ITERATIONS] = {.name = "newton_iterations",
		.units = "1",
		.long_name = "iterations of Newton's method since the start",
		.whole = true,
		.slope_of = -1},
};

enum { SPEED, FLUID_SPEED, PHI, SOLID_PRESSURE, PORE_PRESSURE, STEADY_SPEED, STEADY_PHI };

const struct profile immersed_profiles[IMMERSED_PROFILE_COUNT] = {
	[SPEED] = {"v", "m s-1", "layer velocity of the grains", PROFILE_LAYER, false},
	[FLUID_SPEED] = {"u", "m s-1", "layer velocity of the fluid", PROFILE_LAYER, false},
	[PHI] = {"phi", "1", "volume share of the grains", PROFILE_LAYER, false},
	[SOLID_PRESSURE] = {"p_s", "Pa", "solid pressure at the layer interfaces", PROFILE_INTERFACE,
		false},
	[PORE_PRESSURE] = {"p_e", "Pa", "excess pore fluid pressure at the layer interfaces",
		PROFILE_INTERFACE, false},
	[STEADY_SPEED] = {"v_steady", "m s-1",
		"velocity of the grains in the exact steady flow of the present height, layer means",
		PROFILE_LAYER, false},
	[STEADY_PHI] = {"phi_steady", "1",
		"volume share of the grains in the exact steady flow, layer means", PROFILE_LAYER, false},
};

static void copy(const struct model_state *s, const double *from, double *values)
{
	for (int a = 0; a < s->layers; a++)
		values[a] = from[a];
}

/* The solid pressure that the weight alone would make, at each interface. */
static void hydrostatic(const struct model_state *s, double h, double *p)
{
	p[s->layers] = 0;
	for (int a = s->layers; a-- > 0;)
		p[a] = p[a + 1] + s->par.weight * s->l[a] * h * s->now.phi[a];
}

/* The pressure against the root of its equation, which is looked for in the scratch column: no step
 * needs that once it is done. */
static void observe_root(const struct model_state *s, double h, double *values)
{
	struct immersed_column c = s->now;
	bool found;

	c.p = s->known.p;
	c.S = s->known.S;
	copy(s, s->now.p, c.p);
	found = immersed_pressure_exact(s, &c, h) > 0;
	values[PRESSURE_ROOT] = found ? c.p[0] : NAN;
	values[PRESSURE_ERROR] = found ? 0 : NAN;
	for (int a = 0; found && a < s->layers; a++)
		values[PRESSURE_ERROR] = fmax(values[PRESSURE_ERROR], fabs(s->now.p[a] / c.p[a] - 1));
}

static void observe_steady(const struct model_state *s, double *values)
{
	double *v = s->known.v;

	immersed_exact(s, v, s->known.phi);
	values[STEADY_MAX_SPEED] = v[s->layers - 1];
	for (int a = 0; a < s->layers; a++)
		values[STEADY_MEAN_SPEED] += s->l[a] * v[a];
}

void immersed_observe(const struct model_state *s, double *values)
{
	const struct immersed_column *c = &s->now;
	double h = immersed_height(s, c->phi), top = c->S[s->layers - 1], mass = 0, weight = 0;

	for (int i = 0; i < IMMERSED_SERIES_COUNT; i++)
		values[i] = 0;
	for (int a = 0; a < s->layers; a++) {
		double shear = (c->v[a] - (a ? c->v[a - 1] : 0)) / immersed_spacing(s, h, a);
		double slip = fabs(c->u[a] - c->v[a]);

		values[MAX_SPEED] = fmax(values[MAX_SPEED], fabs(c->v[a]));
		values[MEAN_SPEED] += s->l[a] * c->v[a];
		values[FRACTION] += s->l[a] * c->phi[a];
		values[EQUILIBRIUM_FRACTION] +=
			s->l[a] * (s->par.phi_c - s->par.k_2 * immersed_inertia(&s->par, shear, c->p[a]));
		values[MAX_SLIP] = fmax(values[MAX_SLIP], slip);
		mass += s->l[a] * h * c->phi[a];
		weight += s->par.weight * s->l[a] * h * c->phi[a];
	}
	values[BOTTOM_PRESSURE] = c->p[0];
	values[EXCESS_PRESSURE] = weight - c->p[0];
	observe_root(s, h, values);
	observe_steady(s, values);
	values[HEIGHT] = h;
	values[FLUID_TRANSFER] = s->par.keeps_mass ? top * h / s->mass : top;
	values[SOLID_TRANSFER] = s->par.keeps_mass ? 0 : -top;
	values[SOLID_MASS] = s->par.rho_s * mass;
	values[STEPS] = s->record.steps;
	values[REJECTED_STEPS] = s->record.rejected;
	values[NEWTON_ITERATIONS] = s->record.newton_iterations;
}

void immersed_profile(const struct model_state *s, size_t index, double *values)
{
	const double *const layers[] = {
		[SPEED] = s->now.v, [FLUID_SPEED] = s->now.u, [PHI] = s->now.phi};

	switch (index) {
	case SPEED:
	case FLUID_SPEED:
	case PHI:
		copy(s, layers[index], values);
		break;
	case SOLID_PRESSURE:
		copy(s, s->now.p, values);
		values[s->layers] = 0;
		break;
	case PORE_PRESSURE:
		hydrostatic(s, immersed_height(s, s->now.phi), values);
		for (int a = 0; a < s->layers; a++)
			values[a] -= s->now.p[a];
		break;
	case STEADY_SPEED:
		immersed_exact(s, values, s->right);
		break;
	default:
		immersed_exact(s, s->right, values);
	}
}
