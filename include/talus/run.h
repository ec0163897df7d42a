/* A run's life in its folder: start, resume, stop, fail, complete. */
#ifndef TALUS_RUN_H
#define TALUS_RUN_H

#include <stdbool.h>

#include "talus/config.h"
#include "talus/error.h"
#include "talus/text.h"

enum run_voice {
	RUN_VOICE_RESULT,   /* one line: how it ended */
	RUN_VOICE_WARNING,  /* one line: what is not as it should be, and is dealt with */
	RUN_VOICE_PROGRESS, /* how far it is, to be written over; at most 5 a second; "" at the end */
};

struct run_options {
	bool progress; /* tell progress */
	bool quiet;    /* do not tell results */
	bool retry;    /* start a failed run anew */
	/* Folder of a run that differs only by an earlier time.end: where the run's own folder has no run
	 * file yet, it goes on from there. NULL: none. */
	const char *from;
	/* Told every line meant for people; NULL: nobody is. */
	void (*say)(enum run_voice voice, const char *line);
};

/* Bring the run in `folder` (made when missing) to its end: start, resume, or find it complete, and
 * hold its lock meanwhile. A run there that differs only by an earlier time.end is a beginning of this
 * one: it is gone on from, and if it was finished, stays as run.end-SECONDS.h5. Returns 0 when the run is complete. Codes: EX_FAILED, EX_DATAERR (files
 * damaged, or made from another config or numerics version: names the keys), EX_CANTCREAT, EX_IOERR,
 * EX_SOFTWARE, EX_INTERRUPTED (stopped by a signal with a checkpoint written, or locked by another
 * process). */
int run_execute(const struct config *config, const char *folder, const struct run_options *options,
	struct error *err);

enum run_state {
	RUN_STATE_PENDING,     /* no run file */
	RUN_STATE_RUNNING,     /* its lock is held */
	RUN_STATE_INTERRUPTED, /* begun, lock free */
	RUN_STATE_COMPLETE,
	RUN_STATE_FAILED,
	RUN_STATE_DAMAGED /* no generation of its run file is good */
};

struct run_report {
	enum run_state state;
	double time, end;   /* simulated, s */
	double wall_left;   /* estimated seconds to the end, NaN: unknown */
	double cpu_seconds; /* so far, all attempts */
	int attempts;
	int failures;      /* attempts that failed, as far as is known */
	bool blocked;      /* damaged by what lies in the place of a folder or file: not for --retry */
	bool unknown;      /* memory ran out: nothing here is to be relied on */
	char reason[1024]; /* why it failed or stopped, "" if it did not */
};

/* What state the run in `folder` is in. Never takes a lock, never changes anything, and never fails:
 * what cannot be read is told in `reason`. A `folder` that is missing is pending. */
void run_report_read(const char *folder, struct run_report *report);

/* How the attempts at the run in `folder` ended, the latest of them, a line for each. */
void run_report_history(const char *folder, struct text *out);

const char *run_state_name(enum run_state state);

#endif
