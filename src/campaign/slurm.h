/* The executor of clusters that run Slurm: the runs become the tasks of job arrays.
 *
 * What lies in <folder of the run folders>/slurm: per array NAME.sh, the batch script; NAME.runs, a
 * line for each task: the folder of its run, and after tabs what more `talus run` is told; NAME.log,
 * what Slurm says of its tasks. NAME is the name of the job as well, so that the queue alone tells
 * which tasks it holds: nothing is recorded after the submission that a crash could lose, and no
 * accounting is asked. */
#ifndef TALUS_SLURM_H
#define TALUS_SLURM_H

#include "campaign/reader.h"
#include "talus/campaign.h"

#define SLURM_FOLDER "slurm"

enum {
	SLURM_GRACE = 60,        /* s */
	SLURM_NAME_SIZE = 64,    /* of the name of a job */
	SLURM_PATIENCE = 60,     /* for an answer of Slurm's commands, s */
	SLURM_ARRAY_SIZE = 1001, /* tasks in an array at most, where the cluster does not say */
	SLURM_JOB_SIZE = 16,
	SLURM_KEYS = 6
};

/* The section `slurm:` of an experiment. Its words end up in a batch script: only what Slurm itself could
 * mean is let through. */
extern const struct reader_key slurm_keys[SLURM_KEYS];
int slurm_read(
	const struct reader *reader, const struct node *node, struct experiment_slurm *slurm);

/* A job array, as its script needs to know it. */
struct slurm_array {
	const struct experiment_slurm *section;
	char name[SLURM_NAME_SIZE];
	const char *folder;  /* absolute, of the run folders */
	const char *program; /* absolute */
	size_t first, count; /* of the submission's runs: those of this array */
	int throttle;        /* tasks at a time; 0: no limit of ours */
};

/* "0-99%20", for --array. */
void slurm_script_range(const struct slurm_array *array, struct text *out);
void slurm_script_write(const struct slurm_array *array, struct text *out);

/* Is Slurm there? EX_UNAVAILABLE. */
int slurm_check(struct error *err);

/* How many tasks the cluster lets an array have. */
int slurm_array_size(size_t *size, struct error *err);

/* Write the script of an array and its list of runs, and submit it, to begin when the arrays `after`
 * (":12:13", empty: none) have ended. `job` is its number. EX_CANTCREAT, EX_IOERR, EX_UNAVAILABLE. */
int slurm_submit(const struct slurm_array *array, const struct text *runs, const struct text *after,
	char job[static SLURM_JOB_SIZE], struct error *err);

/* The folder of a run as the lists of runs name it. */
const char *slurm_run_name(const char *folder);

/* Rows of the executors' table: see struct executor. */
int slurm_execute(struct campaign *campaign, struct error *err);
int slurm_plan(struct campaign *campaign, struct text *out, struct error *err);
int slurm_queue(
	const struct experiment *experiment, struct queue_entry *entries, struct error *err);
int slurm_cancel(
	const struct experiment *experiment, const bool *chosen, size_t *count, struct error *err);

/* Take the lock under which arrays are submitted and taken back. EX_INTERRUPTED: another has it. */
struct lock;
int slurm_lock(const struct experiment *experiment, struct lock *lock, struct error *err);

#endif
