/* The bed: rows of a table, chosen by `topography.shape`. */
#ifndef TALUS_TOPOGRAPHY_H
#define TALUS_TOPOGRAPHY_H

#include "case/grid.h"

/* Height of the reference plane over x, in Cartesian coordinates and over the datum of heights, m. */
double topography_plane(const struct config *config, double x);

/* The bed at x in the coordinates in which it is given, without what is random, m. */
double topography_bed(const struct config *config, double x);

/* Add the random heights to the cells of a row with ghosts. EX_SOFTWARE. */
int topography_add_random(
	const struct config *config, const struct grid *grid, double *row, struct error *err);

/* Between points x, value, x, value with x rising; the end values beyond. */
double topography_points_value(const struct real_list *points, double x);

#endif
