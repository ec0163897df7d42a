/* The kinds of plots: what becomes of a run file in a panel. */
#ifndef TALUS_KIND_H
#define TALUS_KIND_H

#include "plots/curves.h"
#include "talus/run_file.h"

/* The ways in which curves of one run differ, behind those in which runs differ. */
enum kind_part { KIND_Y, KIND_AT, KIND_AT_X, KIND_LAYER, KIND_PARTS };

/* The times, positions and layers that a panel asks for, read. */
struct kind_cuts {
	double *times; /* [time_count] */
	size_t time_count;
	bool all_times;    /* those that the run file has */
	double *positions; /* [position_count] */
	size_t position_count;
	int *layers; /* [layer_count] */
	size_t layer_count;
};

/* EX_DATAERR with the place in the file of `path` where a value cannot be read. Clean in every case. */
int kind_cuts_read(struct kind_cuts *cuts, const struct experiment_panel *wanted, const char *path,
	struct error *err);
void kind_cuts_clean(struct kind_cuts *cuts);

/* One run and where its curves go. */
struct kind_run {
	struct run_file *file;
	const struct config *config; /* NULL: cannot be read; then nothing is dimensionless */
	const char *name;            /* for what is missing */
	const char *const *parts;    /* values in which runs differ, [part_count] */
	size_t part_count;
};

struct kind;

/* What all runs of a panel share. */
struct kind_request {
	const struct kind *kind;
	const struct experiment_panel *wanted;
	const struct kind_cuts *cuts;
	const char *path; /* of the experiment, for messages */
	const char *what; /* "plot 'p1-figure3'" */
	struct curves *curves;
	struct text *missing; /* a line per thing that the run lacks */
};

struct kind {
	const char *name;
	const char *along; /* axis of the datasets that is drawn along */
	enum figure_mark mark;
	bool upright; /* the axis is drawn upwards, the values to the right */
	bool timed;   /* shows chosen profile times */
	/* Make the curve of dataset `name` at `place`, as `along` says, or the whole map. */
	int (*add)(const struct kind_request *request, const struct kind_run *run, const char *name,
		const struct kind *kind, struct error *err);
};

/* NULL if there is none of that name; then `nearest` is the name that comes closest. The kind "metric",
 * which needs more than one run, has no `add`. */
const struct kind *kind_find(const char *name, const char **nearest);

/* Whether a dataset is a thickness, with the erodible bed in it. */
bool kind_holds_bed(const char *name);

/* Add to the dimensions of the curves those in which the curves of a run differ. */
bool kind_add_dimensions(const struct kind_request *request);

/* Add all curves of a run. What it lacks goes to `missing`. EX_DATAERR: a unit that does not fit;
 * EX_SOFTWARE. */
int kind_add_run(const struct kind_request *request, const struct kind_run *run, struct error *err);

/* Label and factor of one axis: numbers in SI times the factor are what is drawn. `index` is 0 for x and
 * 1 for y of the panel. */
struct meaning;
int kind_axis(const struct kind_request *request, const struct kind_run *run, int index,
	const struct meaning *meaning, double *factor, struct error *err);

#endif
