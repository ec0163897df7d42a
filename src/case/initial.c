#include "case/initial.h"

#include <math.h>

/* P1 (34): a column behind the gate, on an erodible bed of the same material. */
static double column(const struct config *config, double x)
{
	return config->erodible_bed_thickness +
		   (x <= config->initial.front ? config->initial.height : 0);
}

/* A smooth heap on a layer of the same material (P1 5.2). In long double, as exp in double is chosen by
 * processor and differs in bits. */
static double heap(const struct config *config, double x)
{
	double t = (x - config->initial.centre) / config->initial.width;

	return config->erodible_bed_thickness +
		   config->initial.height * (double)expl(-(long double)t * t);
}

/* A flow without ends (P3 5.1). */
static double uniform(const struct config *config, double x)
{
	(void)x;
	return config->erodible_bed_thickness + config->initial.height;
}

/* Thickness at x, m; the index is enum shape_kind. */
static double (*const shapes[])(const struct config *config, double x) = {
	[SHAPE_COLUMN] = column,
	[SHAPE_HEAP] = heap,
	[SHAPE_UNIFORM] = uniform,
};

void initial_thickness(const struct config *config, const struct grid *grid, double *h)
{
	for (int i = 1; i <= grid->cells; i++)
		h[i] = shapes[config->initial.shape](config, grid_centre(grid, i));
	grid_fill_even(grid, h);
}
