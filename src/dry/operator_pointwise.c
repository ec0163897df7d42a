/* The pressure operator of P1 Appendix A: the constraint 2 h N N_a = 0 (P1 27-28) at the faces, with the
 * momentum equations (9b), (9c) put into it as formulas and then discretised point by point. The
 * printed coefficients are -2 times the Jacobian; here it is the Jacobian itself, right side -C/dt,
 * with the misprints corrected (the derivation gives, for q below layer a, at its own interface
 *   -h^2 q'' - h h' q' + [4 N^2 + 2 (xi_a^2 + xi_{a-1}^2) - h (xi'_a - xi'_{a-1})] q,
 * at the interface below
 *   -h^2/2 q'' - (2 h xi_{a-1} + h h'/2) q' - [2 N^2 + 2 xi_{a-1}^2 + h xi'_{a-1}] q,
 * at the interface above
 *   -h^2/2 q'' + (2 h xi_a - h h'/2) q' - [2 N^2 + 2 xi_a^2 - h xi'_a] q,
 * and below layer 1 only the terms of layer 1). Terms in N^2 are averaged (1, 2, 1)/4 along x, since
 * w lives in the cells. Kept for the paper's tables; NaN where dt is very small. */
#include <math.h>

#include "dry/dry.h"

/* A second-order operator c2 q'' + c1 q' + c0 q + average(n2 q) as three coefficients. */
struct stencil {
	double lower, diagonal, upper;
};

static struct stencil stencil_make(double c2, double c1, double c0, double n2, double dx)
{
	return (struct stencil){
		c2 / (dx * dx) - 0.5 * c1 / dx + 0.25 * n2,
		-2 * c2 / (dx * dx) + c0 + 0.5 * n2,
		c2 / (dx * dx) + 0.5 * c1 / dx + 0.25 * n2,
	};
}

static double minmod(double a, double b, double c)
{
	if (a > 0 && b > 0 && c > 0)
		return fmin(a, fmin(b, c));
	if (a < 0 && b < 0 && c < 0)
		return fmax(a, fmax(b, c));
	return 0;
}

static double positive(double x)
{
	return x > 0 ? x : 0;
}

/* Slopes of the thickness and, by hydrostatic reconstruction, of the bed at every face. */
static void face_slopes(const struct pressure_input *in, double *dh, double *db)
{
	const double *h = in->h, *b = in->b;

	for (int f = 0; f < in->grid->faces; f++) {
		double step = b[f + 1] - b[f], jump = h[f + 1] - h[f];
		double left = positive(h[f] - positive(step)), right = positive(h[f + 1] - positive(-step));

		dh[f] = jump / in->grid->dx;
		db[f] = (right - left - jump) / in->grid->dx;
	}
}

/* xi_a = N d_x Z_a, layer a = 0.. from the bottom, at every face, and its limited slope at the inner
 * ones. */
static void layer_rows(const struct pressure_input *in, int a, const double *dh, const double *db,
	double *xi, double *dxi)
{
	double n = in->layers, scale = 1 / in->grid->dx;

	for (int f = 0; f < in->grid->faces; f++)
		xi[f] = (a + 0.5) * dh[f] + n * db[f];
	for (int f = 1; f < in->grid->faces - 1; f++) {
		double right = xi[f + 1] - xi[f], left = xi[f] - xi[f - 1];

		dxi[f] = scale * minmod(right, left, 0.5 * (right + left));
	}
}

static void put(const struct stencil *from, double *lower, double *diagonal, double *upper)
{
	*lower = from->lower;
	*diagonal = from->diagonal;
	*upper = from->upper;
}

/* A row that only couples along x: q~ = 0 (`towards` 0), or equal to the next face inside (P1 37). */
static void simple_row(struct pressure_system *system, size_t k, int towards)
{
	const struct stencil zero = {0, 0, 0};

	put(&zero, &system->below_lower[k], &system->below_diagonal[k], &system->below_upper[k]);
	put(&zero, &system->above_lower[k], &system->above_diagonal[k], &system->above_upper[k]);
	system->lower[k] = towards < 0 ? -1 : 0;
	system->diagonal[k] = 1;
	system->upper[k] = towards > 0 ? -1 : 0;
	system->rhs[k] = 0;
}

/* The terms of layer a in the constraint (P1 28) for the velocities of the cells, w with `w_sign`. */
static double constraint(const struct pressure_input *in, int a, int f, double xi, double w_sign)
{
	const double *u = in->u + (size_t)a * in->grid->stride + f;
	const double *w = in->w + (size_t)a * in->grid->stride + f, *h = in->h + f;
	double ui = h[0] * u[0], uj = h[1] * u[1];

	return w_sign * (in->layers * (h[0] * w[0] + h[1] * w[1]) - xi * (ui + uj)) +
		   0.5 * (h[0] + h[1]) * (uj - ui) / in->grid->dx;
}

/* Rows of the inner faces of layer a: layer a on its lower and upper interface, and layer a - 1 (its
 * rows are `y`, `dy`) on its own. */
static void inner_rows(const struct pressure_input *in, struct pressure_system *system, int a,
	const double *dh, const double *x, const double *dxi, const double *y, const double *dy)
{
	double dx = in->grid->dx, n2 = (double)in->layers * in->layers;

	for (int f = 2; f < in->grid->faces - 2; f++) {
		size_t k = pressure_system_row(system, a) + (size_t)f;
		double h = 0.5 * (in->h[f] + in->h[f + 1]), c2 = -0.5 * h * h, c1 = -0.5 * h * dh[f];
		double c0 = 2 * x[f] * x[f], rhs = constraint(in, a, f, x[f], 1);
		struct stencil own = stencil_make(c2, c1, c0 - h * dxi[f], 2 * n2, dx);

		if (a > 0) {
			double d0 = 2 * y[f] * y[f];
			struct stencil upper = stencil_make(c2, c1, d0 + h * dy[f], 2 * n2, dx);
			struct stencil below =
				stencil_make(c2, c1 - 2 * h * y[f], -d0 - h * dy[f], -2 * n2, dx);

			own.lower += upper.lower;
			own.diagonal += upper.diagonal;
			own.upper += upper.upper;
			rhs += constraint(in, a - 1, f, y[f], -1);
			put(&below, &system->below_lower[k], &system->below_diagonal[k],
				&system->below_upper[k]);
		}
		put(&own, &system->lower[k], &system->diagonal[k], &system->upper[k]);
		if (a + 1 < in->layers) {
			struct stencil above =
				stencil_make(c2, c1 + 2 * h * x[f], -c0 + h * dxi[f], -2 * n2, dx);

			put(&above, &system->above_lower[k], &system->above_diagonal[k],
				&system->above_upper[k]);
		}
		system->rhs[k] = -rhs / in->dt;
	}
}

static void assemble(const struct pressure_input *in, struct pressure_system *system)
{
	int last = in->grid->faces - 1;
	double *dh = in->rows[0], *db = in->rows[1];

	face_slopes(in, dh, db);
	for (int a = 0; a < in->layers; a++) {
		double *xi = in->rows[2 + a % 2], *dxi = in->rows[4 + a % 2];

		layer_rows(in, a, dh, db, xi, dxi);
		inner_rows(in, system, a, dh, xi, dxi, in->rows[3 - a % 2], in->rows[5 - a % 2]);
		for (int f = 0; f <= last; f++) {
			size_t k = pressure_system_row(system, a) + (size_t)f;

			if (in->dry[f])
				simple_row(system, k, 0);
			else if (f <= 1)
				simple_row(system, k, f < last ? 1 : 0);
			else if (f >= last - 1)
				simple_row(system, k, -1);
		}
	}
}

const struct pressure_operator operator_pointwise = {.name = "pointwise", .assemble = assemble};
