/* Scales that take a unit away, as P1 Figure 17 chooses them for a column: a length is divided by h_0, its
 * height, a time by tau_c = sqrt(h_0/(g cos theta)), a velocity by v_0 = sqrt(g h_0 cos theta). */
#ifndef TALUS_SCALE_H
#define TALUS_SCALE_H

#include "talus/config.h"

struct scale {
	const char *unit, *name; /* "m", "h0" */
	const char *marked;      /* name in gnuplot's marks */
	double (*value)(const struct config *config);
};

/* The scale of a dataset or metric `name` in this unit ("m/s"); NULL: it has none. What the computer took
 * is no time of the flow. */
const struct scale *scale_find(const char *name, const char *unit);

#endif
