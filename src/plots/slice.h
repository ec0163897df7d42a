/* A line of numbers cut out of a dataset of a run file: one of its axes stays, the others are fixed. */
#ifndef TALUS_SLICE_H
#define TALUS_SLICE_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"
#include "talus/run_file.h"

enum { SLICE_FIRST = 0, SLICE_TOP = -1 };

/* Where to cut. What a dataset has no axis for is passed over. */
struct slice_place {
	const char *along; /* name of the axis that stays; NULL: none, one number is cut out */
	double time;       /* profile time, or the nearest record of a series, s; NaN: the last */
	double x;  /* the nearest cell is taken, or just this gauge, m; NaN: only where there is one */
	int layer; /* from 1 at the bed; SLICE_TOP, or SLICE_FIRST for that of the axis: the top
	                      layer, the interface at the bed */
};

struct slice {
	double *axis;   /* values of the axis that stays, [count] */
	double *values; /* [count] */
	size_t count;
};

/* EX_DATAERR where the file lacks what is asked for. Clean in every case. */
int slice_read(struct run_file *file, const char *name, const struct slice_place *place,
	struct slice *out, struct error *err);

void slice_clean(struct slice *slice);

/* Has the dataset an axis of this name? False with `err` set where it cannot be read. */
bool slice_has_axis(struct run_file *file, const char *name, const char *axis, struct error *err);

/* The name of the axis across the layers that a dataset has: "layer", "interface", NULL: none,
 * or `err` is set. */
const char *slice_layer_axis(struct run_file *file, const char *name, struct error *err);

/* The name of the axis of positions: "x", or "gauge" or "station" of what is recorded at few; NULL. */
const char *slice_position_axis(struct run_file *file, const char *name, struct error *err);

/* The name of the axis of times: "profile_time" or "time"; NULL. */
const char *slice_time_axis(struct run_file *file, const char *name, struct error *err);

/* The values of an axis. `values` belongs to the caller. */
int slice_axis(
	struct run_file *file, const char *axis, double **values, size_t *count, struct error *err);

/* Whether a profile time that was stored is the one that was asked for. */
bool slice_same_time(double stored, double asked);

#endif
