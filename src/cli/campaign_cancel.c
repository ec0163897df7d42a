/* talus campaign cancel: stop every campaign command that works on an experiment. */
#include <stdio.h>
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

static int cancel_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	const struct timespec pause = {.tv_nsec = 100000000};
	size_t running = count_running(experiment), left = running;
	double end = clock_wall() + PATIENCE;
	struct text out = {0};
	struct error err = {0};

	(void)arguments;
	if (!file_is_folder(experiment->folder)) {
		text_addf(&out, "nothing runs in %s\n", experiment->folder);
		return command_print(&out);
	}
	/* also when nothing runs: a campaign may be between two runs */
	if (campaign_cancel(experiment, &err))
		return command_fail(&err);
	while (left && clock_wall() < end) {
		(void)nanosleep(&pause, NULL);
		left = count_running(experiment);
	}
	text_addf(&out, "%zu run%s in %s stopped; `talus campaign run` goes on with them\n",
		running - left, running - left == 1 ? "" : "s", experiment->folder);
	for (size_t i = 0; left && i < experiment->run_count; i++)
		if (is_running(&experiment->runs[i]))
			tell_holder(&experiment->runs[i]);
	return left ? (text_clean(&out), EX_INTERRUPTED) : command_print(&out);
}

const struct campaign_action campaign_action_cancel = {
	.name = "cancel",
	.summary = "Stop every campaign that works on an experiment, with checkpoints written.",
	.usage = "[OPTION]... EXPERIMENT",
	.help =
		"example: talus campaign cancel experiments/quickstart.yaml\n\n"
		"Reaches all `talus campaign run` in the folder, on whatever machine, and waits a minute "
		"for\ntheir runs. A run that somebody started with `talus run` is named and left.\n\n"
		"options:\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 nothing runs any more, 65 bad experiment, 73 the folder cannot be written,\n"
		"75 something still runs\n",
	.options = "",
	.main = cancel_main,
};
