/* The projection with the constraint as the discrete adjoint of the pressure force: the matrix
 * A = sum over the cells and layers of N l_a T^T T / h, right side -(1/dt) sum of N l_a T^T u, is
 * symmetric and positive definite, and the step takes out of the kinetic energy exactly what the pressure works.
 *
 * In cell i and layer a the force (P1 9b, 9c) on the four pressures around it, left and right below
 * (l, r) and above (L, R), with q a mean and d_x q a difference of two faces:
 *   N l_a T^u = (p - s) q_l + (-p - s) q_r + (p + s) q_L + (-p + s) q_R,  p = N l_a h/(2 dx), s = N d_x Z_a/2
 *   N l_a T^w = N/2 (q_l + q_r - q_L - q_R), with d_x Z_a of the middle of the layer, central. */
#include <string.h>

#include "base/kernel.h"
#include "dry/dry.h"

/* The bands that one layer of cells fills: of its lower interface and of the one above (NULL-like rows
 * of the top interface do not exist, since q = 0 at the surface). */
struct bands {
	double *restrict diagonal, *restrict lower, *restrict upper;
	double *restrict above_lower, *restrict above_diagonal, *restrict above_upper;
};

static struct bands bands_of(const struct pressure_system *system, int a)
{
	size_t row = pressure_system_row(system, a);

	return (struct bands){system->diagonal + row, system->lower + row, system->upper + row,
		system->above_lower + row, system->above_diagonal + row, system->above_upper + row};
}

static void add_layer(const struct pressure_input *in, struct pressure_system *system, int a)
{
	const struct grid *grid = in->grid;
	const double *h = in->h, *b = in->b;
	double n = in->layers, half = 0.5 * n, dx = grid->dx;
	double share = system->cells.share[a], thin = system->cells.thin[a];
	double middle = system->cells.place[a] + 0.5; /* in mean layers */
	bool top = a == in->layers - 1;
	struct bands low = bands_of(system, a), high = bands_of(system, top ? a : a + 1);

	for (int i = 1; i <= grid->cells; i++) {
		int l = i - 1, r = i;
		double wet_l = in->dry[l] ? 0 : 1, wet_r = in->dry[r] ? 0 : 1, wet_lr = wet_l * wet_r;
		double inverse = h[i] > DRY_NO_MOMENTUM ? thin * (1 / h[i]) : 0;
		double p = share * (0.5 * h[i] / dx);
		double s = 0.25 * (middle * (h[i + 1] - h[i - 1]) + n * (b[i + 1] - b[i - 1])) / dx;
		double cl = p - s, cr = -p - s, cL = p + s, cR = -p + s, nn = half * half;

		low.diagonal[l] += wet_l * (cl * cl + nn) * inverse;
		low.diagonal[r] += wet_r * (cr * cr + nn) * inverse;
		low.upper[l] += wet_lr * (cl * cr + nn) * inverse;
		if (top)
			continue;
		high.diagonal[l] += wet_l * (cL * cL + nn) * inverse;
		high.diagonal[r] += wet_r * (cR * cR + nn) * inverse;
		high.upper[l] += wet_lr * (cL * cR + nn) * inverse;
		low.above_diagonal[l] += wet_l * (cl * cL - nn) * inverse;
		low.above_diagonal[r] += wet_r * (cr * cR - nn) * inverse;
		low.above_upper[l] += wet_lr * (cl * cR - nn) * inverse;
		low.above_lower[r] += wet_lr * (cr * cL - nn) * inverse;
	}
}

/* The other half of the bands, from symmetry; and q~ = 0 on dry faces. */
static void complete_layer(const struct pressure_input *in, struct pressure_system *system, int a)
{
	int faces = in->grid->faces;
	struct bands own = bands_of(system, a);
	size_t row = pressure_system_row(system, a);

	for (int f = 0; f < faces; f++)
		if (in->dry[f])
			own.diagonal[f] = 1;
	for (int f = 1; f < faces; f++)
		own.lower[f] = own.upper[f - 1];
	if (a == 0)
		return;
	struct bands down = bands_of(system, a - 1);

	for (int f = 0; f < faces; f++) {
		system->below_diagonal[row + (size_t)f] = down.above_diagonal[f];
		system->below_lower[row + (size_t)f] = f > 0 ? down.above_upper[f - 1] : 0;
		system->below_upper[row + (size_t)f] = f + 1 < faces ? down.above_lower[f + 1] : 0;
	}
}

/* The five numbers per cell that say the matrix (linear/pressure_system.h). */
static void fill_cells(const struct pressure_input *in, struct pressure_cells *cells)
{
	const struct grid *grid = in->grid;
	const double *h = in->h, *b = in->b;
	double n = in->layers, quarter = 0.25 / grid->dx, half = 0.5 / grid->dx;

	for (int i = 1; i <= grid->cells; i++) {
		bool wet = h[i] > DRY_NO_MOMENTUM;

		cells->inverse[i] = wet ? 1 / h[i] : 0;
		cells->stretch[i] = wet ? half * half * h[i] : 0;
		cells->lean[i] = wet ? quarter * (h[i + 1] - h[i - 1]) : 0;
		cells->tilt[i] =
			wet ? quarter * (0.5 * (h[i + 1] - h[i - 1]) + n * (b[i + 1] - b[i - 1])) : 0;
	}
	cells->cross = half;
	cells->quarter_nn = 0.25 * n * n;
}

/* The right side -(1/dt) sum of N l_a T^T u of a layer as it acts on its lower (`sign` 1) or upper interface:
 * what each cell gives to its left face, and to its right one. */
KERNEL static void layer_terms(const struct pressure_input *in, const struct pressure_cells *cells,
	int a, double sign, double *restrict left, double *restrict right)
{
	const double *restrict h = in->h, *restrict lean = cells->lean, *restrict tilt = cells->tilt;
	const double *restrict u = in->u + (size_t)a * in->grid->stride;
	const double *restrict w = in->w + (size_t)a * in->grid->stride;
	double half = cells->share[a] * (0.5 / in->grid->dx), up = sign * 0.5 * in->layers;
	double place = cells->place[a];

	for (int i = 1; i <= in->grid->cells; i++) {
		double p = half * h[i] * u[i], rest = up * w[i] - sign * (lean[i] * place + tilt[i]) * u[i];

		left[i] = p + rest;
		right[i] = rest - p;
	}
}

KERNEL static void add_terms(const struct pressure_input *in, const double *restrict left,
	const double *restrict right, double *restrict rhs)
{
	const bool *restrict dry = in->dry;
	double scale = -1 / in->dt;

	for (int f = 0; f < in->grid->faces; f++)
		rhs[f] = dry[f] ? 0 : rhs[f] + scale * (right[f] + left[f + 1]);
}

static void fill_right_side(const struct pressure_input *in, struct pressure_system *system)
{
	double *left = system->rows[0], *right = system->rows[1];

	memset(system->rhs, 0, (size_t)system->layers * (size_t)system->faces * sizeof(double));
	left[0] = right[0] = left[system->faces] = right[system->faces] = 0;
	for (int a = 0; a < in->layers; a++) {
		layer_terms(in, &system->cells, a, 1, left, right);
		add_terms(in, left, right, system->rhs + pressure_system_row(system, a));
		if (a + 1 == in->layers)
			continue;
		layer_terms(in, &system->cells, a, -1, left, right);
		add_terms(in, left, right, system->rhs + pressure_system_row(system, a + 1));
	}
	for (int a = 0; a < in->layers && system->periodic; a++) {
		double *rhs = system->rhs + pressure_system_row(system, a);

		pressure_system_join(&rhs[0], &rhs[system->faces - 1]);
	}
}

static void fill_bands(const struct pressure_input *in, struct pressure_system *system)
{
	size_t bytes = (size_t)system->layers * (size_t)system->faces * sizeof(double);
	double *const filled[] = {system->diagonal, system->lower, system->upper, system->above_lower,
		system->above_diagonal, system->above_upper};

	for (size_t i = 0; i < sizeof filled / sizeof *filled; i++)
		memset(filled[i], 0, bytes);
	for (int a = 0; a < in->layers; a++)
		add_layer(in, system, a);
	for (int a = 0; a < in->layers; a++)
		complete_layer(in, system, a);
}

static void assemble(const struct pressure_input *in, struct pressure_system *system)
{
	fill_cells(in, &system->cells);
	fill_right_side(in, system);
	if (system->diagonal)
		fill_bands(in, system);
}

const struct pressure_operator operator_symmetric = {
	.name = "symmetric", .symmetric = true, .assemble = assemble};
