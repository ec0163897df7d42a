/* The run file: one HDF5 image with a digest behind it, written whole and read whole. */
#ifndef TALUS_RUN_FILE_H
#define TALUS_RUN_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "talus/error.h"
#include "talus/text.h"

enum run_status { RUN_UNFINISHED, RUN_COMPLETE, RUN_FAILED };

/* What the trailer says without opening the image. */
struct run_summary {
	enum run_status status;
	uint64_t step;        /* steps done */
	double time;          /* simulated, s */
	char config_hash[17]; /* config_hash of the effective config */
};

struct run_file; /* an open image, all in memory; the file itself is closed */

/* Read `path` and verify its digest. EX_DATAERR: not a run file, or damaged (says how). A copy that
 * lost its trailer (h5repack) opens; then `*warning` (when not NULL) is a static text, else NULL. */
int run_file_open(const char *path, struct run_file **out, const char **warning, struct error *err);

/* The newest good generation in a run folder: run.h5, or run.previous.h5 with a warning when run.h5
 * is damaged or missing. `warning` is filled with a sentence, or left empty. EX_DATAERR when no
 * generation is good; EX_NOINPUT when neither exists. */
int run_file_open_newest(
	const char *folder, struct run_file **out, struct text *warning, struct error *err);

void run_file_close(struct run_file *file); /* NULL-safe */

/* The trailer of `path` alone; does not verify the image. */
int run_file_peek(const char *path, struct run_summary *summary, struct error *err);

/* Root attributes. EX_DATAERR when absent or of another type. */
int run_file_text(struct run_file *file, const char *name, struct text *out, struct error *err);
int run_file_real(struct run_file *file, const char *name, double *out, struct error *err);

/* A dataset read as doubles. `values` belongs to the caller (free). */
struct dataset {
	int rank;
	size_t extent[3]; /* [rank] */
	double *values;   /* row major, the product of the extents */
};
int run_file_dataset(
	struct run_file *file, const char *path, struct dataset *out, struct error *err);

#endif
