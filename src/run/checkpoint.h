/* An attempt's state into a run file and back. */
#ifndef TALUS_CHECKPOINT_H
#define TALUS_CHECKPOINT_H

#include "run/attempt.h"

/* Write run.h5, keeping the generation before it. EX_CANTCREAT, EX_IOERR, EX_SOFTWARE. */
int checkpoint_write(struct attempt *attempt, enum run_status status, struct error *err);

/* Before the first step that time.end shortens: remember the state, which every later file then holds
 * as /checkpoint/continuation. EX_SOFTWARE. */
int checkpoint_mark(struct attempt *attempt, struct error *err);

/* Take up model, recorder, step and time from a run file. EX_DATAERR, EX_SOFTWARE. */
int checkpoint_read(struct attempt *attempt, struct run_file *file, struct error *err);

/* The same from the file of a run with an earlier end, as of before that end made a difference. */
int checkpoint_continue(struct attempt *attempt, struct run_file *file, struct error *err);

/* Write the newest good generation again with the same content, but known as failed for `reason`. */
int checkpoint_fail(struct attempt *attempt, const char *reason, struct error *err);

#endif
