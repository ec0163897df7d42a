#include "campaign/local.h"

#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/clock.h"
#include "base/file.h"
#include "campaign/order.h"
#include "campaign/task.h"

struct pool {
	struct campaign *campaign;
	sigset_t signals, before; /* blocked while the pool works, and what was blocked before it */
	struct text timing;       /* lock file of timing experiments; empty: none is needed */
	struct task **order;      /* [runs], in which they are started */
	struct text cancel;       /* path of the file that tells to stop, and what it was at first */
	struct stat cancelled;
	double looked; /* when the reports were last read, s */
};

static void tell_end(const struct pool *pool, const struct task *task)
{
	const struct campaign_watch *watch = &pool->campaign->watch;

	if (watch->ended)
		watch->ended(watch->context, pool->campaign, task);
}

static size_t task_count(const struct pool *pool)
{
	return pool->campaign->experiment->run_count;
}

static bool is_over(const struct task *task)
{
	return task->state == TASK_COMPLETE || task->state == TASK_FAILED ||
		   task->state == TASK_INTERRUPTED;
}

/* No more runs are to be started. */
static bool is_stopped(const struct campaign *campaign)
{
	return campaign->stopping || campaign->gave_up || campaign->fault.code;
}

static void reap(struct pool *pool)
{
	for (size_t i = 0; i < task_count(pool); i++) {
		struct task *task = &pool->campaign->tasks[i];

		if (task->state != TASK_RUNNING || !task_reap(pool->campaign, task))
			continue;
		if (task->report.unknown) {
			error_memory(&pool->campaign->fault, sizeof task->report);
			task->state = TASK_INTERRUPTED;
		}
		task_blame_disk(pool->campaign, task);
		if (task->state == TASK_COMPLETE)
			campaign_calibrate(pool->campaign);
		if (is_over(task) || task->state == TASK_WAITING)
			tell_end(pool, task);
	}
}

/* The failed runs of this command. */
static void count_failures(struct pool *pool)
{
	struct campaign *campaign = pool->campaign;
	int failures = 0;

	for (size_t i = 0; i < task_count(pool); i++)
		failures += campaign->tasks[i].state == TASK_FAILED && !campaign->tasks[i].skipped;
	if (campaign->options.max_failures && failures >= campaign->options.max_failures)
		campaign->gave_up = true;
}

/* The lock under which timed runs take turns, over all campaigns in this folder. */
static bool take_turn(struct pool *pool, struct lock *timing, struct error *err)
{
	timing->fd = -1;
	if (!pool->timing.length)
		return true;
	if (!lock_take(timing, pool->timing.data, err))
		return true;
	if (err->code == EX_INTERRUPTED)
		*err = (struct error){0}; /* another's turn */
	return false;
}

/* A run whose folder cannot be made fails alone; without memory or processes nothing goes on. */
static void fail_start(struct pool *pool, struct task *task, struct error *err)
{
	if (err->code != EX_CANTCREAT && err->code != EX_IOERR)
		return;
	task->state = TASK_FAILED;
	task->code = err->code;
	(void)error_format(err, task->report.reason, sizeof task->report.reason);
	*err = (struct error){0};
	task_blame_disk(pool->campaign, task);
	tell_end(pool, task);
}

/* A run that goes on from another waits for that one. */
static bool is_ready(const struct pool *pool, const struct task *task)
{
	const struct task *before =
		task->before == SIZE_MAX ? NULL : &pool->campaign->tasks[task->before];

	return !before || task->report.state != RUN_STATE_PENDING ||
		   (before->state != TASK_WAITING && before->state != TASK_RUNNING &&
			   before->state != TASK_ELSEWHERE);
}

/* Start one waiting task. False: there is none, or now is not the time. */
static bool start_next(struct pool *pool, struct error *err)
{
	struct lock timing;
	bool started = false;

	for (size_t i = 0; !started && i < task_count(pool); i++) {
		struct task *task = pool->order[i];

		if (task->state != TASK_WAITING || !is_ready(pool, task))
			continue;
		if (!take_turn(pool, &timing, err))
			return false;
		/* another campaign may have been here since we looked */
		task_look(pool->campaign, task);
		if (is_over(task))
			tell_end(pool, task);
		else if (task->state == TASK_WAITING &&
				 task_start(pool->campaign, task, &pool->before, &timing, err))
			fail_start(pool, task, err);
		started = task->state == TASK_RUNNING;
		lock_release(&timing); /* the child has its own hold on it */
		if (err->code)
			return false;
	}
	return started;
}

static void start(struct pool *pool, struct error *err)
{
	const struct campaign *campaign = pool->campaign;

	while (!is_stopped(campaign) && !err->code &&
		   campaign_count(campaign, TASK_RUNNING) < (size_t)campaign->options.jobs &&
		   start_next(pool, err))
		;
}

static void stop(struct pool *pool)
{
	pool->campaign->stopping = true;
	for (size_t i = 0; i < task_count(pool); i++)
		if (pool->campaign->tasks[i].state == TASK_RUNNING)
			(void)kill(pool->campaign->tasks[i].pid, SIGTERM);
}

/* Has somebody asked all campaigns here to stop, since this one began? The file is compared with what it
 * was, not its time with ours: no clock is trusted. */
static bool is_cancelled(const struct pool *pool)
{
	struct stat now = {0};

	(void)stat(text_string(&pool->cancel), &now);
	return now.st_ino && (now.st_ino != pool->cancelled.st_ino ||
							 now.st_mtim.tv_sec != pool->cancelled.st_mtim.tv_sec ||
							 now.st_mtim.tv_nsec != pool->cancelled.st_mtim.tv_nsec);
}

/* About twice a second: how far the children are, and what became of the runs of others. */
static void look(struct pool *pool)
{
	const struct campaign_watch *watch = &pool->campaign->watch;

	if (clock_wall() - pool->looked < 0.5)
		return;
	pool->looked = clock_wall();
	if (!pool->campaign->stopping && is_cancelled(pool))
		stop(pool);
	for (size_t i = 0; i < task_count(pool); i++) {
		struct task *task = &pool->campaign->tasks[i];

		if (task->state != TASK_RUNNING && task->state != TASK_ELSEWHERE)
			continue;
		task_watch_time(pool->campaign, task);
		task_look(pool->campaign, task);
		if (is_over(task))
			tell_end(pool, task);
	}
	if (watch->tick)
		watch->tick(watch->context, pool->campaign);
}

/* Wait for a child, a signal, or the next look. False: leave at once. */
static bool wait_a_while(struct pool *pool)
{
	const struct timespec pause = {.tv_nsec = 250000000};
	int number = sigtimedwait(&pool->signals, NULL, &pause);

	if (number < 0 || number == SIGCHLD)
		return true;
	if (number == SIGINT && pool->campaign->stopping)
		return false;
	stop(pool);
	return true;
}

static bool is_work_left(const struct pool *pool, const struct error *err)
{
	const struct campaign *campaign = pool->campaign;

	if (campaign_count(campaign, TASK_RUNNING))
		return true;
	return !is_stopped(campaign) && !err->code &&
		   (campaign_count(campaign, TASK_WAITING) || campaign_count(campaign, TASK_ELSEWHERE));
}

static void pool_clean(struct pool *pool)
{
	free(pool->order);
	text_clean(&pool->timing);
	text_clean(&pool->cancel);
}

static int pool_init(struct pool *pool, struct campaign *campaign, struct error *err)
{
	static const int numbers[] = {SIGCHLD, SIGINT, SIGTERM, SIGHUP, SIGUSR1};

	*pool = (struct pool){.campaign = campaign, .looked = clock_wall()};
	(void)sigemptyset(&pool->signals);
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
		(void)sigaddset(&pool->signals, numbers[i]);
	/* Threads of a run that have nothing to do sleep: their processor may be another run's. */
	(void)setenv("OMP_WAIT_POLICY", "passive", false);
	if (campaign->experiment->timing)
		TRY(file_path(&pool->timing, campaign->experiment->folder, "timing.lock", err));
	TRY(file_path(&pool->cancel, campaign->experiment->folder, CAMPAIGN_CANCEL, err));
	(void)stat(text_string(&pool->cancel), &pool->cancelled);
	pool->order = campaign_order(campaign, err);
	if (!pool->order)
		return -1;
	if (sigprocmask(SIG_BLOCK, &pool->signals, &pool->before) != 0)
		return error_set(err, EX_SOFTWARE, "cannot block signals: %s", strerror(errno));
	return 0;
}

int local_execute(struct campaign *campaign, struct error *err)
{
	struct pool pool;

	if (pool_init(&pool, campaign, err)) {
		pool_clean(&pool);
		return -1;
	}
	for (bool stay = true; stay && is_work_left(&pool, err);) {
		start(&pool, err);
		if (campaign_count(campaign, TASK_RUNNING) || is_work_left(&pool, err))
			stay = wait_a_while(&pool);
		reap(&pool);
		count_failures(&pool);
		look(&pool);
	}
	(void)sigprocmask(SIG_SETMASK, &pool.before, NULL);
	pool_clean(&pool);
	return err->code ? -1 : 0;
}
