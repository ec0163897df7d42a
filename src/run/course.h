/* What is to be done in a run folder, by what lies there. */
#ifndef TALUS_COURSE_H
#define TALUS_COURSE_H

#include "run/attempt.h"

enum course {
	COURSE_START,    /* at 0 */
	COURSE_RESUME,   /* from the checkpoint of this very run */
	COURSE_CONTINUE, /* from the state that a run with an earlier end has left for this */
	COURSE_NOTHING   /* it is complete */
};

/* With all but COURSE_START `*file` is then open, and the attempt has the run's past. EX_DATAERR: the folder
 * holds another run, or no good file; EX_FAILED: the run failed, and is not to be retried. */
int course_find(
	struct attempt *attempt, struct run_file **file, enum course *course, struct error *err);

#endif
