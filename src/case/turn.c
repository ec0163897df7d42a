#include "case/turn.h"

#include <math.h>
#include <stdlib.h>

#include "case/topography.h"

/* In long double, as cos in double is chosen by processor and differs in bits. */
struct turn turn_to_local(double slope)
{
	return (struct turn){(double)(1 / cosl(slope)), (double)sinl(slope), (double)cosl(slope)};
}

struct turn turn_to_cartesian(double slope)
{
	return (struct turn){(double)cosl(slope), (double)-sinl(slope), (double)(1 / cosl(slope))};
}

static double turned_x(const struct turn *turn, double x, double d)
{
	return turn->along * x - turn->back * d;
}

/* The part of a line that rises from (x, d) by (dx, dd), in the cells that it crosses. */
static void add_line(
	const struct grid *grid, double x, double d, double dx, double dd, double sign, double *row)
{
	double from = (x - grid->x_min) / grid->dx, to = (x + dx - grid->x_min) / grid->dx;
	int first = (int)fmax(0, fmin(floor(from), grid->cells));

	for (int i = first; i < grid->cells && i < to; i++) {
		double left = fmax(from, i), right = fmin(to, i + 1);

		if (right > left)
			row[i + 1] +=
				sign * (right - left) * (d + dd * (0.5 * (left + right) - from) / (to - from));
	}
}

void turn_add(const struct turn *turn, const double *x, const double *d, int count,
	const struct grid *grid, double *row)
{
	for (int k = 0; k + 1 < count; k++) {
		double x0 = turned_x(turn, x[k], d[k]), x1 = turned_x(turn, x[k + 1], d[k + 1]);
		double d0 = turn->scale * d[k], d1 = turn->scale * d[k + 1];

		if (x1 > x0)
			add_line(grid, x0, d0, x1 - x0, d1 - d0, 1, row);
		else if (x1 < x0)
			add_line(grid, x1, d1, x0 - x1, d0 - d1, -1, row);
	}
}

bool turn_reaches(const struct turn *turn, const double *x, const double *d, int count,
	const struct grid *grid, double *at)
{
	double rounding = 1e-9 * grid->dx;

	for (int k = 0; k + 1 < count; k++)
		if (turned_x(turn, x[k + 1], d[k + 1]) < turned_x(turn, x[k], d[k])) {
			*at = 0.5 * (x[k] + x[k + 1]);
			return false;
		}
	*at = NAN;
	return turned_x(turn, x[0], d[0]) <= grid->x_min + rounding &&
		   turned_x(turn, x[count - 1], d[count - 1]) >=
			   grid->x_min + grid->cells * grid->dx - rounding;
}

int turn_profile(const struct config *config, const double *x, const double *b, const double *h,
	int cells, const struct grid *onto, double *out, struct error *err)
{
	bool cartesian = config->coordinates == COORDINATES_CARTESIAN;
	struct turn turn = cartesian ? turn_to_local(config->slope) : turn_to_cartesian(config->slope);
	size_t points = (size_t)cells + 2, size = 3 * points + 2 * onto->stride;
	double *at = calloc(size, sizeof *at), *bed, *surface, *below, *above;
	double half = cells > 1 ? 0.5 * (x[1] - x[0]) : 0;

	if (!at)
		return error_memory(err, size * sizeof *at);
	bed = at + points;
	surface = bed + points;
	below = surface + points;
	above = below + onto->stride;
	for (int k = 0; k < cells + 2; k++) { /* the half cells at the ends are as their middles */
		int i = k == 0 ? 0 : k > cells ? cells - 1 : k - 1;

		at[k] = x[i] + (k == 0 ? -half : k > cells ? half : 0);
		bed[k] = b[i] - (cartesian ? topography_plane(config, x[i]) : 0);
		surface[k] = bed[k] + h[i];
	}
	turn_add(&turn, at, bed, cells + 2, onto, below);
	turn_add(&turn, at, surface, cells + 2, onto, above);
	for (int i = 1; i <= onto->cells; i++)
		out[i - 1] = above[i] - below[i];
	free(at);
	return 0;
}
