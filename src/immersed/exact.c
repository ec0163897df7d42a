/* The steady uniform flow without drag, which numbers are held against (P4 3.4.2, 3.4.3). In the depth
 * z below the surface, with F the integral of phi from there, p = weight F and phi = phi_c - K_2 I:
 *   mu(I) F + (2 mu_w/W) int_0^z F = tan(theta) F.
 * Without side walls I is constant, and the rest is in closed form. With them I falls with depth, and
 * where it would become negative the grains do not move: an initial value problem, which GSL solves. At
 * the surface it is singular, so that F begins with a small value instead of 0. The bottom is without slip. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>

#include "immersed/immersed.h"

#define TOLERANCE 1e-10

/* F, I, the difference of velocity from the surface, and the integral of that. */
enum { F, INERTIA, FALL, AREA, EQUATIONS };

/* Inertial number at which mu(I) is `mu`; NaN where there is none. */
static double inertia_of(const struct immersed_parameters *par, double mu)
{
	if (mu <= par->mu_s)
		return 0;
	if (par->linear)
		return par->k_1 > 0 ? (mu - par->mu_s) / par->k_1 : NAN;
	return mu < par->mu_2 ? par->i_0 * (mu - par->mu_s) / (par->mu_2 - mu) : NAN;
}

static double mu_slope(const struct immersed_parameters *par, double inertia)
{
	double sum = par->i_0 + inertia;

	return par->linear ? par->k_1 : (par->mu_2 - par->mu_s) * par->i_0 / (sum * sum);
}

static int derivatives(double z, const double y[], double dydz[], void *context)
{
	const struct immersed_parameters *par = context;
	double inertia = fmax(y[INERTIA], 0), phi = par->phi_c - par->k_2 * inertia;

	(void)z;
	dydz[F] = phi;
	dydz[INERTIA] = y[INERTIA] > 0
						? ((par->tan_slope - immersed_mu(par, inertia)) * phi - par->wall * y[F]) /
							  (y[F] * mu_slope(par, inertia))
						: 0;
	dydz[FALL] = par->weight * y[F] * inertia / par->eta;
	dydz[AREA] = y[FALL];
	return GSL_SUCCESS;
}

static void without_walls(const struct model_state *s, double h, double *v, double *phi)
{
	const struct immersed_parameters *par = &s->par;
	double inertia = inertia_of(par, par->tan_slope), grains = par->phi_c - par->k_2 * inertia;
	double scale = par->weight * inertia * grains / (2 * par->eta), top = h;

	for (int a = 0; a < s->layers; a++) {
		double next = h * (1 - s->layer_interface[a + 1]);

		v[a] = scale * (h * h - (top * top + top * next + next * next) / 3);
		phi[a] = grains;
		top = next;
	}
}

static void fill(const struct model_state *s, double value, double *v, double *phi)
{
	for (int a = 0; a < s->layers; a++)
		v[a] = phi[a] = value;
}

/* From the surface down, layer by layer. Errors count against what each quantity reaches: where the
 * grains come to rest I vanishes with a kink, and no relative accuracy can be had. */
static void with_walls(const struct model_state *s, double h, double *v, double *phi)
{
	struct immersed_parameters par = s->par;
	double inertia = inertia_of(&par, par.tan_slope), fall = par.weight * inertia * h * h / par.eta;
	double y[EQUATIONS] = {s->steady_surface, inertia}, z = 0;
	const double scales[EQUATIONS] = {h, inertia, fall, fall * h};
	gsl_odeiv2_system system = {derivatives, NULL, EQUATIONS, &par};
	gsl_error_handler_t *handler = gsl_set_error_handler_off(); /* it would end the program */
	gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_scaled_new(
		&system, gsl_odeiv2_step_rk8pd, 1e-6 * h, TOLERANCE, TOLERANCE, 1, 0, scales);
	bool good = driver != NULL;

	for (int a = s->layers; good && a-- > 0;) {
		double above[] = {y[F], y[AREA]}, begin = z;

		good =
			gsl_odeiv2_driver_apply(driver, &z, h * (1 - s->layer_interface[a]), y) == GSL_SUCCESS;
		phi[a] = (y[F] - above[0]) / (z - begin);
		v[a] = (y[AREA] - above[1]) / (z - begin);
	}
	for (int a = 0; a < s->layers; a++)
		v[a] = y[FALL] - v[a];
	if (!good)
		fill(s, NAN, v, phi);
	if (driver)
		gsl_odeiv2_driver_free(driver);
	(void)gsl_set_error_handler(handler);
}

void immersed_exact(const struct model_state *s, double *v, double *phi)
{
	double h = immersed_height(s, s->now.phi);

	if (isnan(inertia_of(&s->par, s->par.tan_slope)))
		fill(s, NAN, v, phi);
	else if (s->par.wall > 0 && s->par.tan_slope > s->par.mu_s)
		with_walls(s, h, v, phi);
	else
		without_walls(s, h, v, phi);
}
