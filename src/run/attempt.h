/* One attempt at a run: what its parts share from taking the lock to leaving it. */
#ifndef TALUS_ATTEMPT_H
#define TALUS_ATTEMPT_H

#include <stdint.h>

#include "base/clock.h"
#include "run/recorder.h"
#include "talus/model.h"
#include "talus/run.h"
#include "talus/run_file.h"

/* The state before the first step that time.end shortened. */
struct attempt_mark {
	double *values; /* of the model's arrays, one after another; NULL: there was no such step yet */
	uint64_t step;
	double time; /* simulated, s */
	double cpu;  /* of all attempts until then, s */
};

struct attempt {
	const struct model *model;
	const struct config *config;
	const char *folder;
	const struct run_options *options;
	const struct lock *lock; /* of run.lock; NULL: this folder has no other users */

	struct model_state *state;
	struct recorder *recorder;
	uint64_t step; /* steps done */
	double time;   /* simulated, s */
	struct attempt_mark mark;

	char config_hash[CONFIG_HASH_SIZE];
	char created[CLOCK_STAMP_SIZE]; /* when the run was begun */
	int number;                     /* of this attempt, from 1 */
	double cpu_before;              /* of earlier attempts, up to the checkpoint taken up, s */
	double cpu_begin;               /* of the process when this attempt began, s */
	bool keep_newest;               /* run.h5 is good, and is kept as the previous generation */

	double rate_wall, rate_time; /* the last tick, for the time left */
	double wall_sum, time_sum;   /* passed since this attempt began; what is older counts less */
	double status_due, progress_due; /* moments on the wall clock */
	bool status_failed;              /* a status could not be written, and that was told */
	struct text ended;               /* how the attempts before this one ended, line by line */
	int failures;                    /* how many of them failed */
};

double attempt_cpu(const struct attempt *attempt);       /* of all attempts, s */
double attempt_wall_left(const struct attempt *attempt); /* estimate, s; NaN: unknown */

/* A line for people, if they want to hear that voice. */
void attempt_say(const struct attempt *attempt, enum run_voice voice, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

/* A line for run.log, with time and attempt. A log that cannot be written stops nobody. */
void attempt_log(const struct attempt *attempt, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* Called after each step: progress and status.yaml, where they are due. */
void attempt_tick(struct attempt *attempt);

#endif
