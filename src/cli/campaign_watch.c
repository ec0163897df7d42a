/* talus campaign watch: a live table, or lines where there is no terminal. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/campaign.h"

struct watch {
	struct campaign *campaign;
	double began, done_began; /* wall clock and work at the first look */
	double told;              /* when the last line about the whole was printed, s */
	double asked;             /* when the queue of a cluster last was, s */
	int drawn;                /* lines on the terminal to be drawn over */
};

/* Runs that wait in the queue of a cluster. */
static size_t count_queued(const struct campaign *campaign)
{
	size_t count = 0;

	for (size_t i = 0; i < campaign->experiment->run_count; i++)
		count += campaign->tasks[i].queue.job[0] && campaign->tasks[i].state == TASK_WAITING;
	return count;
}

/* "3 of 8 complete, 1 failed, 2 running, 41 %, 0.97 CPU s per s, 3 min 05 s left" */
static void summarise(const struct watch *watch, struct text *out)
{
	const struct campaign *campaign = watch->campaign;
	size_t running = campaign_count(campaign, TASK_ELSEWHERE),
		   failed = campaign_count(campaign, TASK_FAILED);
	size_t queued = count_queued(campaign);
	double done, all, passed = clock_wall() - watch->began;
	char span[CLOCK_SPAN_SIZE];

	campaign_work(campaign, &done, &all);
	text_addf(out, "%zu of %zu complete", campaign_count(campaign, TASK_COMPLETE),
		campaign->experiment->run_count);
	if (failed)
		text_addf(out, ", %zu failed", failed);
	if (queued)
		text_addf(out, ", %zu in the queue", queued);
	text_addf(
		out, ", %zu running, %.0f %%", running, all > 0 ? floor(100 * done / all + 1e-9) : 100);
	if (running && passed > 2)
		text_addf(out, ", %.2f CPU s per s", fmax(done - watch->done_began, 0) / passed);
	if (running)
		text_addf(out, ", %s left",
			clock_span(campaign_left(campaign, watch->began, watch->done_began), span));
	text_add(out, "\n");
}

static void add_bar(struct text *out, double share, int width)
{
	int full = (int)floor(share * width);

	text_add(out, "[");
	for (int i = 0; i < width; i++)
		text_add(out, i < full ? "#" : "-");
	text_add(out, "]");
}

static void add_row(const struct task *task, int columns, struct text *out)
{
	enum { OTHERS = 54, BAR = 12 }; /* columns beside the name; of the bar */
	const struct run_report *report = &task->report;
	double share = campaign_progress(task->run, report);
	int width = columns > OTHERS + 20 ? columns - OTHERS : 20;
	char name[256], span[CLOCK_SPAN_SIZE];

	text_addf(out, "%-*s  %-11s ", width, campaign_short_name(task->run->id, width, name),
		run_state_name(report->state));
	add_bar(out, share, BAR);
	text_addf(out, " %3.0f %%", floor(100 * share));
	if (report->state == RUN_STATE_RUNNING)
		text_addf(out, "  %s left", clock_span(report->wall_left, span));
	text_add(out, "\033[K\n");
}

/* Rows for those that run, then those that failed, as many as fit; everything over the last drawing. */
static void draw(struct watch *watch)
{
	static const enum run_state shown[] = {
		RUN_STATE_RUNNING, RUN_STATE_FAILED, RUN_STATE_DAMAGED, RUN_STATE_INTERRUPTED};
	const struct campaign *campaign = watch->campaign;
	struct text out = {0};
	char back[32] = "";
	size_t start;
	int columns, rows, used = 1;

	campaign_screen(STDOUT_FILENO, &columns, &rows);
	if (watch->drawn)
		(void)snprintf(back, sizeof back, "\033[%dA\r", watch->drawn);
	text_add(&out, back);
	summarise(watch, &out);
	if (out.failed) { /* the next drawing may succeed */
		text_clean(&out);
		return;
	}
	out.data[--out.length] = '\0';
	start = strlen(back);
	if (columns && out.length - start > (size_t)columns)
		out.data[out.length = start + (size_t)columns] = '\0';
	text_add(&out, "\033[K\n");
	for (size_t s = 0; s < sizeof shown / sizeof *shown; s++)
		for (size_t i = 0; i < campaign->experiment->run_count && used < rows - 1; i++) {
			if (campaign->tasks[i].report.state != shown[s])
				continue;
			add_row(&campaign->tasks[i], columns, &out);
			used++;
		}
	text_add(&out, "\033[J");
	watch->drawn = used;
	(void)fwrite(text_string(&out), 1, out.length, stdout);
	(void)fflush(stdout);
	text_clean(&out);
}

/* One line per run whose state has changed, and now and then one about the whole. */
static int print_changes(struct watch *watch, enum run_state *before, double every)
{
	const struct campaign *campaign = watch->campaign;
	struct text out = {0};
	bool first = watch->told <= 0;

	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		const struct task *task = &campaign->tasks[i];

		if (!first && before[i] != task->report.state)
			text_addf(&out, "%s: %s%s%s\n", task->run->id, run_state_name(task->report.state),
				task->report.reason[0] ? ": " : "", task->report.reason);
		before[i] = task->report.state;
	}
	if (first || out.length || clock_wall() - watch->told >= fmax(60, every)) {
		summarise(watch, &out);
		watch->told = clock_wall();
	}
	return command_print(&out);
}

/* Not at every look: the whole cluster shares its answers. One that is not answered is of no interest here;
 * `status` tells it. */
static void ask_queue(struct watch *watch)
{
	enum { EVERY = 10 };
	struct error ignored = {0};

	if (watch->asked > 0 && clock_wall() - watch->asked < EVERY)
		return;
	watch->asked = clock_wall();
	(void)campaign_ask_queue(watch->campaign, &ignored);
}

static bool is_over(const struct campaign *campaign)
{
	return !campaign_count(campaign, TASK_WAITING) && !campaign_count(campaign, TASK_ELSEWHERE);
}

/* `*code` is that of a line that could not be printed. */
static int watch_campaign(struct watch *watch, double every, int *code, struct error *err)
{
	struct campaign *campaign = watch->campaign;
	size_t runs = campaign->experiment->run_count;
	enum run_state *before = calloc(runs, sizeof *before);
	const struct timespec pause = {(time_t)every, (long)(1e9 * fmod(every, 1))};
	bool terminal = isatty(STDOUT_FILENO) == 1;
	double all;

	if (!before)
		return error_memory(err, runs * sizeof *before);
	watch->began = clock_wall();
	campaign_work(campaign, &watch->done_began, &all);
	for (;;) {
		ask_queue(watch);
		if (terminal)
			draw(watch);
		else
			*code = print_changes(watch, before, every);
		if (*code || is_over(campaign))
			break;
		(void)nanosleep(&pause, NULL);
		campaign_look(campaign);
	}
	free(before);
	return 0;
}

static int watch_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	const struct campaign_options options = {.jobs = 0};
	struct campaign campaign;
	struct watch watch = {.campaign = &campaign};
	struct error err = {0};
	int code = 0;

	if (campaign_create(&campaign, experiment, &options, &err) ||
		watch_campaign(&watch, arguments->every, &code, &err))
		code = command_fail(&err);
	else if (!code)
		code = campaign_code(&campaign);
	campaign_clean(&campaign);
	return code;
}

const struct campaign_action campaign_action_watch = {
	.name = "watch",
	.summary = "Show how the runs of an experiment go on, until all have ended.",
	.usage = "[OPTION]... EXPERIMENT",
	.help =
		"example: talus campaign watch experiments/quickstart.yaml\n\n"
		"A table that is drawn again and again; where the output is no terminal, a line for every run\n"
		"that changes its state. It only looks: Ctrl-C ends the looking, not the runs.\n\n"
		"options:\n"
		"  -i, --interval SPAN   time between two looks (default: 1 s)\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 all runs are complete, 1 one failed, 65 bad experiment\n",
	.options = "i",
	.main = watch_main,
};
