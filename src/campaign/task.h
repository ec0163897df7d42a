/* One run of a campaign: its folder, its child, its end. */
#ifndef TALUS_TASK_H
#define TALUS_TASK_H

#include <signal.h>

#include "base/lock.h"
#include "talus/campaign.h"

/* The file in the experiment's folder whose change tells campaigns to stop: see campaign_cancel. */
#define CAMPAIGN_CANCEL "campaign.cancel"

/* Learn from the runs that are complete how long the others take. */
void campaign_calibrate(struct campaign *campaign);

/* Read the run's report into the task; a task that waits or is elsewhere changes its state with it. */
void task_look(const struct campaign *campaign, struct task *task);

/* The folder of the run that a run without a file begins with; NULL: it starts at 0. */
const char *task_from(const struct campaign *campaign, const struct task *task);

/* Is a run that its files call failed, or whose files are damaged, to forget them? */
bool task_may_begin_anew(const struct campaign *campaign, const struct task *task);

/* Make the run's folder with its config.yaml. EX_CANTCREAT, EX_IOERR. */
int task_write_config(const struct task *task, struct error *err);

/* Make the run's folder with its config.yaml, and start the child with the signal mask `mask`. The
 * child inherits `timing` (NULL: none), which thus is held until it ends. Returns -1 with `err` when
 * there is no child. */
int task_start(const struct campaign *campaign, struct task *task, const sigset_t *mask,
	const struct lock *timing, struct error *err);

/* Has the child ended? Then the task has its new state: that of waiting if it is to be tried again. */
bool task_reap(const struct campaign *campaign, struct task *task);

/* A run that could not write: is it the run's own folder, or the disk? On a disk that holds no more,
 * which is then the campaign's fault, the run is not to blame, and no try of it is used. */
void task_blame_disk(struct campaign *campaign, struct task *task);

/* Tell a child that has had its time to stop, and after a while without mercy. */
void task_watch_time(const struct campaign *campaign, struct task *task);

#endif
