/* The recent past of the series whose slope in time is recorded: every step, whatever the cadence. */
#ifndef TALUS_HISTORY_H
#define TALUS_HISTORY_H

#include "run/image.h"
#include "talus/model.h"
#include "talus/run_file.h"

struct history {
	const struct model *model;
	double window; /* the longest that a series asks for, s; 0: no series does */
	size_t width;  /* columns: the time, then each series */
	size_t first;  /* row: the earliest that is still needed */
	size_t count;  /* rows in use, those before `first` included */
	size_t capacity;
	double *values; /* [capacity][width] */
};

void history_init(struct history *history, const struct model *model);
void history_clean(struct history *history);

/* Add the series of a step, and fill in those of `values` that are slopes. EX_SOFTWARE. */
int history_add(struct history *history, double time, double *values, struct error *err);

/* Make `copy` hold what is still needed of `history`. EX_SOFTWARE. */
int history_copy(struct history *copy, const struct history *history, struct error *err);

/* As part of a group of the file: /checkpoint or /checkpoint/continuation. */
void history_write(const struct history *history, const char *group, struct image *image);
int history_read(
	struct history *history, const char *group, struct run_file *file, struct error *err);

#endif
