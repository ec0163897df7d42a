/* Modes of unequal layers: what diagonalises both vertical parts of the pressure operator without its xi
 * terms (fast_diagonal.h), B^T L B and D^T L^-1 D with L the thicknesses of the layers in mean ones. */
#ifndef TALUS_MODES_H
#define TALUS_MODES_H

#include "talus/error.h"

/* The value of mode m at the interface below layer a into modes[m layers + a], and what it makes of the two
 * parts into stretch[m] and 1 - stretch[m]. EX_SOFTWARE out of memory. */
int modes_find(const double *shares, int layers, double *modes, double *stretch, struct error *err);

#endif
