/* talus campaign why: what state a run is in, how it came there, and what the next command does with it. */
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "cli/campaign.h"
#include "run/run_file_parts.h"
#include "talus/model.h"

enum { NEAR_MAX = 3 }; /* keys by which a run is still near another */

static void add_indented(struct text *out, const char *indent, const char *lines)
{
	while (*lines) {
		int length = (int)strcspn(lines, "\n");

		text_addf(out, "%s%.*s\n", indent, length, lines);
		lines += length + (lines[length] == '\n');
	}
}

static size_t count_lines(const char *text)
{
	size_t count = 0;

	for (; *text; text++)
		count += *text == '\n';
	return count;
}

static void add_config(const struct experiment_run *run, struct text *out)
{
	for (size_t i = 0; i < run->settings.count; i++)
		text_addf(out, "%s%s: %s", i ? ", " : "  settings: ", run->settings.items[i].key,
			run->settings.items[i].value);
	text_add(out, run->settings.count ? "\n" : "");
}

/* Folders that exist, with the fewest keys by which their config differs from that of a run. */
struct nearest {
	char *name;
	struct text keys;
	size_t count;
};

static void nearest_consider(struct nearest *nearest, const struct experiment *experiment,
	const char *name, const struct config *wanted, struct text *out)
{
	struct text path = {0}, keys = {0};
	struct error unreadable = {0};
	struct config config;
	size_t count;

	text_addf(&path, "%s/%s/config.yaml", experiment->folder, name);
	if (!file_exists(text_string(&path)) ||
		config_read(&config, text_string(&path), NULL, 0, &unreadable))
		goto done;
	config_differences(&config, wanted, &keys);
	count = count_lines(text_string(&keys));
	if (count && (!nearest->name || count < nearest->count)) {
		free(nearest->name);
		text_clean(&nearest->keys);
		*nearest = (struct nearest){strdup(name), keys, count};
		keys = (struct text){0};
	}
done:
	out->failed |= path.failed || keys.failed || nearest->keys.failed ||
				   (nearest->count && !nearest->name) || unreadable.code == EX_SOFTWARE;
	text_clean(&path);
	text_clean(&keys);
}

/* A run that nobody has begun may be one that was there before a key changed. */
static void add_nearest(
	const struct experiment *experiment, const struct experiment_run *run, struct text *out)
{
	struct nearest nearest = {0};
	struct dirent **entries = NULL;
	int count = scandir(experiment->folder, &entries, NULL, alphasort);

	out->failed |= count < 0 && errno == ENOMEM;
	for (int i = 0; i < count; i++) {
		if (entries[i]->d_name[0] != '.')
			nearest_consider(&nearest, experiment, entries[i]->d_name, &run->config, out);
		free(entries[i]);
	}
	free(entries);
	if (nearest.name && nearest.count <= NEAR_MAX) {
		text_addf(
			out, "  nearest to it is %s/%s, which differs by:\n", experiment->folder, nearest.name);
		add_indented(out, "    ", text_string(&nearest.keys));
	}
	free(nearest.name);
	text_clean(&nearest.keys);
}

/* A folder of the right name whose file was made from another config, or by other numerics. */
static void add_mismatch(const struct experiment_run *run, struct text *out)
{
	struct run_file *file = NULL;
	struct text warning = {0}, keys = {0};
	struct error ignored = {0};
	struct config config;
	double version;

	if (run_file_open_newest(run->folder, &file, &warning, &ignored))
		goto done;
	if (warning.length)
		text_addf(out, "  warning: %s\n", text_string(&warning));
	if (run_file_config(file, &config, &ignored) == 0)
		config_differences(&config, &run->config, &keys);
	if (keys.length) {
		text_add(out, "  its run file was made from another config, and is refused:\n");
		add_indented(out, "    ", text_string(&keys));
	}
	if (run_file_real(file, "numerics_version", &version, &ignored) == 0 &&
		version != model_find(&run->config)->numerics_version)
		text_addf(out,
			"  its run file was made with numerics_version %g, and this program has %d: it is refused\n",
			version, model_find(&run->config)->numerics_version);
done:
	out->failed |= warning.failed || keys.failed || ignored.code == EX_SOFTWARE;
	run_file_close(file);
	text_clean(&warning);
	text_clean(&keys);
}

static void add_progress(const struct task *task, struct text *out)
{
	const struct run_report *report = &task->report;
	char span[CLOCK_SPAN_SIZE], left[CLOCK_SPAN_SIZE];

	text_addf(out, "  state: %s", run_state_name(report->state));
	if (report->state != RUN_STATE_PENDING)
		text_addf(out, ", t = %g of %g s, %s of CPU time", report->time, task->run->config.time.end,
			clock_span(report->cpu_seconds, span));
	if (report->state == RUN_STATE_RUNNING && isfinite(report->wall_left))
		text_addf(out, ", %s left", clock_span(report->wall_left, left));
	text_add(out, "\n");
	if (task->queue.job[0]) {
		text_add(out, "  queue: ");
		campaign_add_queue(&task->queue, out);
		text_add(out, "\n");
	}
	if (report->reason[0])
		text_addf(out, "  reason: %s\n", report->reason);
}

static void explain(const struct campaign *campaign, const struct task *task, struct text *out)
{
	struct text history = {0}, log = {0};

	text_addf(out, "%s\n  folder: %s\n", task->run->id, task->run->folder);
	add_config(task->run, out);
	add_progress(task, out);
	run_report_history(task->run->folder, &history);
	if (history.length) {
		text_add(out, "  attempts that ended:\n");
		add_indented(out, "    ", text_string(&history));
	}
	if (task->report.state == RUN_STATE_PENDING)
		add_nearest(campaign->experiment, task->run, out);
	else if (task->report.state != RUN_STATE_RUNNING)
		add_mismatch(task->run, out);
	if (task->report.state != RUN_STATE_COMPLETE && task->report.state != RUN_STATE_RUNNING)
		campaign_log_end(task->run, 5, &log);
	if (log.length) {
		text_add(out, "  the end of its log:\n");
		add_indented(out, "    ", text_string(&log));
	}
	text_add(out, "  next: ");
	campaign_describe_plan(campaign, task, out);
	text_add(out, "\n");
	out->failed |= history.failed || log.failed;
	text_clean(&history);
	text_clean(&log);
}

/* A folder that the experiment does not name: which of its runs it comes nearest to, and by what it
 * differs from that one. False: there is no such run folder. */
static bool explain_stranger(
	const struct experiment *experiment, const char *given, struct text *out)
{
	const char *slash = strrchr(given, '/'), *name = slash && slash[1] ? slash + 1 : given;
	struct text path = {0}, keys = {0}, best = {0};
	struct error unreadable = {0};
	struct config config;
	size_t index = 0;
	bool found;

	text_addf(&path, "%s/%s/config.yaml", experiment->folder, name);
	found = file_exists(text_string(&path)) &&
			config_read(&config, text_string(&path), NULL, 0, &unreadable) == 0;
	for (size_t i = 0; found && i < experiment->run_count; i++) {
		config_differences(&config, &experiment->runs[i].config, &keys);
		out->failed |= keys.failed;
		if (!best.length || count_lines(text_string(&keys)) < count_lines(text_string(&best))) {
			text_clean(&best);
			best = keys;
			keys = (struct text){0};
			index = i;
		}
		text_clean(&keys);
	}
	if (found) {
		text_addf(out,
			"%s\n  folder: %s/%s\n  no run of %s; the nearest is %s, which differs by:\n", name,
			experiment->folder, name, experiment->path, experiment->runs[index].id);
		add_indented(out, "    ", text_string(&best));
		text_add(out, "  next: `run` leaves it alone, `prune` removes it\n");
	}
	out->failed |= path.failed || unreadable.code == EX_SOFTWARE;
	text_clean(&path);
	text_clean(&best);
	return found;
}

static int explain_named(const struct campaign_arguments *arguments,
	const struct campaign *campaign, struct text *out, struct error *err)
{
	size_t index;

	for (int i = 0; i < arguments->name_count; i++) {
		text_add(out, i ? "\n" : "");
		if (campaign_find_run(campaign->experiment, arguments->names[i], &index, err)) {
			if (!explain_stranger(campaign->experiment, arguments->names[i], out))
				return -1;
			*err = (struct error){0};
			continue;
		}
		explain(campaign, &campaign->tasks[index], out);
	}
	return 0;
}

/* All that are not complete, the first of those that wait for their turn for all of them. */
static void explain_unfinished(const struct campaign *campaign, struct text *out)
{
	size_t pending = 0;

	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		const struct task *task = &campaign->tasks[i];

		if (task->report.state == RUN_STATE_COMPLETE)
			continue;
		if (task->report.state == RUN_STATE_PENDING && pending++)
			continue;
		text_add(out, out->length ? "\n" : "");
		explain(campaign, task, out);
	}
	if (pending > 1)
		text_addf(out, "\nand %zu more that nobody has begun\n", pending - 1);
	if (!out->length)
		text_addf(out, "all %zu runs are complete\n", campaign->experiment->run_count);
}

static int why_main(const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	struct campaign campaign;
	struct text out = {0};
	struct error err = {0}, refusal = {0};
	int code = 0;

	if (campaign_create(&campaign, experiment, &arguments->options, &err) == 0 &&
		campaign_ask_queue(&campaign, &refusal)) {
		if (refusal.code == EX_SOFTWARE)
			err = refusal;
		else
			(void)fprintf(stderr, "talus: warning: the queue is not known: %s\n", refusal.text);
	}
	if (err.code || explain_named(arguments, &campaign, &out, &err))
		code = command_fail(&err);
	else if (!arguments->name_count)
		explain_unfinished(&campaign, &out);
	campaign_clean(&campaign);
	if (!code)
		return command_print(&out);
	text_clean(&out);
	return code;
}

const struct campaign_action campaign_action_why = {
	.name = "why",
	.summary = "Say what state a run is in, why, and what `run` will do with it.",
	.usage = "[OPTION]... EXPERIMENT [RUN]...",
	.help =
		"example: talus campaign why experiments/quickstart.yaml\n\n"
		"RUN is a name as `status` prints it, the beginning of one, its folder, or digits of its hash;\n"
		"without it, all runs that are not complete. A run that nobody has begun is compared with those\n"
		"that are there, key by key.\n\n"
		"options:\n"
		"  -r, --retry N         as it would be given to `run` (default: 0)\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 whatever the states are, 65 bad experiment or no such run\n",
	.options = "r",
	.names = true,
	.main = why_main,
};
