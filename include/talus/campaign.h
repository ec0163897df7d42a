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
	TASK_QUEUED,    /* in the queue of a cluster, which brings it to its end */
	TASK_COMPLETE,
	TASK_FAILED,
	TASK_INTERRUPTED, /* the same command goes on with it */
	TASK_LEFT,        /* not asked for */
};

/* What the queue of a cluster says of a run. */
struct queue_entry {
	char job[32];     /* as the cluster's commands take it: "12_3"; "": not in the queue */
	char state[32];   /* "PENDING", "RUNNING", ... */
	char reason[128]; /* why it waits: "Resources" */
};

/* A run on its way. */
struct task {
	const struct experiment_run *run;
	enum task_state state;
	bool skipped;             /* complete or failed before this command */
	bool failed_before;       /* this command */
	int starts;               /* of a child, by this command */
	pid_t pid;                /* of the child while it runs */
	int code;                 /* exit code of the child, 128 + signal where one ended it */
	int refusals;             /* how often a child left because another process held the lock */
	double cost;              /* CPU seconds that the whole run is expected to take */
	double started;           /* when the child was, by clock_wall, s */
	bool timed_out;           /* and was told to stop */
	struct run_report report; /* as last read */
	size_t before; /* the run of this campaign that this one goes on from; SIZE_MAX: none */
	char *from;    /* folder of another run that it goes on from, owned; NULL: none */
	struct queue_entry queue; /* as campaign_ask_queue was last told */
};

struct campaign_options {
	int jobs;  /* children at a time; 0: as many as there are processors */
	int retry; /* a run that fails is started anew until it has failed this often, and once more */
	bool anew; /* what failed before this command does not count */
	double timeout;      /* wall clock that a child may take before it is told to stop, s; 0: any */
	int max_failures;    /* so many failed runs, and no more are started; 0: any */
	bool in_order;       /* of the experiment; else the longest expected run first */
	const char *program; /* run as `program run FILE -o DIR --quiet`; NULL: this very program */
};

struct campaign;

/* Called as things happen; NULL: not. */
struct campaign_watch {
	/* a run is over, or waits to be tried again: its report says why */
	void (*ended)(void *context, const struct campaign *campaign, const struct task *task);
	void (*tick)(void *context, const struct campaign *campaign); /* about twice a second */
	void (*told)(void *context, const char *line); /* what an executor says: a job's number */
	void *context;
};

struct campaign {
	const struct experiment *experiment;
	struct campaign_options options;
	struct campaign_watch watch;
	struct task *tasks; /* [experiment->run_count], in the order of the experiment */
	double scale;       /* CPU seconds of the runs that are complete, by those that were expected */
	bool stopping;      /* a signal or `campaign_cancel` asked for it */
	bool gave_up;       /* max_failures runs have failed */
	struct error
		fault;      /* of the disk or of memory: nothing more is started; code 0: there was none */
	int jobs_asked; /* options.jobs before it got its default */
};

/* How runs are executed; a row of the table in executor.c. */
struct executor {
	const char *name;

	/* Bring every task to its end, or into a queue that does so. */
	int (*execute)(struct campaign *campaign, struct error *err);

	/* Add what execute would hand over, such as a batch script, to `out`, and change nothing; NULL:
	 * the states of the tasks say it all. */
	int (*plan)(struct campaign *campaign, struct text *out, struct error *err);

	/* Fill entries[experiment->run_count], all zeros before, for runs that are in the queue. Silent
	 * and quick for an experiment that was never handed over. NULL: there is no queue. */
	int (*queue)(
		const struct experiment *experiment, struct queue_entry *entries, struct error *err);

	/* Take the runs with chosen[i] (NULL: all) back from the queue, and count them; those that compute
	 * write their checkpoints and stop. NULL: there is no queue. */
	int (*cancel)(
		const struct experiment *experiment, const bool *chosen, size_t *count, struct error *err);
};

/* NULL if there is none of that name. */
const struct executor *executor_find(const char *name);

/* Ask the queues of all executors: see struct executor. EX_UNAVAILABLE. */
int executor_queue(
	const struct experiment *experiment, struct queue_entry *entries, struct error *err);

/* Take all runs back from the queues of all executors, and count them: see struct executor.
 * EX_UNAVAILABLE; EX_INTERRUPTED: somebody is handing over runs just now. */
int executor_cancel(const struct experiment *experiment, size_t *count, struct error *err);

/* Look at every run: what is complete or failed, what is to be done. Changes nothing on disk. Clean
 * in every case. */
int campaign_create(struct campaign *campaign, const struct experiment *experiment,
	const struct campaign_options *options, struct error *err);

void campaign_clean(struct campaign *campaign);

/* Leave out all runs but those that failed and are among `names` (RUN-IDs, their beginnings, or the
 * digits of their hashes; none: all that failed). EX_DATAERR: a name fits no run, or several. */
int campaign_select_failed(
	struct campaign *campaign, char *const *names, int count, struct error *err);

/* The run of that name, as above. EX_DATAERR. */
int campaign_find_run(
	const struct experiment *experiment, const char *name, size_t *index, struct error *err);

/* Bring every run to its end. Failed runs do not stop the others, up to max_failures; a disk that can
 * hold no more does, see `fault`. A run that differs from another only by a later time.end goes on from
 * that one. SIGINT, SIGTERM, SIGHUP and SIGUSR1
 * stop the children, whose checkpoints are waited for; a second SIGINT ends the wait. Returns 0 also
 * when runs failed: see the tasks and campaign_code. EX_CANTCREAT, EX_IOERR, EX_SOFTWARE. */
int campaign_execute(struct campaign *campaign, const struct executor *executor, struct error *err);

/* Look again at the runs that are not complete, as somebody who works on none of them. */
void campaign_look(struct campaign *campaign);

/* Ask the queues of all executors what they know of the tasks: see executor_queue. */
int campaign_ask_queue(struct campaign *campaign, struct error *err);

/* The exit code of the campaign: that of the fault beats EX_INTERRUPTED beats EX_IOERR and EX_CANTCREAT
 * (of one run's folder) beats EX_DATAERR (a run file) beats EX_FAILED beats 0; one that gave up has
 * failed. A run in a queue needs nobody to go on with it. */
int campaign_code(const struct campaign *campaign);

size_t campaign_count(const struct campaign *campaign, enum task_state state);

/* Done and to do in CPU seconds, as expected from the models and from what has run. */
void campaign_work(const struct campaign *campaign, double *done, double *all);

/* CPU seconds that are left of a run. */
double campaign_task_left(const struct campaign *campaign, const struct task *task);

/* Ask every campaign command that works in the folder of this experiment, on whatever machine, to stop
 * as by SIGTERM. EX_CANTCREAT, EX_IOERR. */
int campaign_cancel(const struct experiment *experiment, struct error *err);

/* The last `lines` lines of the run's log. */
void campaign_log_end(const struct experiment_run *run, int lines, struct text *out);

#endif
