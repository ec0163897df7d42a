/* talus campaign run: what is told on the way and at the end. */
#include <math.h>
#include <stdint.h>
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
	case TASK_LEFT:
		return "left";
	case TASK_WAITING:
		break;
	}
	return "waiting";
}

/* Wall clock to the end, s: by what was done since `began` once that is a good part, before that by the
 * CPU time that is expected to be left. */
double campaign_left(const struct campaign *campaign, double began, double done_began)
{
	double done, all, left, longest = 0, by_cost, passed = clock_wall() - began;
	size_t waiting = campaign_count(campaign, TASK_WAITING), going;

	campaign_work(campaign, &done, &all);
	left = all - done;
	for (size_t i = 0; i < campaign->experiment->run_count; i++)
		longest = fmax(longest, campaign_task_left(campaign, &campaign->tasks[i]));
	going = campaign_count(campaign, TASK_RUNNING) + campaign_count(campaign, TASK_ELSEWHERE);
	if (going + waiting > (size_t)campaign->options.jobs && going < (size_t)campaign->options.jobs)
		going = (size_t)campaign->options.jobs;
	by_cost = fmax(left / (double)(going ? going : 1), longest);
	if (passed < 5 || done - done_began < 0.1 * left)
		return by_cost;
	return fmax(left * passed / (done - done_began), 0);
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
	left = campaign_left(campaign, progress->began, progress->done_began);
	(void)fprintf(stderr, "\r\033[K%zu/%zu runs, %zu running", count_ended(campaign),
		campaign->experiment->run_count - campaign_count(campaign, TASK_LEFT),
		campaign_count(campaign, TASK_RUNNING));
	if (elsewhere)
		(void)fprintf(stderr, ", %zu elsewhere", elsewhere);
	(void)fprintf(stderr, ", %.0f %%", all > 0 ? floor(100 * done / all + 1e-9) : 100);
	if (campaign->stopping)
		(void)fprintf(stderr, ", stopping");
	else if (isfinite(left) && left >= 0)
		(void)fprintf(stderr, ", %s left", clock_span(left, span));
	(void)fflush(stderr);
}

enum { ENDED_SIZE = 80 };

/* "exit code 74", "signal 11: Segmentation fault" */
static const char *how_ended(const struct task *task, char text[ENDED_SIZE])
{
	if (task->code > 128)
		(void)snprintf(
			text, ENDED_SIZE, "signal %d: %s", task->code - 128, strsignal(task->code - 128));
	else
		(void)snprintf(text, ENDED_SIZE, "exit code %d", task->code);
	return text;
}

static void tell_ended(void *context, const struct campaign *campaign, const struct task *task)
{
	const struct progress *progress = context;
	char span[CLOCK_SPAN_SIZE], text[ENDED_SIZE];

	if (task->state == TASK_WAITING) { /* on a terminal, too: it must not be lost */
		(void)fprintf(stderr, "%stalus: run %s ended early (%s) and is tried again, %d of %d\n",
			progress->terminal ? "\r\033[K" : "", task->run->id,
			*task->report.reason ? task->report.reason : how_ended(task, text), task->starts,
			campaign->options.retry);
		return;
	}
	if (progress->terminal) {
		tell_tick(context, campaign);
		return;
	}
	(void)printf("%zu/%zu %s: %s, %s CPU\n", count_ended(campaign),
		campaign->experiment->run_count - campaign_count(campaign, TASK_LEFT), task->run->id,
		task_word(task), clock_span(task->report.cpu_seconds, span));
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
	char text[ENDED_SIZE];

	(void)fprintf(stderr, "talus: run %s %s", task->run->id,
		task->state == TASK_FAILED ? "failed" : "could not write");
	if (task->report.state == RUN_STATE_DAMAGED && !task->starts && !task->report.blocked) {
		(void)fprintf(stderr, ": %s; `retry` starts it anew\n", task->report.reason);
		return;
	}
	if (task->code)
		(void)fprintf(stderr, " (%s)", how_ended(task, text));
	campaign_log_end(task->run, LOG_LINES, &log);
	if (log.length) {
		(void)fprintf(stderr, "; the end of %s/run.log:\n", task->run->folder);
		print_log(text_string(&log));
	} else {
		(void)fprintf(stderr, "%s%s\n", *task->report.reason ? ": " : "", task->report.reason);
	}
	text_clean(&log);
}

static bool is_told(const struct task *task)
{
	return task->state == TASK_FAILED ||
		   (task->state == TASK_INTERRUPTED &&
			   (task->code == EX_IOERR || task->code == EX_CANTCREAT));
}

static void tell_counts(const struct campaign *campaign, struct text *out)
{
	const struct experiment *experiment = campaign->experiment;
	size_t runs = experiment->run_count - campaign_count(campaign, TASK_LEFT);
	size_t failed = campaign_count(campaign, TASK_FAILED);
	size_t queued = campaign_count(campaign, TASK_QUEUED);
	size_t ended = count_ended(campaign) + queued;

	text_addf(out, "%zu run%s in %s: %zu complete", runs, runs == 1 ? "" : "s", experiment->folder,
		campaign_count(campaign, TASK_COMPLETE));
	if (failed)
		text_addf(out, ", %zu failed", failed);
	if (queued)
		text_addf(out, ", %zu in the queue", queued);
	if (ended < runs)
		text_addf(out, ", %zu unfinished", runs - ended);
	text_add(out, "\n");
}

static int tell_result(const struct campaign *campaign)
{
	struct text out = {0};
	char message[sizeof campaign->fault.text + sizeof campaign->fault.file];
	int code = campaign_code(campaign), printed;

	tell_counts(campaign, &out);
	printed = command_print(&out);
	for (size_t i = 0; i < campaign->experiment->run_count; i++)
		if (is_told(&campaign->tasks[i]))
			tell_failure(&campaign->tasks[i]);
		else if (campaign->tasks[i].timed_out && campaign->tasks[i].state == TASK_INTERRUPTED)
			(void)fprintf(stderr, "talus: run %s: %s at t = %g s\n", campaign->tasks[i].run->id,
				campaign->tasks[i].report.reason, campaign->tasks[i].report.time);
		else if (campaign->tasks[i].state == TASK_COMPLETE && *campaign->tasks[i].report.reason)
			(void)fprintf(stderr, "talus: warning: run %s: %s\n", campaign->tasks[i].run->id,
				campaign->tasks[i].report.reason);
	if (campaign->fault.code)
		(void)fprintf(stderr, "talus: %s; nothing more was started, and the same command goes on\n",
			error_format(&campaign->fault, message, sizeof message));
	else if (campaign->gave_up)
		(void)fprintf(stderr, "talus: --max-failures %d is reached: no more runs were started\n",
			campaign->options.max_failures);
	else if (code == EX_INTERRUPTED)
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

/* What `run` would do with the run. */
void campaign_describe_plan(
	const struct campaign *campaign, const struct task *task, struct text *out)
{
	const struct run_report *report = &task->report;
	double end = task->run->config.time.end;

	if (task->state == TASK_COMPLETE)
		text_add(out, "complete, nothing to do");
	else if (task->queue.job[0])
		text_add(out, "nothing to do: it is in the queue");
	else if (task->state == TASK_FAILED)
		text_addf(out, "%s, left as it is without --retry", run_state_name(report->state));
	else if (task->state == TASK_ELSEWHERE)
		text_add(out, "another process works on it");
	else if (report->state == RUN_STATE_DAMAGED && report->blocked)
		text_addf(out, "damaged, refused; move %s away to start anew", task->run->folder);
	else if (report->state == RUN_STATE_FAILED || report->state == RUN_STATE_DAMAGED)
		text_addf(out, "%s, start anew", run_state_name(report->state));
	else if (report->state == RUN_STATE_PENDING && task->before != SIZE_MAX)
		text_addf(out, "go on to %g s from %s, once that is complete", end,
			campaign->tasks[task->before].run->id);
	else if (report->state == RUN_STATE_PENDING && task->from)
		text_addf(out, "go on to %g s from %s", end, task->from);
	else if (report->state == RUN_STATE_PENDING)
		text_add(out, "start");
	else
		text_addf(out, "resume at %g s of %g s", report->time, end);
}

/* What `run` would do with each run. */
static int print_plan(const struct campaign *campaign)
{
	size_t runs = campaign->experiment->run_count;
	struct text out = {0};
	double done, all;
	char span[CLOCK_SPAN_SIZE];

	for (size_t i = 0; i < runs; i++) {
		const struct task *task = &campaign->tasks[i];

		if (task->state == TASK_LEFT)
			continue;
		text_addf(&out, "%s: ", task->run->id);
		campaign_describe_plan(campaign, task, &out);
		text_add(&out, "\n");
	}
	runs -= campaign_count(campaign, TASK_LEFT);
	campaign_work(campaign, &done, &all);
	text_addf(&out, "%zu run%s, %d at a time, about %s CPU\n", runs, runs == 1 ? "" : "s",
		campaign->options.jobs, clock_span(all - done, span));
	return command_print(&out);
}

static int run_campaign(const struct campaign_arguments *arguments,
	const struct experiment *experiment, const struct campaign_options *options, bool failed_only)
{
	const struct executor *executor = executor_find(arguments->executor);
	struct campaign campaign;
	struct error err = {0};
	int code;

	if (!executor)
		return command_usage(
			"campaign", "--executor %s: there are local and slurm", arguments->executor);
	if (executor->queue && (options->timeout > 0 || options->max_failures))
		return command_usage("campaign",
			"--executor %s takes no --%s: a queue has no eye on its runs%s", arguments->executor,
			options->timeout > 0 ? "timeout" : "max-failures",
			options->timeout > 0 ? "; its limit is `time` in the section `slurm:`" : "");
	if (campaign_create(&campaign, experiment, options, &err) ||
		(failed_only &&
			campaign_select_failed(&campaign, arguments->names, arguments->name_count, &err)))
		code = command_fail(&err);
	else if (!arguments->dry_run)
		code = execute(&campaign, executor);
	else
		code = executor->plan ? print_handover(&campaign, executor) : print_plan(&campaign);
	campaign_clean(&campaign);
	return code;
}

static int run_main(const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	return run_campaign(arguments, experiment, &arguments->options, false);
}

static int retry_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	struct campaign_options options = arguments->options;

	options.anew = true;
	if (!options.retry)
		options.retry = 1;
	return run_campaign(arguments, experiment, &options, true);
}

#define OPTIONS_OF_POOL                                                                            \
	"  -j, --jobs N          runs at a time; an experiment with `timing: true` makes it 1\n"       \
	"                        (default: the number of processors; slurm: `throttle` of `slurm:`)\n" \
	"  -n, --dry-run         print what would be done and change nothing (default: off)\n"         \
	"  -t, --timeout SPAN    stop a run after so much wall clock, such as 90 s or 2 h, with its\n" \
	"                        checkpoint written (default: never)\n"                                \
	"  -m, --max-failures N  start no more runs once so many have failed (default: any number)\n"  \
	"      --order ORDER     longest: the longest expected run first; given: as in the "           \
	"experiment,\n"                                                                                \
	"                        as those with `timing: true` always are (default: longest)\n"         \
	"  -e, --executor NAME   how runs are executed: local, as processes of this machine; slurm,\n" \
	"                        as job arrays of a cluster, without -t and -m (default: local)\n"

const struct campaign_action campaign_action_run = {
	.name = "run",
	.summary = "Bring every run of an experiment to its end, from wherever it stands.",
	.usage = "[OPTION]... EXPERIMENT",
	.help =
		"example: talus campaign run -j 2 experiments/quickstart.yaml\n\n"
		"options:\n" OPTIONS_OF_POOL
		"  -r, --retry N         start a run that fails, crashes or times out anew, until it has\n"
		"                        failed N times and once more; why each attempt ended stays in\n"
		"                        status.yaml (default: 0)\n" CAMPAIGN_OPTIONS_OF_ALL
		"Ctrl-C stops all runs with their checkpoints written; the same command goes on from there.\n"
		"A run that differs from another by a later time.end alone goes on from that one.\n\n"
		"exit: 0 all runs are complete or in the queue, 1 one failed, 65 bad experiment,\n"
		"69 Slurm is not there or refuses, 75 stopped and resumable\n",
	.options = "jnrtmeO",
	.main = run_main,
};

const struct campaign_action campaign_action_retry = {
	.name = "retry",
	.summary = "Start failed runs anew: all of them, or those that are named.",
	.usage = "[OPTION]... EXPERIMENT [RUN]...",
	.help =
		"example: talus campaign retry experiments/quickstart.yaml\n\n"
		"RUN is a name as `status` prints it, the beginning of one, or digits of its hash.\n\n"
		"options:\n" OPTIONS_OF_POOL
		"  -r, --retry N         start each anew up to N times (default: 1)\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 these runs are complete or in the queue, 1 one failed again, 65 bad\n"
		"experiment or no such run, 69 Slurm is not there or refuses, 75 stopped and resumable\n",
	.options = "jnrtmeO",
	.names = true,
	.main = retry_main,
};
