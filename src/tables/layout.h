/* Where every run of an experiment stands in a table, before any run file is opened. */
#ifndef TALUS_LAYOUT_H
#define TALUS_LAYOUT_H

#include <stddef.h>
#include <stdint.h>

#include "tables/metric.h"
#include "talus/experiment.h"

/* The values that a row or a column stands for. */
struct label {
	char *identity; /* the same for equal values, however written */
	char **parts;   /* one per key, as the author wrote it, [keys] */
};

struct label_list {
	struct label *items; /* [count], in the order of the runs */
	size_t count;
	size_t keys;
};

/* One number per cell. */
struct measure {
	const struct metric *metric;
	double at;           /* profile time, s; NaN: the end of each run */
	const char *at_text; /* as written, NULL: the end */
	double x;            /* position, m */
	const char *x_text;  /* as written, NULL: everywhere */
};

enum { LAYOUT_NOWHERE = -1 };
#define LAYOUT_ALONE SIZE_MAX /* in the place of a run: there is none */

/* The place of a run. */
struct place {
	long row, column;         /* LAYOUT_NOWHERE: not in this table */
	size_t partner[PARTNERS]; /* by enum metric_partner: index of the run it is compared with */
	size_t previous;          /* run of the row before in the same column, or LAYOUT_ALONE */
};

struct layout {
	const struct experiment *experiment;
	const struct experiment_table *wanted;
	char *what; /* "table 'p1-table2'", for messages */
	struct label_list rows, columns;
	struct measure *measures; /* [measure_count] */
	size_t measure_count;
	struct place *places;      /* one per run of the experiment */
	struct observed *observed; /* the files of the experiment's observations, in their order */
	const char **published;    /* [rows][columns][measures], NULL: blank; NULL if there are none */
};

/* EX_DATAERR with the place in the experiment file where it asks for what cannot be. `noun` says in
 * messages what is laid out: "table". Clean in every case. */
int layout_create(struct layout *layout, const struct experiment *experiment,
	const struct experiment_table *wanted, const char *noun, struct error *err);

void layout_clean(struct layout *layout);

/* EX_DATAERR at the place of `term`. Returns -1. */
int layout_fail(const struct layout *layout, const struct term *term, struct error *err,
	const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Give a placeless error the place of `term`. Returns -1. */
int layout_place_error(const struct layout *layout, const struct term *term, struct error *err);

/* Whether the run has a value of the metric: an order wants a row before, and errors that are not those of
 * the reference itself. */
bool layout_asks(const struct layout *layout, size_t run, const struct metric *metric);

/* Refuse a time (NaN: the end) at which some run that has a place stores no profile: what is shown of
 * it would be missing for ever. */
int layout_check_time(const struct layout *layout, const struct term *term, double at,
	const char *at_text, struct error *err);

/* The observations of a run that have this dataset, over x or over time; NULL: there are none. */
int layout_observed(const struct layout *layout, const struct experiment_run *run, const char *name,
	bool over_x, const struct observed **out, struct error *err);

/* layout_measures.c: every metric once, those of a profile once for every time, those of a place once for every
 * position. EX_DATAERR where a run cannot have one. */
int layout_list_measures(struct layout *layout, struct error *err);

/* published.c: read the published values. */
int layout_read_published(struct layout *layout, struct error *err);

#endif
