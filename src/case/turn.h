/* The change between local and Cartesian coordinates (P1 5.4.1, P2 4.1): what lies above the reference
 * plane, turned by its angle. Both have their origin where the plane is over x = 0. */
#ifndef TALUS_TURN_H
#define TALUS_TURN_H

#include "case/grid.h"

/* A point at x and d above the plane is afterwards at along x - back d and scale d above it. d is normal to
 * the plane in local coordinates and vertical in Cartesian ones. Areas stay. */
struct turn {
	double along, back, scale;
};

struct turn turn_to_local(double slope);
struct turn turn_to_cartesian(double slope);

/* Where the line through `count` points (x rising, d above the plane) is after the turn: add the area
 * between it and the plane, over dx, to the cells of a row with ghosts. Where the line overhangs, what is
 * below its upper part and above its lower one counts once. */
void turn_add(const struct turn *turn, const double *x, const double *d, int count,
	const struct grid *grid, double *row);

/* Does the turned line rise in x from one end of the grid to the other? If not, `*at` is an x, before the
 * turn, where it folds, or NAN where it only falls short of the ends. */
bool turn_reaches(const struct turn *turn, const double *x, const double *d, int count,
	const struct grid *grid, double *at);

/* A profile of a run of `config` in the other coordinates: from the recorded bed `b` and thickness `h` at `cells`
 * positions, which becomes the means over the cells of `onto`, [onto->cells], m. EX_SOFTWARE. */
int turn_profile(const struct config *config, const double *x, const double *b, const double *h,
	int cells, const struct grid *onto, double *out, struct error *err);

#endif
