/* The solid pressure at the interfaces, P4 (45):
 *   p_a = p_{a+1} + weight h_a phi_a + A_a (S_{a-1} + X_a/2),   S_a = S_{a-1} + X_a,   X = B + E/p.
 * With 1/p linearised this is a linear recursion in two directions, p from the surface and S from the
 * bottom; p_a = r_a + s_a S_{a-1} turns it into one sweep down and one up, instead of the N x N system
 * that the paper solves. All terms of the sweeps are positive but B. */
#include <math.h>

#include "immersed/immersed.h"

void immersed_pressure(
	const struct model_state *s, struct immersed_column *c, double h, const double *from)
{
	const struct immersed_parameters *par = &s->par;
	double *fixed = s->work[0], *linear = s->work[1], *r = s->work[2], *t = s->work[3];
	double r_above = 0, t_above = 0, below = 0;

	for (int a = 0; a < s->layers; a++) {
		double g = fabs(c->v[a] - (a ? c->v[a - 1] : 0)) / immersed_spacing(s, h, a);
		double strain = s->l[a] * h * par->k * c->phi[a] * g, inverse = 1 / from[a];
		double rate = strain * par->k_2 * par->eta * g * inverse;

		/* X = fixed - linear p: E/p from its tangent at `from` */
		fixed[a] = strain * (c->phi[a] - par->phi_c) + 2 * rate;
		linear[a] = rate * inverse;
	}
	for (int a = s->layers; a-- > 0;) {
		double thickness = s->l[a] * h, A = thickness * immersed_seepage(par, c->phi[a]);
		double through = t_above + 0.5 * A, inverse = 1 / (1 + through * linear[a]);

		r[a] = inverse * (r_above + through * fixed[a] + par->weight * thickness * c->phi[a]);
		t[a] = inverse * (t_above + A);
		r_above = r[a];
		t_above = t[a];
	}
	for (int a = 0; a < s->layers; a++) {
		double p = r[a] + t[a] * below;

		/* a tangent that leads far down comes from too far away */
		c->p[a] = p > 0.2 * from[a] ? p : 0.2 * from[a];
		below += fixed[a] - linear[a] * c->p[a];
		c->S[a] = below;
	}
}

int immersed_pressure_exact(const struct model_state *s, struct immersed_column *c, double h)
{
	double *from = s->work[4];

	for (int count = 1; count <= 200; count++) {
		double change = 0;

		for (int a = 0; a < s->layers; a++)
			from[a] = c->p[a];
		immersed_pressure(s, c, h, from);
		for (int a = 0; a < s->layers; a++)
			change = fmax(change, fabs(c->p[a] / from[a] - 1));
		if (change < 1e-13)
			return count;
	}
	return -1;
}
