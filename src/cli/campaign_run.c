/* talus campaign run: what is told on the way and at the end. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/campaign.h"

enum { LOG_LINES = 5 };

/* What the progress line needs to know of the past. */
struct progress {
	bool terminal;
	double began;      /* wall clock, s */
	double done_began; /* work that was done then */
};

static size_t count_ended(const struct campaign *campaign)
{
	return campaign_count(campaign, TASK_COMPLETE) + campaign_count(campaign, TASK_FAILED);
}

/* How the task ended, in words: "complete", "failed". */
static const char *task_word(const struct task *task)
{
	switch (task->state) {
	case TASK_COMPLETE:
		return "complete";
	case TASK_FAILED:
		return "failed";
	case TASK_INTERRUPTED:
		return "interrupted";
	case TASK_RUNNING:
	case TASK_ELSEWHERE:
		return "running";
	case TASK_QUEUED:
		return "queued";
	case TASK_WAITING:
		break;
	}
	return "waiting";
}

static void tell_tick(void *context, const struct campaign *campaign)
{
	const struct progress *progress = context;
	size_t elsewhere = campaign_count(campaign, TASK_ELSEWHERE);
	double done, all, left;
	char span[CLOCK_SPAN_SIZE];

	if (!progress->terminal)
		return;
	campaign_work(campaign, &done, &all);
	left = (all - done) * (clock_wall() - progress->began) / (done - progress->done_began);
	(void)fprintf(stderr, "\r\033[K%zu/%zu runs, %zu running", count_ended(campaign),
		campaign->experiment->run_count, campaign_count(campaign, TASK_RUNNING));
	if (elsewhere)
		(void)fprintf(stderr, ", %zu elsewhere", elsewhere);
	(void)fprintf(stderr, ", %.0f %%", all > 0 ? floor(100 * done / all) : 100);
	if (campaign->stopping)
		(void)fprintf(stderr, ", stopping");
	else if (isfinite(left) && left >= 0)
		(void)fprintf(stderr, ", %s left", clock_span(left, span));
	(void)fflush(stderr);
}

static void tell_ended(void *context, const struct campaign *campaign, const struct task *task)
{
	const struct progress *progress = context;
	char span[CLOCK_SPAN_SIZE];

	if (progress->terminal) {
		tell_tick(context, campaign);
		return;
	}
	(void)printf("%zu/%zu %s: %s, %s CPU\n", count_ended(campaign), campaign->experiment->run_count,
		task->run->id, task_word(task), clock_span(task->report.cpu_seconds, span));
	(void)fflush(stdout);
}

/* The lines of `log`, set off from what we say ourselves. */
static void print_log(const char *log)
{
	while (*log) {
		int length = (int)strcspn(log, "\n");

		(void)fprintf(stderr, "  %.*s\n", length, log);
		log += length + (log[length] == '\n');
	}
}

/* A failed run and the end of its log, which has the reason; without a log, the reason. */
static void tell_failure(const struct task *task)
{
	struct text log = {0};

	(void)fprintf(stderr, "talus: run %s failed", task->run->id);
	if (task->code > 128)
		(void)fprintf(stderr, " (signal %d: %s)", task->code - 128, strsignal(task->code - 128));
	else if (task->code)
		(void)fprintf(stderr, " (exit code %d)", task->code);
	campaign_log_end(task->run, LOG_LINES, &log);
	if (log.length) {
		(void)fprintf(stderr, "; the end of %s/run.log:\n", task->run->folder);
		print_log(text_string(&log));
	} else {
		(void)fprintf(stderr, ": %s\n", task->report.reason);
	}
	text_clean(&log);
}

static void tell_counts(const struct campaign *campaign, struct text *out)
{
	const struct experiment *experiment = campaign->experiment;
	size_t failed = campaign_count(campaign, TASK_FAILED);
	size_t queued = campaign_count(campaign, TASK_QUEUED);
	size_t ended = count_ended(campaign) + queued;

	text_addf(out, "%zu run%s in %s: %zu complete", experiment->run_count,
		experiment->run_count == 1 ? "" : "s", experiment->folder,
		campaign_count(campaign, TASK_COMPLETE));
	if (failed)
		text_addf(out, ", %zu failed", failed);
	if (queued)
		text_addf(out, ", %zu in the queue", queued);
	if (ended < experiment->run_count)
		text_addf(out, ", %zu unfinished", experiment->run_count - ended);
	text_add(out, "\n");
}

static int tell_result(const struct campaign *campaign)
{
	struct text out = {0};
	int code = campaign_code(campaign), printed;

	tell_counts(campaign, &out);
	printed = command_print(&out);
	for (size_t i = 0; i < campaign->experiment->run_count; i++)
		if (campaign->tasks[i].state == TASK_FAILED)
			tell_failure(&campaign->tasks[i]);
	if (code == EX_INTERRUPTED)
		(void)fprintf(stderr, "talus: stopped; the same command goes on from there\n");
	return code ? code : printed;
}

static void tell_line(void *context, const char *line)
{
	(void)context;
	(void)printf("%s\n", line);
	(void)fflush(stdout);
}

static int execute(struct campaign *campaign, const struct executor *executor)
{
	struct progress progress = {isatty(STDERR_FILENO), clock_wall(), 0};
	struct error err = {0};
	double all;
	int result;

	campaign_work(campaign, &progress.done_began, &all);
	campaign->watch = (struct campaign_watch){tell_ended, tell_tick, tell_line, &progress};
	result = campaign_execute(campaign, executor, &err);
	if (progress.terminal)
		(void)fprintf(stderr, "\r\033[K");
	return result ? command_fail(&err) : tell_result(campaign);
}

static void tell_aside(void *context, const char *line)
{
	(void)context;
	(void)fprintf(stderr, "talus: %s\n", line);
}

/* What the executor would hand over, alone on stdout. */
static int print_handover(struct campaign *campaign, const struct executor *executor)
{
	struct text out = {0};
	struct error err = {0};

	campaign->watch.told = tell_aside;
	if (executor->plan(campaign, &out, &err)) {
		text_clean(&out);
		return command_fail(&err);
	}
	return command_print(&out);
}

/* What `run` would do with each run. */
static int print_plan(const struct campaign *campaign)
{
	struct text out = {0};

	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		const struct task *task = &campaign->tasks[i];
		const struct run_report *report = &task->report;

		text_addf(&out, "%s: ", task->run->id);
		if (task->state == TASK_COMPLETE)
			text_add(&out, "complete, nothing to do\n");
		else if (task->state == TASK_FAILED)
			text_add(&out, "failed, left as it is without --retry\n");
		else if (task->state == TASK_ELSEWHERE)
			text_add(&out, "another process works on it\n");
		else if (report->state == RUN_STATE_FAILED)
			text_add(&out, "failed, start anew\n");
		else if (report->state == RUN_STATE_PENDING)
			text_add(&out, "start\n");
		else
			text_addf(&out, "resume at %g s of %g s\n", report->time, task->run->config.time.end);
	}
	text_addf(
		&out, "%zu runs, %d at a time\n", campaign->experiment->run_count, campaign->options.jobs);
	return command_print(&out);
}

int campaign_run_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	const struct executor *executor = executor_find(arguments->executor);
	struct campaign campaign;
	struct error err = {0};
	int code;

	if (!executor)
		return command_usage(
			"campaign", "--executor %s: there are local and slurm", arguments->executor);
	if (campaign_create(&campaign, experiment, &arguments->options, &err))
		code = command_fail(&err);
	else if (!arguments->dry_run)
		code = execute(&campaign, executor);
	else
		code = executor->plan ? print_handover(&campaign, executor) : print_plan(&campaign);
	campaign_clean(&campaign);
	return code;
}
