/* The recorder's memory, shared by the files that fill it and that write and read it. */
#ifndef TALUS_RECORDER_PARTS_H
#define TALUS_RECORDER_PARTS_H

#include "run/history.h"
#include "run/probes.h"
#include "run/recorder.h"

/* Series of every model, before the model's own. */
enum { RECORDER_TIME, RECORDER_DT, RECORDER_OWN };

struct field_rows {
	size_t size;    /* of one row */
	double *rows;   /* [profile rows][size]; [1][size] of a constant one */
	double *before; /* [size], before the step that holds a profile time */
};

/* Where recording stands after a step: all that recording on from there needs, beside the rows. */
struct recorder_place {
	size_t rows, profile_rows; /* recorded so far */
	double next_sample;        /* series are due at this multiple of series_every; a whole number */
	size_t next_profile;       /* index into output.profiles_at */
	double *sums;              /* [series], what the next row will hold */
	struct history history;
};

struct recorder {
	const struct model *model;
	const struct config *config;
	struct axes axes;
	size_t cells, layers;
	bool watches_steps; /* observes every step, recorded or not */
	struct recorder_place now;
	struct recorder_place mark; /* of recorder_mark; no sums: there is none */

	size_t capacity;
	double **columns; /* [RECORDER_OWN + series][capacity] */
	double *observed; /* [series], of the last step */
	struct probes probes;

	size_t profile_capacity;
	double *profile_times;     /* [profile_capacity] */
	struct field_rows *fields; /* [profiles] */
	double *after;             /* the largest field, after the step */
};

/* The axes of a profile: NULL and 1 for one that it does not have. */
struct recorder_axes {
	const char *up, *x;
	size_t ups, xs;
};

struct recorder_axes recorder_axes(const struct recorder *recorder, const struct profile *profile);

int recorder_reserve_rows(struct recorder *recorder, size_t rows, struct error *err);
int recorder_reserve_profiles(struct recorder *recorder, size_t rows, struct error *err);

#endif
