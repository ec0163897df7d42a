/* Measured values from a CSV file. */
#ifndef TALUS_OBSERVED_H
#define TALUS_OBSERVED_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"

/* The file's first line that is no comment names its columns: `time`, for profiles also `x`, and datasets
 * as run files have them, each with its unit in brackets where that is not the SI unit: "h [mm]". Lines
 * that begin with # say what people want to know. Rows go up in time, and within a time in x. */
struct observed {
	char *text;   /* of the file; names point into it */
	char **names; /* [columns] */
	size_t columns;
	double *values; /* [rows][columns], SI; NaN: an empty field */
	size_t rows;
	size_t time, x; /* their columns; x: OBSERVED_NONE for values without a place */
};

#define OBSERVED_NONE ((size_t)-1)

/* Values of one dataset over x at a time, or over time. */
struct observed_line {
	double *at, *values; /* [count], SI */
	size_t count;
};

/* EX_DATAERR with file, line and column of what is wrong; EX_SOFTWARE. Clean in every case. */
int observed_read(struct observed *observed, const char *path, struct error *err);

void observed_clean(struct observed *observed);

/* Has it values of this dataset, over x or over time? */
bool observed_has(const struct observed *observed, const char *name, bool over_x);

/* The values of a dataset that it has: at `time` where they are over x, which it must be for. Leaves `line`
 * without values where there are none. */
int observed_line(const struct observed *observed, const char *name, double time,
	struct observed_line *line, struct error *err);

void observed_line_clean(struct observed_line *line);

#endif
