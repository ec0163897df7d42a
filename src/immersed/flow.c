/* The laws of P4 2.2 at the interfaces: shear, dilatation of the layer above, and solid stress. */
#include <math.h>

#include "immersed/immersed.h"

/* mu p and its derivatives by |V| and p. The products with p stay finite where p vanishes. */
static void friction(const struct immersed_parameters *par, double g, double p, double *value,
	double *by_g, double *by_p)
{
	double rate = par->eta * g, rise = par->mu_2 - par->mu_s;
	double sum = par->i_0 * p + rate;

	if (par->linear) {
		*value = par->mu_s * p + par->k_1 * rate;
		*by_g = par->k_1 * par->eta;
		*by_p = par->mu_s;
		return;
	}
	*value = par->mu_s * p + rise * rate * p / sum;
	*by_g = rise * par->eta * p * (par->i_0 * p) / (sum * sum);
	*by_p = par->mu_s + rise * (rate / sum) * (rate / sum);
}

/* Phi = |V| K (phi - phi_c + K_2 I), P4 (45b); tau = (mu + K (phi - phi_c + K_2 I)) p V/sqrt(V^2 + 4
 * delta^2), P4 (8), (20), with the pressure of the interface at the bottom too: as printed, (31i)
 * locks the lowest layer. */
void immersed_interface(const struct model_state *s, const struct immersed_column *c, double h,
	int a, struct immersed_interface *out)
{
	const struct immersed_parameters *par = &s->par;
	double slope = 1 / immersed_spacing(s, h, a);
	double V = slope * (c->v[a] - (a ? c->v[a - 1] : 0)), g = fabs(V), sign = V < 0 ? -1 : 1;
	double phi = c->phi[a], p = c->p[a], thickness = s->l[a] * h;
	double between = a && !par->backward ? 0.5 * (phi + c->phi[a - 1]) : phi;
	double inertia = par->k_2 * par->eta * g / p, excess = phi - par->phi_c + inertia;
	double square = V * V + 4 * par->delta_strain * par->delta_strain, root = sqrt(square);
	double part = V / root, mu_p, mu_g, mu_by_p;

	out->shear = V;
	out->slope = slope;
	out->X = thickness * par->k * g * phi * excess;
	out->X_phi = thickness * par->k * g * (phi + excess);
	out->X_shear = thickness * par->k * phi * (excess + inertia) * sign;
	out->X_p = -thickness * par->k * phi * g * inertia / p;

	friction(par, g, p, &mu_p, &mu_g, &mu_by_p);
	mu_p += par->k * ((between - par->phi_c) * p + par->k_2 * par->eta * g);
	mu_g += par->k * par->k_2 * par->eta;
	mu_by_p += par->k * (between - par->phi_c);
	out->stress = mu_p * part;
	out->stress_phi = par->k * p * part;
	out->stress_p = mu_by_p * part;
	out->stress_shear =
		mu_g * sign * part + mu_p * 4 * par->delta_strain * par->delta_strain / (square * root);
}

double immersed_height(const struct model_state *s, const double *phi)
{
	double sum = 0;

	if (!s->par.keeps_mass)
		return s->depth;
	for (int a = 0; a < s->layers; a++)
		sum += s->l[a] * phi[a];
	return s->mass / sum;
}
