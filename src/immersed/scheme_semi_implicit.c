/* The scheme of P4 3.4.4: phi and the drag explicit, viscous stresses implicit with frozen coefficients,
 * the pressure from one linearisation about that of the step before. In the fluid equation G_f stands
 * at both interfaces (printed once as G_s), and the factor 1/2 of (31i) is that of eta_s = eta D. The height
 * follows from the phi, not from a rate of its own, so that the granular mass is exact. */
#include <math.h>

#include "immersed/immersed.h"

/* One row of a tridiagonal system with `below` < 0 and `above` < 0; x is the right side and then, in the
 * forward sweep, the right side of what is left. */
struct sweep {
	double *above; /* of the eliminated rows */
	double factor;
};

static void eliminate(
	struct sweep *sweep, double *x, int a, double below, double diagonal, double above)
{
	double pivot = 1 / (diagonal - (a ? below * sweep->above[a - 1] : 0));

	sweep->above[a] = above * pivot;
	x[a] = (x[a] - (a ? below * x[a - 1] : 0)) * pivot;
}

static void substitute(const struct sweep *sweep, double *x, int n)
{
	for (int a = n - 1; a-- > 0;)
		x[a] -= sweep->above[a] * x[a + 1];
}

/* eta/h of each interface: the stress over the difference in velocity, from the state of t^n. */
static void viscosities(const struct model_state *s, double h, double *out)
{
	struct immersed_interface at;

	for (int a = 0; a < s->layers; a++) {
		double difference;

		immersed_interface(s, &s->now, h, a, &at);
		difference = at.shear / at.slope;
		/* at rest: the derivative, which is the limit */
		out[a] = difference != 0 ? at.stress / difference : at.stress_shear * at.slope;
	}
	out[s->layers] = 0;
}

/* The mass fluxes through the interfaces at t^n (P4 36-39): positive upwards into the layer below. */
static void transfers(const struct model_state *s, double h, double *solid, double *fluid)
{
	const double *S = s->now.S;
	double grains = 0, share = 0;
	double surface = s->par.keeps_mass ? S[s->layers - 1] * h / s->mass : 0;

	solid[0] = fluid[0] = 0;
	for (int a = 0; a < s->layers; a++) {
		grains += s->l[a] * s->now.phi[a];
		share += s->l[a];
		solid[a + 1] = surface * grains - S[a];
		fluid[a + 1] = surface * share - solid[a + 1];
	}
}

static void move_grains(struct model_state *s, double dt, double h, double h_next,
	const double *viscosity, const double *transfer, const double *phi, double *v)
{
	const struct immersed_parameters *par = &s->par;
	const struct immersed_column *c = &s->now;
	struct sweep sweep = {.above = s->work[6]};
	int n = s->layers;

	for (int a = 0; a < n; a++) {
		double thickness = s->l[a] * h, old = c->phi[a];
		double drag = par->drag * old * old / (1 - old) * thickness;
		double up = a + 1 < n ? c->v[a + 1] : 0, down = a ? c->v[a - 1] : 0;
		double middle = 0.5 * (c->p[a] + (a + 1 < n ? c->p[a + 1] : 0));
		double wall = par->wall != 0
						  ? par->wall * thickness * middle /
								sqrt(c->v[a] * c->v[a] + par->delta_velocity * par->delta_velocity)
						  : 0;

		v[a] = par->rho_s * thickness * old * c->v[a] +
			   dt * (drag * (c->u[a] - c->v[a]) + par->pull * thickness * old +
						0.5 * par->rho_s *
							(transfer[a + 1] * (up + c->v[a]) - transfer[a] * (c->v[a] + down)));
		eliminate(&sweep, v, a, -dt * viscosity[a],
			par->rho_s * s->l[a] * h_next * phi[a] + dt * (viscosity[a] + viscosity[a + 1] + wall),
			-dt * viscosity[a + 1]);
	}
	substitute(&sweep, v, n);
}

static void move_fluid(struct model_state *s, double dt, double h, double h_next,
	const double *transfer, const double *phi, double *u)
{
	const struct immersed_parameters *par = &s->par;
	const struct immersed_column *c = &s->now;
	struct sweep sweep = {.above = s->work[6]};
	int n = s->layers;
	double viscous_below = 0;

	for (int a = 0; a < n; a++) {
		double thickness = s->l[a] * h, old = c->phi[a];
		double drag = par->drag * old * old / (1 - old) * thickness;
		double up = a + 1 < n ? c->u[a + 1] : 0, down = a ? c->u[a - 1] : 0;
		double viscous_above = a + 1 < n ? par->eta / immersed_spacing(s, h, a + 1) : 0;

		u[a] = par->rho_f * thickness * (1 - old) * c->u[a] +
			   dt * (-drag * (c->u[a] - c->v[a]) +
						0.5 * par->rho_f *
							(transfer[a + 1] * (up + c->u[a]) - transfer[a] * (c->u[a] + down)));
		eliminate(&sweep, u, a, -dt * viscous_below,
			par->rho_f * s->l[a] * h_next * (1 - phi[a]) + dt * (viscous_below + viscous_above),
			-dt * viscous_above);
		viscous_below = viscous_above;
	}
	substitute(&sweep, u, n);
}

static int check(const struct model_state *s, const struct immersed_column *c, struct error *err)
{
	for (int a = 0; a < s->layers; a++)
		if (!isfinite(c->v[a] + c->u[a] + c->p[a] + c->S[a]) || !(c->phi[a] > 0 && c->phi[a] < 1))
			return error_set(err, EX_FAILED,
				"layer %d is no flow (phi = %g, v = %g m/s, u = %g m/s, p = %g Pa): "
				"time.step (%g s) is too long for the semi-implicit scheme, "
				"or take time.scheme: tr-bdf2",
				a + 1, c->phi[a], c->v[a], c->u[a], c->p[a], s->fixed_step);
	return 0;
}

static int step(struct model_state *s, double dt, struct error *err)
{
	struct immersed_column *next = &s->trial, kept = s->now;
	double h = immersed_height(s, s->now.phi), h_next;
	double *solid = s->work[5], *fluid = s->work[7], *viscosity = s->work[4];

	for (int a = 0; a < s->layers; a++)
		next->phi[a] =
			s->now.phi[a] - dt * (s->now.S[a] - (a ? s->now.S[a - 1] : 0)) / (s->l[a] * h);
	h_next = immersed_height(s, next->phi);
	viscosities(s, h, viscosity);
	transfers(s, h, solid, fluid);
	move_grains(s, dt, h, h_next, viscosity, solid, next->phi, next->v);
	move_fluid(s, dt, h, h_next, fluid, next->phi, next->u);
	immersed_pressure(s, next, h_next, s->now.p);
	TRY(check(s, next, err));
	s->now = *next;
	s->trial = kept;
	s->record.steps++;
	s->taken = dt;
	return 0;
}

static double time_step(const struct model_state *s)
{
	return s->fixed_step;
}

static void begin(struct model_state *s)
{
	s->record.next = s->fixed_step;
}

const struct immersed_scheme scheme_semi_implicit = {"semi-implicit", begin, time_step, step};
