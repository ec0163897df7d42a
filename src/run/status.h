/* status.yaml: progress, attempts and reasons, for people and for `talus campaign status`. */
#ifndef TALUS_STATUS_H
#define TALUS_STATUS_H

#include "run/attempt.h"

/* A status that cannot be written is told once and otherwise does not matter. */
void status_write(struct attempt *attempt, enum run_state state, const char *reason);

/* Take up what status.yaml tells of the attempts before this one. An attempt that it still calls running
 * ended without a word. EX_SOFTWARE. */
int status_read_past(struct attempt *attempt, struct error *err);

/* Note how this attempt ends, before the last status_write. */
void status_note_end(struct attempt *attempt, enum run_state state, const char *reason);

/* What status.yaml of `folder` says into `report` (its state aside). False when there is none that
 * can be read; `report` is then unchanged. */
bool status_read(const char *folder, struct run_report *report);

#endif
