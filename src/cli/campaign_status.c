/* talus campaign status: a line per run, or JSON. */
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
static int choose_rows(
	const struct experiment *experiment, const struct run_report *reports, int rows, size_t *hidden)
{
	size_t lines[STATES] = {0}, shown = 0;
	int least = STATES;

	for (size_t i = 0; i < experiment->run_count; i++)
		lines[importance[reports[i].state]] += reports[i].reason[0] ? 2 : 1;
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

static void print_run(const struct experiment_run *run, const struct run_report *report, int width,
	const struct room *room, struct text *out)
{
	char name[256], reason[sizeof report->reason];

	text_addf(out, "%-*s  %-11s  %6.1f %%  %8.1f  %8d", width,
		campaign_short_name(run->id, room->columns ? width : 0, name),
		run_state_name(report->state), 100 * campaign_progress(run, report), report->cpu_seconds,
		report->attempts);
	if (!report->reason[0])
		text_add(out, "\n");
	else if (room->columns)
		text_addf(out, "\n    %s\n",
			text_excerpt(report->reason, reason,
				(size_t)room->columns < sizeof reason ? (size_t)room->columns - 3 : sizeof reason));
	else
		text_addf(out, "  %s\n", report->reason);
}

static void print_table(const struct experiment *experiment, const struct run_report *reports,
	const struct room *room, struct text *out)
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
		least = choose_rows(experiment, reports, room->rows, &hidden);
	text_addf(out, "%-*s  %-11s  PROGRESS     CPU s  ATTEMPTS%s\n", width, "RUN", "STATE",
		room->columns ? "" : "  REASON");
	for (size_t i = 0; i < experiment->run_count; i++)
		if (importance[reports[i].state] >= least)
			print_run(&experiment->runs[i], &reports[i], width, room, out);
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

static void print_json_run(
	const struct experiment_run *run, const struct run_report *report, struct text *out)
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
	text_addf(out, "\"attempts\": %d, \"failures\": %d, \"reason\": ", report->attempts,
		report->failures);
	json_add_string(out, report->reason);
	text_add(out, "}");
}

static void print_json(const struct experiment *experiment, const struct run_report *reports,
	const size_t counts[STATES], struct text *out)
{
	text_add(out, "{\n  ");
	add_member(out, "experiment", experiment->path);
	add_member(out, "title", experiment->title);
	add_member(out, "folder", experiment->folder);
	text_add(out, "\n  \"runs\": [\n");
	for (size_t i = 0; i < experiment->run_count; i++) {
		print_json_run(&experiment->runs[i], &reports[i], out);
		text_add(out, i + 1 < experiment->run_count ? ",\n" : "\n");
	}
	text_add(out, "  ],\n  \"counts\": {");
	for (int state = 0; state < STATES; state++)
		text_addf(out, "%s\"%s\": %zu", state ? ", " : "", run_state_name((enum run_state)state),
			counts[state]);
	text_add(out, "}\n}\n");
}

/* What goes on from here, one command each. */
static void print_next(
	const struct campaign_arguments *arguments, const size_t counts[STATES], struct text *out)
{
	size_t unfinished = counts[RUN_STATE_PENDING] + counts[RUN_STATE_INTERRUPTED];

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

static int status_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	struct run_report *reports = calloc(experiment->run_count, sizeof *reports);
	size_t counts[STATES] = {0};
	struct room room;
	struct text out = {0};
	struct error err = {0};

	if (!reports) {
		(void)error_memory(&err, experiment->run_count * sizeof *reports);
		return command_fail(&err);
	}
	campaign_screen(STDOUT_FILENO, &room.columns, &room.rows);
	room.rows = arguments->all || room.rows < 12 ? 0 : room.rows - 6;
	for (size_t i = 0; i < experiment->run_count; i++) {
		run_report_read(experiment->runs[i].folder, &reports[i]);
		if (reports[i].unknown) {
			(void)error_memory(&err, sizeof *reports);
			free(reports);
			return command_fail(&err);
		}
	}
	count_states(experiment, reports, counts);
	if (arguments->json) {
		print_json(experiment, reports, counts, &out);
	} else {
		print_table(experiment, reports, &room, &out);
		if (room.columns) /* hints are for people */
			print_next(arguments, counts, &out);
		print_counts(experiment, counts, &out);
	}
	free(reports);
	return command_print(&out);
}

const struct campaign_action campaign_action_status = {
	.name = "status",
	.summary = "Tell how every run of an experiment is, and what goes on from there.",
	.usage = "[OPTION]... EXPERIMENT",
	.help =
		"example: talus campaign status experiments/quickstart.yaml\n\n"
		"On a terminal the table fits the screen, and runs that need attention come before those "
		"that\nare complete.\n\n"
		"options:\n"
		"  -a, --all             every run, also where the screen is too small (default: off)\n"
		"      --json            print JSON (default: a table)\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 whatever the states are, 65 bad experiment\n",
	.options = "aJ",
	.main = status_main,
};
