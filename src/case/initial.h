/* Initial shapes of the granular mass: rows of a table, chosen by `initial.shape`. */
#ifndef TALUS_INITIAL_H
#define TALUS_INITIAL_H

#include "case/grid.h"

/* Fill the thickness of cells 1..cells with the mass at rest at t = 0; `h` is a row with ghosts, m. */
void initial_thickness(const struct config *config, const struct grid *grid, double *h);

#endif
