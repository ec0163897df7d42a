/* The steady uniform flow over a bottom that holds the grains (P3 52), which numbers are held against. At the depth s below the surface p/rho = gc s, and with the side walls of P1 (36)
 *   mu(I) p + int_0^s walls p = tan(theta) p,  so that  mu(I) = tan(theta) - walls s/2:
 * without walls I is constant; with them it falls with depth, and where it would become negative the
 * grains do not move. The strain rate is I sqrt(gc s)/inertia. */
#include <gsl/gsl_integration.h>
#include <math.h>

#include "dry/dry.h"

enum { POINTS = 16 }; /* of the quadrature between two heights */

/* Inertial number at which mu(I) is `mu`; NaN where there is none. */
static double inertia_of(const struct dry_parameters *par, double mu)
{
	if (mu <= par->mu_s)
		return 0;
	return mu < par->mu_2 ? par->i_0 * (mu - par->mu_s) / (par->mu_2 - mu) : NAN;
}

/* Of grains in motion; less than mu_s where they are at rest. */
static double mu_at(const struct dry_parameters *par, double depth)
{
	return par->tan_slope - 0.5 * par->walls * depth;
}

static double strain_rate(const struct dry_parameters *par, double depth)
{
	return inertia_of(par, mu_at(par, depth)) * sqrt(par->gc * depth) / par->inertia;
}

/* Below this depth the grains are at rest, m. */
static double moving_depth(const struct dry_parameters *par)
{
	double excess = par->tan_slope - par->mu_s;

	return excess <= 0 ? 0 : par->walls > 0 ? 2 * excess / par->walls : INFINITY;
}

/* What the velocity gains from one depth up to another: by Gauss in the root of the depth, in which the
 * strain rate is smooth. */
static double gain(const struct dry_parameters *par, const gsl_integration_glfixed_table *table,
	double from, double to)
{
	double rest = moving_depth(par), low = sqrt(fmin(to, rest)), high = sqrt(fmin(from, rest));
	double sum = 0, root, weight;

	for (size_t i = 0; i < POINTS; i++) {
		(void)gsl_integration_glfixed_point(low, high, i, &root, &weight, table);
		sum += weight * 2 * root * strain_rate(par, root * root);
	}
	return sum;
}

void dry_exact(const struct model_state *s, double h, double *u, double *strain, double *mu)
{
	gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
	double below = h, speed = 0;

	for (int a = 0; a <= s->layers; a++) {
		double depth = h * (1 - s->layer_interface[a]);

		strain[a] = strain_rate(&s->par, depth);
		mu[a] = mu_at(&s->par, depth);
		mu[a] = mu[a] < s->par.mu_s ? s->par.mu_s : mu[a];
	}
	for (int a = 0; a < s->layers; a++) {
		double depth = h * (1 - s->layer_middle[a]);

		speed = table ? speed + gain(&s->par, table, below, depth) : NAN;
		u[a] = speed;
		below = depth;
	}
	if (table)
		gsl_integration_glfixed_table_free(table);
}
