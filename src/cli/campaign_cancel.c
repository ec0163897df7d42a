/* talus campaign cancel: stop every campaign command that works on an experiment. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/lock.h"
#include "cli/campaign.h"

enum { PATIENCE = 60 }; /* s: the longest step and its checkpoint, as a rule */

static bool is_running(const struct experiment_run *run)
{
	struct run_report report;

	run_report_read(run->folder, &report);
	return report.state == RUN_STATE_RUNNING;
}

static size_t count_running(const struct experiment *experiment)
{
	size_t count = 0;

	for (size_t i = 0; i < experiment->run_count; i++)
		count += is_running(&experiment->runs[i]);
	return count;
}

static void tell_holder(const struct experiment_run *run)
{
	struct text path = {0};
	struct error ignored = {0};
	char holder[LOCK_HOLDER_SIZE] = "";

	if (file_path(&path, run->folder, "run.lock", &ignored) == 0)
		(void)lock_holder(text_string(&path), holder);
	(void)fprintf(stderr, "talus: run %s is still run by %s\n", run->id,
		*holder ? holder : "an unknown process");
	text_clean(&path);
}

/* Runs in the queue of a cluster; a queue that does not answer is told once, by `cancel`. */
static size_t count_queued(const struct experiment *experiment)
{
	struct queue_entry *entries = calloc(experiment->run_count, sizeof *entries);
	struct error ignored = {0};
	size_t count = 0;

	if (entries && executor_queue(experiment, entries, &ignored) == 0)
		for (size_t i = 0; i < experiment->run_count; i++)
			count += entries[i].job[0] != '\0';
	free(entries);
	return count;
}

/* Take back what is in queues; a command that is submitting just now is waited for until `end`. */
static int take_back(
	const struct experiment *experiment, double end, size_t *taken, struct error *err)
{
	const struct timespec pause = {.tv_sec = 1};

	while (executor_cancel(experiment, taken, err)) {
		if (err->code != EX_INTERRUPTED || clock_wall() > end)
			return -1;
		*err = (struct error){0};
		(void)nanosleep(&pause, NULL);
	}
	return 0;
}

/* Until `end` for the runs to write their checkpoints, and for the queue to have let go of them: as long
 * as it has them, they would not be submitted again. How many still run. */
static size_t wait_until_stopped(const struct experiment *experiment, bool queued, double end)
{
	const struct timespec pause = {.tv_nsec = 100000000}, patience = {.tv_sec = 1};
	size_t left;

	while ((left = count_running(experiment)) && clock_wall() < end)
		(void)nanosleep(&pause, NULL);
	while (queued && count_queued(experiment) && clock_wall() < end)
		(void)nanosleep(&patience, NULL);
	return left;
}

static int cancel_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	size_t running = count_running(experiment), left, taken;
	double end = clock_wall() + PATIENCE;
	struct text out = {0};
	struct error err = {0}, refusal = {0};
	int code;

	(void)arguments;
	if (!file_is_folder(experiment->folder)) {
		text_addf(&out, "nothing runs in %s\n", experiment->folder);
		return command_print(&out);
	}
	/* also when nothing runs: a campaign may be between two runs */
	if (campaign_cancel(experiment, &err))
		return command_fail(&err);
	if (take_back(experiment, end, &taken, &refusal))
		(void)command_fail(&refusal); /* the runs of this machine stop all the same */
	if (taken)
		text_addf(&out, "%zu run%s taken back from the queue\n", taken, taken == 1 ? "" : "s");
	left = wait_until_stopped(experiment, taken > 0, end);
	text_addf(&out, "%zu run%s in %s stopped; `talus campaign run` goes on with them\n",
		running > left ? running - left : 0, running - left == 1 ? "" : "s", experiment->folder);
	for (size_t i = 0; left && i < experiment->run_count; i++)
		if (is_running(&experiment->runs[i]))
			tell_holder(&experiment->runs[i]);
	if (left)
		return text_clean(&out), EX_INTERRUPTED;
	code = command_print(&out);
	return refusal.code ? refusal.code : code;
}

const struct campaign_action campaign_action_cancel = {
	.name = "cancel",
	.summary = "Stop every campaign that works on an experiment, with checkpoints written.",
	.usage = "[OPTION]... EXPERIMENT",
	.help =
		"example: talus campaign cancel experiments/quickstart.yaml\n\n"
		"Reaches all `talus campaign run` in the folder, on whatever machine, and waits a minute for\n"
		"their runs. Runs in the queue of Slurm are taken back from there. A run that somebody started\n"
		"with `talus run` is named and left.\n\n"
		"options:\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 nothing runs any more, 65 bad experiment, 69 Slurm does not answer,\n"
		"73 the folder cannot be written, 75 something still runs\n",
	.options = "",
	.main = cancel_main,
};
