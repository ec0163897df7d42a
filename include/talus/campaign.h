/* A campaign: the runs of an experiment, each brought to its end in a process of its own. */
#ifndef TALUS_CAMPAIGN_H
#define TALUS_CAMPAIGN_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "talus/error.h"
#include "talus/experiment.h"
#include "talus/run.h"
#include "talus/text.h"

enum task_state {
	TASK_WAITING,   /* for its turn */
	TASK_RUNNING,   /* in a child of ours */
	TASK_ELSEWHERE, /* another process works on it */
	TASK_COMPLETE,
	TASK_FAILED,
	TASK_INTERRUPTED, /* the same command goes on with it */
};

/* A run on its way. */
struct task {
	const struct experiment_run *run;
	enum task_state state;
	bool skipped;             /* complete or failed before this command */
	pid_t pid;                /* of the child while it runs */
	int code;                 /* exit code of the child, 128 + signal where one ended it */
	int refusals;             /* how often a child left because another process held the lock */
	struct run_report report; /* as last read */
};

struct campaign_options {
	int jobs;            /* children at a time; 0: as many as there are processors */
	bool retry;          /* start failed runs anew */
	const char *program; /* run as `program run FILE -o DIR --quiet`; NULL: this very program */
};

struct campaign;

/* Called as things happen; NULL: not. */
struct campaign_watch {
	void (*ended)(void *context, const struct campaign *campaign, const struct task *task);
	void (*tick)(void *context, const struct campaign *campaign); /* about twice a second */
	void *context;
};

struct campaign {
	const struct experiment *experiment;
	struct campaign_options options;
	struct campaign_watch watch;
	struct task *tasks; /* [experiment->run_count], in the order of the experiment */
	bool stopping;      /* a signal asked for it */
	struct error fault; /* of the disk: nothing more is started; code 0: there was none */
};

/* How runs are executed; a row of the table in executor.c. */
struct executor {
	const char *name;
	int (*execute)(struct campaign *campaign, struct error *err);
};

/* NULL if there is none of that name. */
const struct executor *executor_find(const char *name);

/* Look at every run: what is complete or failed, what is to be done. Changes nothing on disk. Clean
 * in every case. */
int campaign_create(struct campaign *campaign, const struct experiment *experiment,
	const struct campaign_options *options, struct error *err);

void campaign_clean(struct campaign *campaign);

/* Bring every run to its end. Failed runs do not stop the others; a disk that can hold no more does,
 * see `fault`. SIGINT, SIGTERM, SIGHUP and SIGUSR1
 * stop the children, whose checkpoints are waited for; a second SIGINT ends the wait. Returns 0 also
 * when runs failed: see the tasks and campaign_code. EX_CANTCREAT, EX_IOERR, EX_SOFTWARE. */
int campaign_execute(struct campaign *campaign, const struct executor *executor, struct error *err);

/* The exit code of the campaign: that of the fault beats EX_INTERRUPTED beats EX_IOERR and EX_CANTCREAT
 * (of one run's folder) beats EX_DATAERR (a run file) beats EX_FAILED beats 0. */
int campaign_code(const struct campaign *campaign);

size_t campaign_count(const struct campaign *campaign, enum task_state state);

/* Done and to do in the same unit: simulated time times cells times layers, over all runs. */
void campaign_work(const struct campaign *campaign, double *done, double *all);

/* The last `lines` lines of the run's log. */
void campaign_log_end(const struct experiment_run *run, int lines, struct text *out);

#endif
