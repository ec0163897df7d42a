/* talus campaign status: a line per run, or JSON. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/json.h"
#include "cli/campaign.h"

enum { STATES = RUN_STATE_DAMAGED + 1 };

/* What a screen has no room for is told last: those that are as they should be go first. */
static const int importance[STATES] = {[RUN_STATE_DAMAGED] = 5,
	[RUN_STATE_FAILED] = 4,
	[RUN_STATE_INTERRUPTED] = 3,
	[RUN_STATE_RUNNING] = 2,
	[RUN_STATE_PENDING] = 1,
	[RUN_STATE_COMPLETE] = 0};

/* The least importance of which all runs fit `rows` lines; those that are not shown are counted. */
static int choose_rows(const struct experiment *experiment, const struct run_report *reports,
	const struct queue_entry *queue, int rows, size_t *hidden)
{
	size_t lines[STATES] = {0}, shown = 0;
	int least = STATES;

	for (size_t i = 0; i < experiment->run_count; i++)
		lines[importance[reports[i].state]] += reports[i].reason[0] || queue[i].job[0] ? 2 : 1;
	while (least > 0 && (!shown || shown + lines[least - 1] <= (size_t)rows))
		shown += lines[--least];
	*hidden = 0;
	for (size_t i = 0; i < experiment->run_count; i++)
		*hidden += importance[reports[i].state] < least;
	return least;
}

/* Room that a table has: that of the terminal, or as much as it wants. */
struct room {
	int columns, rows; /* 0: any */
};

static void print_run(const struct experiment_run *run, const struct run_report *report,
	const struct queue_entry *entry, int width, const struct room *room, struct text *out)
{
	enum { REMARK = sizeof report->reason + 256 };
	struct text remark = {0};
	char name[256], shown[REMARK];

	text_addf(out, "%-*s  %-11s  %6.1f %%  %8.1f  %8d", width,
		campaign_short_name(run->id, room->columns ? width : 0, name),
		run_state_name(report->state), 100 * campaign_progress(run, report), report->cpu_seconds,
		report->attempts);
	campaign_add_queue(entry, &remark);
	text_addf(&remark, "%s%s", remark.length && report->reason[0] ? "; " : "", report->reason);
	if (!remark.length)
		text_add(out, "\n");
	else if (room->columns)
		text_addf(out, "\n    %s\n",
			text_excerpt(text_string(&remark), shown,
				room->columns < REMARK ? (size_t)room->columns - 3 : REMARK));
	else
		text_addf(out, "  %s\n", text_string(&remark));
	text_clean(&remark);
}

static void print_table(const struct experiment *experiment, const struct run_report *reports,
	const struct queue_entry *queue, const struct room *room, struct text *out)
{
	enum { OTHERS = 46 }; /* columns beside the name */
	int width = (int)strlen("RUN"), least = 0;
	size_t hidden = 0;

	for (size_t i = 0; i < experiment->run_count; i++)
		if ((int)strlen(experiment->runs[i].id) > width)
			width = (int)strlen(experiment->runs[i].id);
	if (room->columns && width > room->columns - OTHERS)
		width = room->columns > OTHERS + 16 ? room->columns - OTHERS : 16;
	if (room->rows)
		least = choose_rows(experiment, reports, queue, room->rows, &hidden);
	text_addf(out, "%-*s  %-11s  PROGRESS     CPU s  ATTEMPTS%s\n", width, "RUN", "STATE",
		room->columns ? "" : "  REASON");
	for (size_t i = 0; i < experiment->run_count; i++)
		if (importance[reports[i].state] >= least)
			print_run(&experiment->runs[i], &reports[i], &queue[i], width, room, out);
	if (hidden)
		text_addf(out, "(%zu more; --all shows them)\n", hidden);
}

static void count_states(
	const struct experiment *experiment, const struct run_report *reports, size_t counts[STATES])
{
	for (size_t i = 0; i < experiment->run_count; i++)
		counts[reports[i].state]++;
}

static void print_counts(
	const struct experiment *experiment, const size_t counts[STATES], struct text *out)
{
	bool any = false;

	text_addf(out, "%zu run%s in %s:", experiment->run_count, experiment->run_count == 1 ? "" : "s",
		experiment->folder);
	for (int state = 0; state < STATES; state++)
		if (counts[state]) {
			text_addf(out, "%s %zu %s", any ? "," : "", counts[state],
				run_state_name((enum run_state)state));
			any = true;
		}
	text_add(out, "\n");
}

static void add_member(struct text *out, const char *name, const char *value)
{
	text_addf(out, "\"%s\": ", name);
	json_add_string(out, value);
	text_add(out, ", ");
}

static void add_number(struct text *out, const char *name, double value)
{
	text_addf(out, "\"%s\": ", name);
	json_add_real(out, value);
	text_add(out, ", ");
}

static void print_json_queue(const struct queue_entry *entry, struct text *out)
{
	text_add(out, "\"queue\": ");
	if (entry->job[0]) {
		text_add(out, "{");
		add_member(out, "job", entry->job);
		add_member(out, "state", entry->state);
		text_add(out, "\"reason\": ");
		json_add_string(out, entry->reason);
		text_add(out, "}, ");
	} else {
		text_add(out, "null, ");
	}
}

static void print_json_run(const struct experiment_run *run, const struct run_report *report,
	const struct queue_entry *entry, struct text *out)
{
	text_add(out, "    {");
	add_member(out, "run", run->id);
	add_member(out, "folder", run->folder);
	add_member(out, "config_hash", run->hash);
	text_add(out, "\"settings\": {");
	for (size_t i = 0; i < run->settings.count; i++) {
		text_add(out, i ? ", " : "");
		json_add_string(out, run->settings.items[i].key);
		text_add(out, ": ");
		json_add_string(out, run->settings.items[i].value);
	}
	text_addf(out, "}, \"repeat\": %d, ", run->repeat);
	add_member(out, "state", run_state_name(report->state));
	add_number(out, "progress", campaign_progress(run, report));
	add_number(out, "time", report->time);
	add_number(out, "end", run->config.time.end);
	add_number(out, "wall_left", report->wall_left);
	add_number(out, "cpu_seconds", report->cpu_seconds);
	print_json_queue(entry, out);
	text_addf(out, "\"attempts\": %d, \"failures\": %d, \"reason\": ", report->attempts,
		report->failures);
	json_add_string(out, report->reason);
	text_add(out, "}");
}

static void print_json(const struct experiment *experiment, const struct run_report *reports,
	const struct queue_entry *queue, const size_t counts[STATES], struct text *out)
{
	text_add(out, "{\n  ");
	add_member(out, "experiment", experiment->path);
	add_member(out, "title", experiment->title);
	add_member(out, "folder", experiment->folder);
	text_add(out, "\n  \"runs\": [\n");
	for (size_t i = 0; i < experiment->run_count; i++) {
		print_json_run(&experiment->runs[i], &reports[i], &queue[i], out);
		text_add(out, i + 1 < experiment->run_count ? ",\n" : "\n");
	}
	text_add(out, "  ],\n  \"counts\": {");
	for (int state = 0; state < STATES; state++)
		text_addf(out, "%s\"%s\": %zu", state ? ", " : "", run_state_name((enum run_state)state),
			counts[state]);
	text_add(out, "}\n}\n");
}

/* What goes on from here, one command each. */
static void print_next(const struct campaign_arguments *arguments,
	const struct experiment *experiment, const struct run_report *reports,
	const struct queue_entry *queue, struct text *out)
{
	size_t counts[STATES] = {0}, unfinished;

	for (size_t i = 0; i < experiment->run_count; i++)
		counts[reports[i].state] += !queue[i].job[0]; /* those go on by themselves */
	unfinished = counts[RUN_STATE_PENDING] + counts[RUN_STATE_INTERRUPTED];
	if (unfinished) {
		text_addf(out, "%zu to be run: ", unfinished);
		campaign_command(arguments, "run", out);
		text_add(out, "\n");
	}
	if (counts[RUN_STATE_DAMAGED] + counts[RUN_STATE_FAILED]) {
		text_addf(out, "%zu failed or damaged; to start them anew: ",
			counts[RUN_STATE_DAMAGED] + counts[RUN_STATE_FAILED]);
		campaign_command(arguments, "retry", out);
		text_add(out, "\nwhy: ");
		campaign_command(arguments, "why", out);
		text_add(out, "\n");
	}
}

static int print_status(const struct campaign_arguments *arguments,
	const struct experiment *experiment, struct run_report *reports, struct queue_entry *queue)
{
	size_t counts[STATES] = {0};
	struct room room;
	struct text out = {0};
	struct error refusal = {0};

	campaign_screen(STDOUT_FILENO, &room.columns, &room.rows);
	room.rows = arguments->all || room.rows < 12 ? 0 : room.rows - 6;
	/* asked first: a run that leaves the queue in between is seen as what it came to */
	if (executor_queue(experiment, queue, &refusal) && refusal.code == EX_SOFTWARE)
		return command_fail(&refusal);
	if (refusal.code)
		(void)fprintf(stderr, "talus: warning: the queue is not known: %s\n", refusal.text);
	for (size_t i = 0; i < experiment->run_count; i++) {
		run_report_read(experiment->runs[i].folder, &reports[i]);
		if (reports[i].unknown) {
			refusal = (struct error){0};
			(void)error_memory(&refusal, sizeof *reports);
			return command_fail(&refusal);
		}
	}
	count_states(experiment, reports, counts);
	if (arguments->json) {
		print_json(experiment, reports, queue, counts, &out);
	} else {
		print_table(experiment, reports, queue, &room, &out);
		if (room.columns) /* hints are for people */
			print_next(arguments, experiment, reports, queue, &out);
		print_counts(experiment, counts, &out);
	}
	return command_print(&out);
}

static int status_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	struct run_report *reports = calloc(experiment->run_count, sizeof *reports);
	struct queue_entry *queue = calloc(experiment->run_count, sizeof *queue);
	struct error err = {0};
	int code;

	if (reports && queue) {
		code = print_status(arguments, experiment, reports, queue);
	} else {
		(void)error_memory(&err, experiment->run_count * (sizeof *reports + sizeof *queue));
		code = command_fail(&err);
	}
	free(reports);
	free(queue);
	return code;
}

const struct campaign_action campaign_action_status = {
	.name = "status",
	.summary = "Tell how every run of an experiment is, and what goes on from there.",
	.usage = "[OPTION]... EXPERIMENT",
	.help =
		"example: talus campaign status experiments/quickstart.yaml\n\n"
		"On a terminal the table fits the screen, and runs that need attention come before those that\n"
		"are complete. A run in the queue of a cluster has its state there beside its own.\n\n"
		"options:\n"
		"  -a, --all             every run, also where the screen is too small (default: off)\n"
		"      --json            print JSON (default: a table)\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 whatever the states are, 65 bad experiment\n",
	.options = "aJ",
	.main = status_main,
};
