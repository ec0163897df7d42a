/* Step 2: friction between the layers and at the bottom (P1 23-25), one tridiagonal system over the
 * layers per cell, with the coefficients frozen at t^n. Columns side by side are solved together, so
 * that the loops run along x. */
#include <math.h>
#include <string.h>

#include "dry/dry.h"

/* The thickness that carries the friction, P1 (25) as it reproduces P1 Table 6: smoothed where the
 * surface is below the angle of repose, and doubled there while the column is at rest. */
static void friction_thickness(const struct model_state *s, double *hs)
{
	const double *h = s->h, *b = s->b, *bottom = s->u;
	const double *top = s->u + (size_t)(s->layers - 1) * s->grid.stride;
	double limit = 2 * s->grid.dx * s->par.mu_s * (1 + 1e-9);
	double rest = 100 * s->par.delta_velocity, plane = -2 * s->par.tan_slope * s->grid.dx;

	for (int i = 1; i <= s->grid.cells; i++) {
		/* the plane is mirrored at a wall */
		double half =
			(i == 1 && s->grid.left_wall) || (i == s->grid.cells && s->grid.right_wall) ? 0.5 : 1;
		double jump = h[i + 1] + b[i + 1] - h[i - 1] - b[i - 1] + half * plane;
		double smooth = 0.5 * h[i] + 0.25 * (h[i - 1] + h[i + 1]);
		bool below = fabs(jump) <= limit;
		bool at_rest = fabs(bottom[i]) < rest && fabs(top[i]) < rest;

		hs[i] = below ? (at_rest ? 2 * smooth : smooth) : h[i];
	}
}

/* Coefficient at the interface below layer a: tau/rho per velocity difference, P1 (10), (11), m/s. */
static void interface_coefficient(const struct model_state *s, int a, const double *hs, double *k)
{
	const struct dry_parameters *par = &s->par;
	const double *u = s->u + (size_t)a * s->grid.stride, *down = u - s->grid.stride;
	const double *q = s->q + (size_t)a * (size_t)s->grid.faces;
	double n = s->layers, share = par->gc * (n - a) / n;

	for (int i = 1; i <= s->grid.cells; i++) {
		double h = s->h[i] > DRY_ONE_LAYER ? s->h[i] : DRY_ONE_LAYER;
		double p = share * hs[i] + 0.5 * (q[i - 1] + q[i]);

		p = p > 0 ? p : 0;
		if (a == 0) {
			/* the shear at the bottom is taken over the whole lowest layer */
			double slip = fabs(u[i]);

			k[i] = dry_mu(par, slip * n / h, p) * p /
				   sqrt(slip * slip + par->delta_velocity * par->delta_velocity);
		} else {
			double shear = fabs(u[i] - down[i]) * n / h;

			k[i] = dry_mu(par, shear, p) * p * n /
				   (2 * h * sqrt(0.25 * shear * shear + par->delta_strain * par->delta_strain));
		}
	}
}

/* Below DRY_ONE_LAYER a column slides as one, held by Coulomb friction (P1 Remark 2). */
static void slide_as_one(struct model_state *s, int i, double dt)
{
	const struct dry_parameters *par = &s->par;
	size_t stride = s->grid.stride;
	double sum = 0, h = s->h[i], ubar, speed;

	for (int a = 0; a < s->layers; a++)
		sum += s->U[(size_t)a * stride + (size_t)i];
	sum /= s->layers;
	ubar = h > DRY_NO_MOMENTUM ? sum / h : 0;
	speed = sqrt(ubar * ubar + par->delta_velocity * par->delta_velocity);
	sum /= 1 + dt * par->mu_s * par->gc / speed;
	for (int a = 0; a < s->layers; a++)
		s->U[(size_t)a * stride + (size_t)i] = h > DRY_NO_MOMENTUM ? sum : 0;
}

/* P1 (24) by the Thomas algorithm: h u_a - dt N [k_up (u_{a+1} - u_a) - k_down (u_a - u_{a-1})] = U_a.
 * `ratio` [layers][stride] holds the eliminated upper diagonal; U turns into u on the way up and back
 * into h u on the way down. */
void dry_friction(struct model_state *s, double dt)
{
	double *hs = s->cell[0], *down = s->cell[1], *up = s->cell[2], *ratio = s->work;
	size_t stride = s->grid.stride;
	double scale = dt * s->layers;
	int cells = s->grid.cells, last = s->layers - 1;

	for (int i = 1; i <= cells; i++)
		if (s->h[i] < DRY_ONE_LAYER)
			slide_as_one(s, i, dt);
	friction_thickness(s, hs);
	interface_coefficient(s, 0, hs, down);
	for (int a = 0; a <= last; a++) {
		double *U = s->U + (size_t)a * stride, *r = ratio + (size_t)a * stride;

		if (a < last)
			interface_coefficient(s, a + 1, hs, up);
		else
			memset(up, 0, stride * sizeof *up);
		for (int i = 1; i <= cells; i++) {
			double before = a > 0 ? (r - stride)[i] : 0, below = a > 0 ? (U - stride)[i] : 0;
			bool thin = s->h[i] < DRY_ONE_LAYER;
			double kd = thin ? 0 : scale * down[i], ku = thin ? 0 : scale * up[i];
			double pivot = 1 / ((s->h[i] + 1e-300) + ku + kd * (1 - before));

			U[i] = (U[i] + kd * below) * pivot;
			r[i] = ku * pivot;
		}
		memcpy(down, up, stride * sizeof *down);
	}
	for (int a = last; a >= 0; a--) {
		double *U = s->U + (size_t)a * stride, *r = ratio + (size_t)a * stride;

		if (a < last)
			for (int i = 1; i <= cells; i++)
				U[i] += r[i] * (U + stride)[i];
		if (a < last)
			for (int i = 1; i <= cells; i++)
				(U + stride)[i] *= s->h[i];
	}
	for (int i = 1; i <= cells; i++)
		s->U[i] *= s->h[i];
}
