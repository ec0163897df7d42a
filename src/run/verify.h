/* Whether the content of a run file makes sense. */
#ifndef TALUS_VERIFY_H
#define TALUS_VERIFY_H

#include "talus/run_file.h"

/* Check what every run promises: time grows, every axis is as long as its scale, and mass and
 * its outflow add up to the same at all times. A line in `out` for each breach; none,
 * and `out` stays empty. EX_SOFTWARE. */
int verify_run_file(struct run_file *file, struct text *out, struct error *err);

/* Whether the mass that is there and what has left, [count] each, add up to the same at all times, up to
 * the rounding of `steps` steps; else a line in `out`. */
bool verify_mass(
	const double *mass, const double *left, size_t count, uint64_t steps, struct text *out);

#endif
