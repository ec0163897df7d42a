/* What the metrics of a layout say of every run. */
#ifndef TALUS_MEASURED_H
#define TALUS_MEASURED_H

#include "tables/layout.h"
#include "tables/provenance.h"

/* A run that others are compared with; neighbours share it as a rule, so it stays open. */
struct measured_other {
	struct run_file *file;
	size_t index;
};

struct measured {
	const struct layout *layout;
	double *values; /* [runs][measures], NaN: missing */
	struct provenance provenance;
	struct text warnings;                    /* lines about the files that were read */
	struct text missing;                     /* a line per missing run: its name and why */
	struct measured_other partner, previous; /* opened last */
};

/* Measure every run that has a place in the layout, which must outlive `measured`. A run that is not
 * complete is no error: see `missing`. EX_SOFTWARE. Clean in every case. */
int measured_make(struct measured *measured, const struct layout *layout, struct error *err);

void measured_clean(struct measured *measured);

/* Open a run's file if the run is complete; `*out` is NULL if not: then `missing` says why, after `what`
 * and the run's name. `warnings` gets what is not as it should be. Either may be NULL. EX_SOFTWARE out of
 * memory, which says nothing about the run. */
int measured_open(const struct experiment_run *run, const char *what, struct text *missing,
	struct text *warnings, struct run_file **out, struct error *err);

#endif
