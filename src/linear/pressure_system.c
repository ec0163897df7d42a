#include "linear/pressure_system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/kernel.h"

/* One block for all arrays; called with NULL it counts. */
static size_t layout(struct pressure_system *system, double *memory, bool bands)
{
	size_t n = (size_t)system->layers * (size_t)system->faces, row = (size_t)system->faces + 1;
	size_t column = ((size_t)system->layers / LANES + 1) * LANES;
	struct pressure_cells *cells = &system->cells;
	double **const banded[] = {&system->lower, &system->diagonal, &system->upper,
		&system->below_lower, &system->below_diagonal, &system->below_upper, &system->above_lower,
		&system->above_diagonal, &system->above_upper};
	double **const rows[] = {&cells->stretch, &cells->lean, &cells->tilt, &cells->inverse,
		&system->weight, &system->rows[0], &system->rows[1], &system->rows[2], &system->rows[3],
		&system->rows[4]};
	double **const columns[] = {&cells->share, &cells->thin, &cells->place};
	size_t at = 0;

	for (size_t i = 0; bands && i < sizeof banded / sizeof *banded; i++, at += n)
		*banded[i] = memory ? memory + at : NULL;
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++, at += row)
		*rows[i] = memory ? memory + at : NULL;
	for (size_t i = 0; i < sizeof columns / sizeof *columns; i++, at += column)
		*columns[i] = memory ? memory + at : NULL;
	system->rhs = memory ? memory + at : NULL;
	at += n;
	system->x_stride = row + 1;
	system->x = memory ? memory + at : NULL;
	return at + ((size_t)system->layers + 2) * system->x_stride;
}

int pressure_system_init(
	struct pressure_system *system, int layers, int faces, bool bands, struct error *err)
{
	size_t count;

	*system = (struct pressure_system){.layers = layers, .faces = faces};
	count = layout(system, NULL, bands);
	system->memory = calloc(count, sizeof *system->memory);
	if (!system->memory)
		return error_memory(err, count * sizeof *system->memory);
	(void)layout(system, system->memory, bands);
	pressure_system_set_shares(system, NULL);
	return 0;
}

void pressure_system_set_shares(struct pressure_system *system, const double *shares)
{
	struct pressure_cells *cells = &system->cells;
	double below = 0; /* the layer */

	for (int a = 0; a < (system->layers / LANES + 1) * LANES; a++) {
		cells->share[a] = shares && a < system->layers ? shares[a] : 1;
		cells->thin[a] = 1 / cells->share[a];
		cells->place[a] = below + 0.5 * (cells->share[a] - 1);
		below += cells->share[a];
	}
}

void pressure_system_clean(struct pressure_system *system)
{
	free(system->memory);
	*system = (struct pressure_system){0};
}

/* What cell and layer give to their lower left and upper left corner: g - e and g + e. */
KERNEL static void cell_terms(
	const struct pressure_system *system, int a, double *restrict low, double *restrict high)
{
	const double *restrict x = pressure_system_x(system, a);
	const double *restrict y = pressure_system_x(system, a + 1);
	const double *restrict stretch = system->cells.stretch, *restrict lean = system->cells.lean;
	const double *restrict tilt = system->cells.tilt, *restrict inverse = system->cells.inverse;
	double cross = system->cells.cross, nn = system->cells.quarter_nn;
	double place = system->cells.place[a], share = system->cells.share[a];
	double thin = system->cells.thin[a];

	for (int i = 1; i < system->faces; i++) {
		double jump = (x[i - 1] + y[i - 1]) - (x[i] + y[i]);
		double difference = (y[i - 1] + y[i]) - (x[i - 1] + x[i]);
		double s = lean[i] * place + tilt[i], cs = cross * s;
		double g = share * stretch[i] * jump + cs * difference;
		double e = cs * jump + (s * s + nn) * (thin * inverse[i]) * difference;

		low[i] = g - e;
		high[i] = g + e;
	}
}

/* rhs - A x of layer a. `low`, `high` are of layer a, the other two of the layer below. */
KERNEL static void cells_residual(const struct pressure_system *system, int a,
	const double *restrict low, const double *restrict high, const double *restrict low_below,
	const double *restrict high_below, double *restrict out)
{
	const double *restrict rhs = system->rhs + pressure_system_row(system, a);
	const bool *restrict dry = system->cells.dry;

	for (int f = 0; f < system->faces; f++) {
		double right = low[f + 1] + high_below[f + 1], left = high[f] + low_below[f];

		out[f] = dry[f] ? 0 : rhs[f] - (right - left);
	}
}

KERNEL static void bands_residual(const struct pressure_system *system, int a, double *restrict out)
{
	size_t k = pressure_system_row(system, a);
	const double *restrict x = pressure_system_x(system, a);
	const double *restrict down = pressure_system_x(system, a - 1);
	const double *restrict up = pressure_system_x(system, a + 1);

	for (int f = 0; f < system->faces; f++, k++)
		out[f] = system->rhs[k] - system->lower[k] * x[f - 1] - system->diagonal[k] * x[f] -
				 system->upper[k] * x[f + 1] - system->below_lower[k] * down[f - 1] -
				 system->below_diagonal[k] * down[f] - system->below_upper[k] * down[f + 1] -
				 system->above_lower[k] * up[f - 1] - system->above_diagonal[k] * up[f] -
				 system->above_upper[k] * up[f + 1];
}

/* Calls `visit` with the residual of every layer, bottom first. */
static void each_residual_row(const struct pressure_system *system,
	void (*visit)(const struct pressure_system *system, int a, const double *row, void *context),
	void *context)
{
	double *low = system->rows[0], *high = system->rows[1], *out = system->rows[4];
	double *low_below = system->rows[2], *high_below = system->rows[3];

	for (int f = 0; f <= system->faces; f++)
		low[f] = high[f] = low_below[f] = high_below[f] = 0;
	for (int a = 0; a < system->layers; a++) {
		if (system->symmetric) {
			double *const spare_low = low_below, *const spare_high = high_below;

			cell_terms(system, a, low, high);
			cells_residual(system, a, low, high, low_below, high_below, out);
			low_below = low;
			high_below = high;
			low = spare_low;
			high = spare_high;
		} else {
			bands_residual(system, a, out);
		}
		if (system->periodic)
			pressure_system_join(&out[0], &out[system->faces - 1]);
		visit(system, a, out, context);
	}
}

struct squares {
	double residual, scale;
	double *rows; /* NULL, or where the residual goes */
};

KERNEL static void add_squares(
	const struct pressure_system *system, int a, const double *row, void *context)
{
	struct squares *sum = context;
	const double *rhs = system->rhs + pressure_system_row(system, a);

	if (sum->rows)
		memcpy(
			sum->rows + pressure_system_row(system, a), row, (size_t)system->faces * sizeof *row);
	sum->residual += kernel_dot(row, row, system->faces);
	sum->scale += kernel_dot(rhs, rhs, system->faces);
	if (system->periodic) { /* (r/2 + r/2)^2 is twice the sum of the squares */
		sum->residual += 2 * row[0] * row[0];
		sum->scale += 2 * rhs[0] * rhs[0];
	}
}

double pressure_system_residual(const struct pressure_system *system)
{
	return pressure_system_residual_rows(system, NULL);
}

double pressure_system_residual_rows(const struct pressure_system *system, double *rows)
{
	struct squares sum = {.rows = rows};

	each_residual_row(system, add_squares, &sum);
	return sum.residual == 0 ? 0 : sqrt(sum.residual / sum.scale);
}

struct worst {
	double value;
	int face;
};

static void find_worst(
	const struct pressure_system *system, int a, const double *row, void *context)
{
	struct worst *worst = context;

	(void)a;
	for (int f = 0; f < system->faces && !isnan(worst->value); f++)
		if (isnan(row[f]) || fabs(row[f]) > worst->value)
			*worst = (struct worst){fabs(row[f]), f};
}

int pressure_system_worst_face(const struct pressure_system *system)
{
	struct worst worst = {-1, 0};

	each_residual_row(system, find_worst, &worst);
	return worst.face;
}
