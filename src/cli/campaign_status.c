/* talus campaign status: a line per run, or JSON. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "cli/campaign.h"

enum { STATES = RUN_STATE_DAMAGED + 1 };

/* Share of the simulated time that is done. */
static double progress_of(const struct experiment_run *run, const struct run_report *report)
{
	if (report->state == RUN_STATE_COMPLETE)
		return 1;
	return run->config.time.end > 0 ? report->time / run->config.time.end : 0;
}

/* What is known beside the numbers: "PENDING 12_4 (Resources)", why it stopped, or both. */
static void add_remark(
	const struct run_report *report, const struct queue_entry *entry, struct text *out)
{
	bool queued = entry->job[0] != '\0';

	if (queued)
		text_addf(out, "%s %s", entry->state, entry->job);
	if (queued && entry->reason[0] && strcmp(entry->reason, "None") != 0)
		text_addf(out, " (%s)", entry->reason);
	text_addf(out, "%s%s", queued && report->reason[0] ? "; " : "", report->reason);
}

static void print_table(const struct experiment *experiment, const struct run_report *reports,
	const struct queue_entry *queue, struct text *out)
{
	int width = (int)strlen("RUN");

	for (size_t i = 0; i < experiment->run_count; i++)
		if ((int)strlen(experiment->runs[i].id) > width)
			width = (int)strlen(experiment->runs[i].id);
	text_addf(out, "%-*s  %-11s  PROGRESS     CPU s  ATTEMPTS  REASON\n", width, "RUN", "STATE");
	for (size_t i = 0; i < experiment->run_count; i++) {
		const struct run_report *report = &reports[i];
		struct text remark = {0};

		text_addf(out, "%-*s  %-11s  %6.1f %%  %8.1f  %8d", width, experiment->runs[i].id,
			run_state_name(report->state), 100 * progress_of(&experiment->runs[i], report),
			report->cpu_seconds, report->attempts);
		add_remark(report, &queue[i], &remark);
		text_addf(out, "%s%s\n", remark.length ? "  " : "", text_string(&remark));
		text_clean(&remark);
	}
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
	add_number(out, "progress", progress_of(run, report));
	add_number(out, "time", report->time);
	add_number(out, "end", run->config.time.end);
	add_number(out, "wall_left", report->wall_left);
	add_number(out, "cpu_seconds", report->cpu_seconds);
	print_json_queue(entry, out);
	text_addf(out, "\"attempts\": %d, \"reason\": ", report->attempts);
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

static int print_status(const struct campaign_arguments *arguments,
	const struct experiment *experiment, struct run_report *reports, struct queue_entry *queue)
{
	size_t counts[STATES] = {0};
	struct text out = {0};
	struct error err = {0};

	/* asked first: a run that leaves the queue in between is seen as what it came to */
	if (executor_queue(experiment, queue, &err))
		(void)fprintf(stderr, "talus: warning: the queue is not known: %s\n", err.text);
	for (size_t i = 0; i < experiment->run_count; i++)
		run_report_read(experiment->runs[i].folder, &reports[i]);
	count_states(experiment, reports, counts);
	if (arguments->json) {
		print_json(experiment, reports, queue, counts, &out);
	} else {
		print_table(experiment, reports, queue, &out);
		print_counts(experiment, counts, &out);
	}
	return command_print(&out);
}

int campaign_status_main(
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
