#include "case/initial.h"

/* P1 (34): a column behind the gate, on an erodible bed of the same material. */
static double column(const struct config *config, double x)
{
	return config->erodible_bed_thickness +
		   (x <= config->initial.front ? config->initial.height : 0);
}

/* Thickness at x, m; the index is enum shape_kind. */
static double (*const shapes[])(const struct config *config, double x) = {
	[SHAPE_COLUMN] = column,
};

void initial_thickness(const struct config *config, const struct grid *grid, double *h)
{
	for (int i = 1; i <= grid->cells; i++)
		h[i] = shapes[config->initial.shape](config, grid_centre(grid, i));
	grid_fill_even(grid, h);
}
