/* The equations of an implicit stage and their Jacobian, in blocks of the five unknowns of a layer.
 *
 * Rows: phi, v, u of the stage, P4 (35b)-(35d) in the form that is divided by the mass of the layer;
 * p and S, P4 (45a). The unit of p is the weight of the grains and that of S what makes such a
 * pressure, so that the pivots compare like with like. Two dependences are left out of the Jacobian,
 * not of the equations, as they are weak and would fill it: that of the height on every phi (PGM), and
 * that of the exchange between layers on S.
 */
#include <math.h>
#include <string.h>

#include "immersed/immersed.h"

void immersed_units(const struct model_state *s, double *p, double *S)
{
	double phi = s->mass / s->depth;

	*p = s->par.weight * s->mass;
	*S = *p / (s->depth * immersed_seepage(&s->par, phi));
}

/* What a layer exchanges with its neighbours (P4 36, 37 or 38, 39): mass flux downwards through the
 * interfaces, with the mean velocity of both sides, which above the mixture is 0 (P4 3.3). */
struct transfer {
	double solid_below, solid_above, fluid_below, fluid_above; /* m/s */
};

static struct transfer transfer_of(const struct model_state *s, const struct immersed_column *x,
	double surface, double share, double grains, int a)
{
	double below = a ? x->S[a - 1] : 0, above = x->S[a];
	struct transfer t = {
		.solid_below = surface * grains - below,
		.solid_above = surface * (grains + s->l[a] * x->phi[a]) - above,
	};

	/* in PH surface is 0, and what dilates away is replaced by fluid */
	t.fluid_below = surface * share - t.solid_below;
	t.fluid_above = surface * (share + s->l[a]) - t.solid_above;
	return t;
}

static void add_grains(struct model_state *s, const struct immersed_column *x, double h, double w,
	int a, const struct immersed_interface *at, const struct immersed_interface *next,
	const struct transfer *t, double unit_p)
{
	const struct immersed_parameters *par = &s->par;
	int n = s->layers;
	double phi = x->phi[a], thickness = s->l[a] * h, factor = w / (par->rho_s * thickness * phi);
	double v = x->v[a], slip = x->u[a] - v;
	double v_below = a ? x->v[a - 1] : v, v_above = a + 1 < n ? x->v[a + 1] : 0;
	double drag = par->drag * phi * phi / (1 - phi) * thickness;
	double drag_phi = par->drag * phi * (2 - phi) / ((1 - phi) * (1 - phi)) * thickness;
	double fast = sqrt(v * v + par->delta_velocity * par->delta_velocity);
	double middle = 0.5 * (x->p[a] + (a + 1 < n ? x->p[a + 1] : 0));
	double rubbing = par->wall * thickness / fast;
	double rubbing_v = rubbing * (par->delta_velocity / fast) * (par->delta_velocity / fast);
	double up = 0.5 * par->rho_s * t->solid_above, down = 0.5 * par->rho_s * t->solid_below;
	double share = a && !par->backward ? 0.5 : 1, share_next = par->backward ? 0 : 0.5;
	double force = drag * slip + par->pull * thickness * phi - at->stress + next->stress -
				   rubbing * middle * v + up * (v_above - v) + down * (v - v_below);
	double *row = s->blocks.diagonal[a][IMMERSED_V];

	s->right[a * IMMERSED_UNKNOWNS + IMMERSED_V] += factor * force;
	row[IMMERSED_PHI] -= factor * (drag_phi * slip + par->pull * thickness -
									  at->stress_phi * share + next->stress_phi * share_next) -
						 factor * force / phi;
	row[IMMERSED_V] -=
		factor * (-drag - at->stress_shear * at->slope - next->stress_shear * next->slope -
					 rubbing_v * middle - up + down);
	row[IMMERSED_U] -= factor * drag;
	row[IMMERSED_P] -= factor * (-at->stress_p - 0.5 * rubbing * v) * unit_p;
	if (a > 0) {
		row = s->blocks.below[a][IMMERSED_V];
		row[IMMERSED_PHI] -= factor * -at->stress_phi * (1 - share);
		row[IMMERSED_V] -= factor * (at->stress_shear * at->slope - down);
	}
	if (a + 1 < n) {
		row = s->blocks.above[a][IMMERSED_V];
		row[IMMERSED_PHI] -= factor * next->stress_phi * (1 - share_next);
		row[IMMERSED_V] -= factor * (next->stress_shear * next->slope + up);
		row[IMMERSED_P] -= factor * (next->stress_p - 0.5 * rubbing * v) * unit_p;
	}
}

static void add_fluid(struct model_state *s, const struct immersed_column *x, double h, double w,
	int a, const struct transfer *t)
{
	const struct immersed_parameters *par = &s->par;
	int n = s->layers;
	double phi = x->phi[a], thickness = s->l[a] * h;
	double factor = w / (par->rho_f * thickness * (1 - phi));
	double u = x->u[a], slip = u - x->v[a];
	double drag = par->drag * phi * phi / (1 - phi) * thickness;
	double drag_phi = par->drag * phi * (2 - phi) / ((1 - phi) * (1 - phi)) * thickness;
	/* no friction with the bottom (k_b = 0) nor with the fluid above (k_i = 0) */
	double viscous_below = a ? par->eta / immersed_spacing(s, h, a) : 0;
	double viscous_above = a + 1 < n ? par->eta / immersed_spacing(s, h, a + 1) : 0;
	double up = 0.5 * par->rho_f * t->fluid_above, down = 0.5 * par->rho_f * t->fluid_below;
	double to_below = u - (a ? x->u[a - 1] : u), to_above = (a + 1 < n ? x->u[a + 1] : 0) - u;
	double force = -drag * slip - viscous_below * to_below + viscous_above * to_above +
				   up * to_above + down * to_below;
	double *row = s->blocks.diagonal[a][IMMERSED_U];

	s->right[a * IMMERSED_UNKNOWNS + IMMERSED_U] += factor * force;
	row[IMMERSED_PHI] -= factor * -drag_phi * slip + factor * force / (1 - phi);
	row[IMMERSED_V] -= factor * drag;
	row[IMMERSED_U] -= factor * (-drag - viscous_below - viscous_above - up + down);
	if (a > 0)
		s->blocks.below[a][IMMERSED_U][IMMERSED_U] -= factor * (viscous_below - down);
	if (a + 1 < n)
		s->blocks.above[a][IMMERSED_U][IMMERSED_U] -= factor * (viscous_above + up);
}

static void add_dilatation(struct model_state *s, const struct immersed_column *x, double h,
	double w, int a, const struct immersed_interface *at, double unit_p, double unit_S)
{
	const struct immersed_parameters *par = &s->par;
	double phi = x->phi[a], thickness = s->l[a] * h, voids = 1 - phi;
	double A = thickness * immersed_seepage(par, phi), A_phi = A * (1 / phi + 3 / voids);
	double below = a ? x->S[a - 1] : 0, above = a + 1 < s->layers ? x->p[a + 1] : 0;
	double through = below + 0.5 * at->X, by_v = at->X_shear * at->slope;
	double *right = s->right + (size_t)a * IMMERSED_UNKNOWNS;
	block *d = &s->blocks.diagonal[a], *lower = &s->blocks.below[a];

	right[IMMERSED_PHI] -= w * at->X / thickness;
	(*d)[IMMERSED_PHI][IMMERSED_PHI] += w * at->X_phi / thickness;
	(*d)[IMMERSED_PHI][IMMERSED_V] += w * by_v / thickness;
	(*d)[IMMERSED_PHI][IMMERSED_P] += w * at->X_p / thickness * unit_p;

	right[IMMERSED_P] = -(x->p[a] - above - par->weight * thickness * phi - A * through) / unit_p;
	(*d)[IMMERSED_P][IMMERSED_PHI] =
		-(par->weight * thickness + A_phi * through + 0.5 * A * at->X_phi) / unit_p;
	(*d)[IMMERSED_P][IMMERSED_V] = -0.5 * A * by_v / unit_p;
	(*d)[IMMERSED_P][IMMERSED_P] = 1 - 0.5 * A * at->X_p;

	right[IMMERSED_S] = -(x->S[a] - below - at->X) / unit_S;
	(*d)[IMMERSED_S][IMMERSED_PHI] = -at->X_phi / unit_S;
	(*d)[IMMERSED_S][IMMERSED_V] = -by_v / unit_S;
	(*d)[IMMERSED_S][IMMERSED_P] = -at->X_p * unit_p / unit_S;
	(*d)[IMMERSED_S][IMMERSED_S] = 1;
	if (a > 0) {
		(*lower)[IMMERSED_PHI][IMMERSED_V] -= w * by_v / thickness;
		(*lower)[IMMERSED_P][IMMERSED_V] = 0.5 * A * by_v / unit_p;
		(*lower)[IMMERSED_P][IMMERSED_S] = -A * unit_S / unit_p;
		(*lower)[IMMERSED_S][IMMERSED_V] = by_v / unit_S;
		(*lower)[IMMERSED_S][IMMERSED_S] = -1;
	}
	if (a + 1 < s->layers)
		s->blocks.above[a][IMMERSED_P][IMMERSED_P] = -1;
}

void immersed_assemble(struct model_state *s, const struct immersed_column *x,
	const struct immersed_column *known, double w)
{
	int n = s->layers;
	double h = immersed_height(s, x->phi), grains = 0, share = 0, surface, unit_p, unit_S;
	struct immersed_interface at, next = {0};

	immersed_units(s, &unit_p, &unit_S);
	surface = s->par.keeps_mass ? x->S[n - 1] * h / s->mass : 0;
	memset(s->blocks.below, 0, (size_t)n * sizeof *s->blocks.below);
	memset(s->blocks.diagonal, 0, (size_t)n * sizeof *s->blocks.diagonal);
	memset(s->blocks.above, 0, (size_t)n * sizeof *s->blocks.above);
	immersed_interface(s, x, h, 0, &next);
	for (int a = 0; a < n; a++) {
		struct transfer t = transfer_of(s, x, surface, share, grains, a);
		double *right = s->right + (size_t)a * IMMERSED_UNKNOWNS;

		at = next;
		next = (struct immersed_interface){0};
		if (a + 1 < n)
			immersed_interface(s, x, h, a + 1, &next);
		right[IMMERSED_PHI] = -(x->phi[a] - known->phi[a]);
		right[IMMERSED_V] = -(x->v[a] - known->v[a]);
		right[IMMERSED_U] = -(x->u[a] - known->u[a]);
		for (int i = 0; i <= IMMERSED_U; i++)
			s->blocks.diagonal[a][i][i] = 1;
		add_grains(s, x, h, w, a, &at, &next, &t, unit_p);
		add_fluid(s, x, h, w, a, &t);
		add_dilatation(s, x, h, w, a, &at, unit_p, unit_S);
		share += s->l[a];
		grains += s->l[a] * x->phi[a];
	}
}
