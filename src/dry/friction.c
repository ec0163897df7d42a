/* Step 2: friction between the layers and at the bottom (P1 23-25), one tridiagonal system over the
 * layers per cell, with the coefficients frozen at t^n. Columns side by side are solved together, so
 * that the loops run along x. */
#include <math.h>
#include <string.h>

#include "base/kernel.h"
#include "dry/chunk.h"
#include "dry/dry.h"

/* What the layers of a chunk share; cell k is cell `first` + k of the grid. */
struct columns {
	int cells;
	double hs[CHUNK_CELLS];   /* thickness that carries the friction, m */
	double h[CHUNK_CELLS];    /* thickness that the shear is taken over, m */
	double down[CHUNK_CELLS]; /* dt N k of the interface below the layer at hand, m */
};

/* The thickness that carries the friction, P1 (25) as it reproduces P1 Table 6: smoothed where the
 * surface is below the angle of repose, and doubled there while the column is at rest. */
KERNEL_PART void friction_thickness(
	const struct model_state *s, struct chunk chunk, struct columns *c)
{
	size_t first = (size_t)chunk.first;
	const double *restrict h = s->h + first, *restrict b = s->b + first;
	const double *restrict bottom = s->u + first;
	const double *restrict top = s->u + (size_t)(s->layers - 1) * s->grid.stride + first;
	double limit = s->par.plain_thickness ? -1 : 2 * s->grid.dx * s->par.mu_s * (1 + 1e-9);
	double rest = 100 * s->par.delta_velocity, plane[CHUNK_CELLS] = {0};

	for (int k = 0; k < c->cells; k++)
		plane[k] = -2 * s->par.tan_slope * s->grid.dx;
	if (chunk.first == 1 && s->grid.left_wall) /* the plane is mirrored at a wall */
		plane[0] *= 0.5;
	if (chunk.last == s->grid.cells && s->grid.right_wall)
		plane[c->cells - 1] = -s->par.tan_slope * s->grid.dx;
	for (int k = 0; k < c->cells; k++) {
		double jump = h[k + 1] + b[k + 1] - h[k - 1] - b[k - 1] + plane[k];
		double smooth = 0.5 * h[k] + 0.25 * (h[k - 1] + h[k + 1]);
		double speed = fabs(bottom[k]) > fabs(top[k]) ? fabs(bottom[k]) : fabs(top[k]);
		double carries = speed < rest ? 2 * smooth : smooth;

		c->hs[k] = fabs(jump) <= limit ? carries : h[k]; /* never, where the limit is below 0 */
		c->h[k] = h[k] > DRY_ONE_LAYER ? h[k] : DRY_ONE_LAYER;
	}
}

/* tau/rho per velocity difference at the bottom, P1 (11), m/s. The shear there is taken over the whole
 * lowest layer. */
KERNEL_PART double bottom_coefficient(
	const struct dry_parameters *par, double n, double h, double u, double p)
{
	double slip = fabs(u);

	return dry_mu(par, slip * n / h, p) * p /
		   __builtin_sqrt(slip * slip + par->delta_velocity * par->delta_velocity);
}

/* The same between two layers, P1 (10). */
KERNEL_PART double inner_coefficient(
	const struct dry_parameters *par, double n, double h, double jump, double p)
{
	double shear = fabs(jump) * n / h;

	return dry_mu(par, shear, p) * p * n /
		   (2 * h * __builtin_sqrt(0.25 * shear * shear + par->delta_strain * par->delta_strain));
}

/* Below DRY_ONE_LAYER a column slides as one, held by Coulomb friction (P1 Remark 2). */
KERNEL_PART void slide_as_one(
	const struct model_state *s, struct chunk chunk, const double *restrict h, int cells, double dt)
{
	const struct dry_parameters *par = &s->par;
	double sum[CHUNK_CELLS] = {0}, delta = par->delta_velocity;
	double *restrict U = s->U + chunk.first;

	for (int a = 0; a < s->layers; a++, U += s->grid.stride)
		for (int k = 0; k < cells; k++)
			sum[k] += U[k];
	for (int k = 0; k < cells; k++) {
		double U_mean = sum[k] / s->layers, u = h[k] > DRY_NO_MOMENTUM ? U_mean / h[k] : 0;
		double speed = __builtin_sqrt(u * u + delta * delta);

		sum[k] = h[k] > DRY_NO_MOMENTUM ? U_mean / (1 + dt * par->mu_s * par->gc / speed) : 0;
	}
	U = s->U + chunk.first;
	for (int a = 0; a < s->layers; a++, U += s->grid.stride)
		for (int k = 0; k < cells; k++)
			U[k] = h[k] < DRY_ONE_LAYER ? sum[k] : U[k];
}

/* The interface below layer 1, where the elimination begins. */
KERNEL_PART void begin(
	const struct model_state *s, struct chunk chunk, struct columns *c, double dt)
{
	const struct dry_parameters par = s->par;
	const double *restrict h = s->h + chunk.first, *restrict u = s->u + chunk.first;
	const double *restrict q = s->q + chunk.first - 1;
	double n = s->layers, share = par.gc;

	for (int k = 0; k < c->cells; k++) {
		double p = share * c->hs[k] + 0.5 * (q[k] + q[k + 1]);
		double bottom = bottom_coefficient(&par, n, c->h[k], u[k], p > 0 ? p : 0);

		c->down[k] = h[k] < DRY_ONE_LAYER ? 0 : dt * n * bottom;
	}
}

/* One layer on the way up: U becomes the eliminated right side and `ratio` the upper diagonal. `before`
 * and `below` are those of the layer below, `u_up` and `q_up` of the one above. */
KERNEL_PART void eliminate(const struct dry_parameters *par_, struct columns *c, double n,
	double share, double dt, bool top, const double *restrict h, const double *restrict u,
	const double *restrict u_up, const double *restrict q_up, const double *restrict before,
	const double *restrict below, double *restrict U, double *restrict ratio)
{
	const struct dry_parameters par = *par_;

	for (int k = 0; k < c->cells; k++) {
		double kd = c->down[k], ku = 0, pivot;

		if (!top) {
			double p = share * c->hs[k] + 0.5 * (q_up[k] + q_up[k + 1]);
			double inner = inner_coefficient(&par, n, c->h[k], u_up[k] - u[k], p > 0 ? p : 0);

			ku = h[k] < DRY_ONE_LAYER ? 0 : dt * n * inner;
		}
		pivot = 1 / ((h[k] + 1e-300) + ku + kd * (1 - before[k]));
		U[k] = (U[k] + kd * below[k]) * pivot;
		ratio[k] = ku * pivot;
		c->down[k] = ku;
	}
}

/* One layer on the way down: its velocity, with which the discharge of the layer above is done. */
KERNEL_PART void substitute(int cells, const double *restrict h, const double *restrict ratio,
	double *restrict U, double *restrict U_up)
{
	for (int k = 0; k < cells; k++) {
		U[k] += ratio[k] * U_up[k];
		U_up[k] *= h[k];
	}
}

/* P1 (24) by the Thomas algorithm: h u_a - dt N [k_up (u_{a+1} - u_a) - k_down (u_a - u_{a-1})] = U_a.
 * U turns into u on the way up and back into h u on the way down. */
KERNEL static void friction(struct model_state *s, struct chunk chunk, double dt)
{
	static const double zeros[CHUNK_CELLS];
	struct columns c = {.cells = chunk.last - chunk.first + 1};
	size_t first = (size_t)chunk.first, stride = s->grid.stride, faces = (size_t)s->grid.faces;
	const double *h = s->h + first;
	int last = s->layers - 1, thin = 0;
	double n = s->layers;

	for (int k = 0; k < c.cells; k++)
		thin |= h[k] < DRY_ONE_LAYER;
	if (thin)
		slide_as_one(s, chunk, h, c.cells, dt);
	friction_thickness(s, chunk, &c);
	begin(s, chunk, &c, dt);
	for (int a = 0; a <= last; a++) {
		size_t row = (size_t)a * stride + first;
		double *U = s->U + row, *ratio = s->work + row;
		const double *u = s->u + row, *below = a > 0 ? U - stride : zeros;
		const double *before = a > 0 ? ratio - stride : zeros;
		const double *q_up = s->q + ((size_t)a + 1) * faces + first - 1;

		if (a < last)
			eliminate(&s->par, &c, n, s->par.gc * (n - a - 1) / n, dt, false, h, u, u + stride,
				q_up, before, below, U, ratio);
		else
			eliminate(&s->par, &c, n, 0, dt, true, h, u, u, q_up, before, below, U, ratio);
	}
	for (int a = last - 1; a >= 0; a--) {
		size_t row = (size_t)a * stride + first;

		substitute(c.cells, h, s->work + row, s->U + row, s->U + row + stride);
	}
	for (int k = 0; k < c.cells; k++)
		s->U[first + (size_t)k] *= h[k];
}

void dry_friction(struct model_state *s, double dt)
{
	chunk_each(s, friction, dt);
}

/* One interface of P1 Theorem 1: that below layer `a`, W/m2. */
static double lost_below(
	const struct model_state *s, const struct columns *c, int k, size_t i, int a)
{
	const double *u = s->u + (size_t)a * s->grid.stride + i;
	const double *q = s->q + (size_t)a * (size_t)s->grid.faces + i;
	double n = s->layers, p = s->par.gc * (n - a) / n * c->hs[k] + 0.5 * (q[-1] + q[0]);
	double jump = a ? u[0] - u[-(ptrdiff_t)s->grid.stride] : u[0];

	p = p > 0 ? p : 0;
	return s->par.rho * jump * jump *
		   (a ? inner_coefficient(&s->par, n, c->h[k], jump, p)
			  : bottom_coefficient(&s->par, n, c->h[k], jump, p));
}

void dry_dissipation(const struct model_state *s, bool between_layers, double *values)
{
	int first = between_layers ? 1 : 0, last = between_layers ? s->layers - 1 : 0;

	for (int begins = 1; begins <= s->grid.cells; begins += CHUNK_CELLS) {
		int ends = begins + CHUNK_CELLS - 1;
		struct chunk chunk = {begins, ends < s->grid.cells ? ends : s->grid.cells};
		struct columns c = {.cells = chunk.last - chunk.first + 1};

		friction_thickness(s, chunk, &c);
		for (int k = 0; k < c.cells; k++) {
			size_t i = (size_t)(begins + k);

			values[i - 1] = 0;
			for (int a = first; a <= last && s->h[i] >= DRY_ONE_LAYER; a++)
				values[i - 1] += lost_below(s, &c, k, i, a);
		}
	}
}
