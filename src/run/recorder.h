/* What a run leaves for its reader: series in time and profiles at chosen times. Watching never
 * changes the numbers of the run, and cadence never changes the numbers that are watched. */
#ifndef TALUS_RECORDER_H
#define TALUS_RECORDER_H

#include "run/image.h"
#include "talus/model.h"
#include "talus/run_file.h"

struct recorder;

/* `config` and the model's tables must outlive the recorder. EX_SOFTWARE. */
int recorder_create(const struct model *model, const struct config *config, const struct axes *axes,
	struct recorder **out, struct error *err);
void recorder_free(struct recorder *recorder); /* NULL-safe */

/* The state at t = 0. EX_SOFTWARE. */
int recorder_begin(struct recorder *recorder, const struct model_state *state, struct error *err);

/* A step that is about to be taken, or was. */
struct recorder_step {
	double from, dt, to; /* s */
	bool last;           /* `to` is the end of the run */
};

/* Before a step: keeps the fields that profiles within it need. */
void recorder_before(
	struct recorder *recorder, const struct model_state *state, const struct recorder_step *step);

/* After the step. EX_SOFTWARE: a series or profile cannot grow. */
int recorder_after(struct recorder *recorder, const struct model_state *state,
	const struct recorder_step *step, struct error *err);

/* The recorded values of a series [count], NULL where the model has none of that name. */
const double *recorder_series(const struct recorder *recorder, const char *name, size_t *count);

/* Remember this place as the one where the run goes on if it gets a later end. EX_SOFTWARE. */
int recorder_mark(struct recorder *recorder, struct error *err);

/* Series and profiles into the root; what recording on needs into /checkpoint, and that of the mark, if
 * there is one, into /checkpoint/continuation. */
void recorder_write(const struct recorder *recorder, struct image *image);

/* About how many bytes recorder_write writes. */
size_t recorder_size(const struct recorder *recorder);

/* Take up from a run file what recorder_write put there; with `at_mark` as it was at the mark, without
 * what was recorded since. EX_DATAERR, EX_SOFTWARE. */
int recorder_read(
	struct recorder *recorder, struct run_file *file, bool at_mark, struct error *err);

#endif
