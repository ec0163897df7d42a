/* What a cell of a table shows: a function of one run file, or of it and another. */
#ifndef TALUS_METRIC_H
#define TALUS_METRIC_H

#include <stdbool.h>
#include <stddef.h>

#include "tables/observed.h"
#include "talus/config.h"
#include "talus/error.h"
#include "talus/run_file.h"
#include "talus/text.h"

/* What a run is compared with. PARTNER_PREVIOUS is a flag beside one of the others: the metric is an order,
 * how fast `value` falls from the run of the row before, in the same column, to this one. */
enum metric_partner {
	PARTNER_NONE,
	PARTNER_BASELINE,
	PARTNER_REFERENCE,
	PARTNERS,
	PARTNER_PREVIOUS = 4,
	PARTNER_REFERENCE_PREVIOUS = PARTNER_REFERENCE | PARTNER_PREVIOUS,
};

struct sample {
	struct run_file *file;
	const struct config *config;
	struct run_file *partner; /* of the kind the metric asks for, else NULL */
	const struct config *partner_config;
	double at;                       /* profile time, s */
	double x;                        /* position, m */
	const struct observed *observed; /* that have the dataset the metric observes, else NULL */
	const struct metric *metric;
};

/* What a metric is taken of: a whole run, its profiles at a time, or those at a time and a position. */
enum metric_extent { METRIC_RUN, METRIC_PROFILE, METRIC_COLUMN };

struct metric {
	const char *name;   /* as an experiment calls it */
	const char *header; /* what it is */
	const char *unit;   /* "" if none */
	int decimals;       /* -1: three significant digits */
	enum metric_partner partner;
	enum metric_extent extent;
	const char *observes; /* dataset that is compared with observations, NULL: none */
	/* Of an order the error that falls. EX_DATAERR where the file lacks what is needed. */
	int (*value)(const struct sample *sample, double *out, struct error *err);
	const char *dataset; /* that `value` reads, where it could read others too; NULL */
	const char *meaning; /* for the reference */
};

/* Without the flag: an index below PARTNERS. */
enum metric_partner metric_partner(const struct metric *metric);

bool metric_is_order(const struct metric *metric);

/* Log of `error_before` over `error`, by how much finer the cells are here than in the row before; the layers,
 * where the cells are the same. EX_DATAERR where neither differs. */
int metric_order(const struct config *before, double error_before, const struct config *config,
	double error, double *out, struct error *err);

/* NULL if there is none of that name; then `nearest` is the name that comes closest. */
const struct metric *metric_find(const char *name, const char **nearest);

#endif
