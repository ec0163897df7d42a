/* From the present state of an attempt to the end of its run. */
#ifndef TALUS_LOOP_H
#define TALUS_LOOP_H

#include "run/attempt.h"

/* Step, record and checkpoint until the end of the run, whose file is then complete. EX_FAILED: the
 * numbers are no flow, and the last good checkpoint stays. EX_INTERRUPTED: asked to stop, with a
 * checkpoint written. EX_CANTCREAT, EX_IOERR, EX_SOFTWARE. */
int loop_run(struct attempt *attempt, struct error *err);

#endif
