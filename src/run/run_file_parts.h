/* What the run folder needs of a run file beyond <talus/run_file.h>. */
#ifndef TALUS_RUN_FILE_PARTS_H
#define TALUS_RUN_FILE_PARTS_H

#include "talus/config.h"
#include "talus/run_file.h"

#define RUN_FILE_NEWEST "run.h5"
#define RUN_FILE_PREVIOUS "run.previous.h5"

/* The groups of a run file that hold a state to the bit: the present one, and the one before the steps
 * that share what was left until the end of the run. No step before that one depends on time.end, so a
 * run with a later end goes on from there, and has the bits of one that had that end from the start. */
#define RUN_FILE_CHECKPOINT "/checkpoint"
#define RUN_FILE_CONTINUATION RUN_FILE_CHECKPOINT "/continuation"

const char *run_file_path(const struct run_file *file);
const struct run_summary *run_file_summary(const struct run_file *file);

/* Open a run file, or the newest good generation in a run folder. As run_file_open_newest. */
int run_file_open_any(
	const char *path, struct run_file **out, struct text *warning, struct error *err);

/* Whether this is run.h5 itself rather than the previous generation. */
bool run_file_is_newest(const struct run_file *file);

/* The HDF5 image, owned by `file`. */
unsigned char *run_file_image(const struct run_file *file, size_t *size);

/* The config that the file was made from. EX_DATAERR: one that this version cannot read; EX_SOFTWARE. */
int run_file_config(struct run_file *file, struct config *config, struct error *err);

/* The path of every dataset, sorted, one a line. */
int run_file_names(struct run_file *file, struct text *out, struct error *err);

/* Whether the file holds `path`. EX_SOFTWARE. */
int run_file_has(struct run_file *file, const char *path, bool *has, struct error *err);

/* The length of the scale that axis `axis` of a dataset has; 0 without a scale. */
int run_file_scale_length(
	struct run_file *file, const char *path, int axis, size_t *length, struct error *err);

/* Text attribute `name` ("units", "long_name") of a dataset; nothing is added where it has none.
 * EX_DATAERR, EX_SOFTWARE. */
int run_file_dataset_text(
	struct run_file *file, const char *path, const char *name, struct text *out, struct error *err);

/* The name of the scale that axis `axis` of a dataset has; nothing is added without one. */
int run_file_scale_name(
	struct run_file *file, const char *path, int axis, struct text *out, struct error *err);

/* Read a dataset of exactly `count` values. EX_DATAERR. */
int run_file_fill(
	struct run_file *file, const char *path, double *values, size_t count, struct error *err);

/* "unfinished", "complete", "failed" */
const char *run_status_name(enum run_status status);

#endif
