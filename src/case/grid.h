/* Equal cells along x, each row of cells with one ghost at either end. */
#ifndef TALUS_GRID_H
#define TALUS_GRID_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/config.h"

/* Cell i = 1..cells lies between face i - 1 and face i; cells 0 and cells + 1 are ghosts. */
struct grid {
	int cells;
	int faces;                  /* cells + 1 */
	size_t stride;              /* cells + 2: length of a row of cells with its ghosts */
	double x_min;               /* m */
	double dx;                  /* m */
	bool left_wall, right_wall; /* else outflow, or */
	bool periodic;              /* both ends are one */
};

static inline struct grid grid_make(const struct config *config)
{
	int cells = config->domain.cells;

	return (struct grid){
		.cells = cells,
		.faces = cells + 1,
		.stride = (size_t)cells + 2,
		.x_min = config->domain.x_min,
		.dx = (config->domain.x_max - config->domain.x_min) / cells,
		.left_wall = config->domain.left == BOUNDARY_WALL,
		.right_wall = config->domain.right == BOUNDARY_WALL,
		.periodic = config->domain.left == BOUNDARY_PERIODIC,
	};
}

/* Centre of cell i = 1..cells, m. */
static inline double grid_centre(const struct grid *grid, int i)
{
	return grid->x_min + (i - 0.5) * grid->dx;
}

/* Ghosts of the scalars: they repeat their neighbour (P1 Remark 6: thickness, bed), or the other end. */
static inline void grid_fill_even(const struct grid *grid, double *row)
{
	row[0] = row[grid->periodic ? grid->cells : 1];
	row[grid->cells + 1] = row[grid->periodic ? 1 : grid->cells];
}

/* Ghosts of discharges and velocities along x: opposite at a wall, repeated at an outflow. */
static inline void grid_fill_odd(const struct grid *grid, double *row)
{
	grid_fill_even(grid, row);
	if (grid->left_wall)
		row[0] = -row[1];
	if (grid->right_wall)
		row[grid->cells + 1] = -row[grid->cells];
}

#endif
