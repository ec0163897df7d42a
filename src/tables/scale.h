/* Scales that take a unit away, as P1 Figure 17 chooses them for a column: a length is divided by h_0, its
 * height, a time by tau_c = sqrt(h_0/(g cos theta)), a velocity by v_0 = sqrt(g h_0 cos theta); with the density
 * phi_s rho_s, a pressure by p_0 = phi_s rho_s g h_0 cos theta, a mass per width by M_0 = phi_s rho_s h_0^2, an
 * energy per width by E_0 = p_0 h_0^2, a power per area by p_0 v_0. */
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
