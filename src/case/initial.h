/* What is there at t = 0: the bed, and the grains at rest on it, a shape of `initial.shape`. */
#ifndef TALUS_INITIAL_H
#define TALUS_INITIAL_H

#include "case/grid.h"

/* Fill two rows with ghosts: the bed above the reference plane, and the thickness, m; in the coordinates of
 * the run. EX_DATAERR: a bed that these coordinates cannot hold, no grains. EX_SOFTWARE. */
int initial_fill(
	const struct config *config, const struct grid *grid, double *b, double *h, struct error *err);

/* Whether that can be done. */
int initial_check(const struct config *config, struct error *err);

/* Upward velocity of the grains at x that an opening gate takes along, P2 (30), m/s. */
double initial_velocity(const struct config *config, double x);

#endif
