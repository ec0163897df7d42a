#include "talus/campaign.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/build.h"
#include "base/clock.h"
#include "base/file.h"
#include "campaign/beginning.h"
#include "campaign/task.h"
#include "talus/model.h"

int campaign_create(struct campaign *campaign, const struct experiment *experiment,
	const struct campaign_options *options, struct error *err)
{
	*campaign = (struct campaign){
		.experiment = experiment, .options = *options, .jobs_asked = options->jobs};
	if (!campaign->options.jobs)
		campaign->options.jobs = (int)sysconf(_SC_NPROCESSORS_ONLN);
	if (experiment->timing || campaign->options.jobs < 1)
		campaign->options.jobs = 1;
	campaign->tasks = calloc(experiment->run_count, sizeof *campaign->tasks);
	if (!campaign->tasks)
		return error_memory(err, experiment->run_count * sizeof *campaign->tasks);
	for (size_t i = 0; i < experiment->run_count; i++) {
		struct task *task = &campaign->tasks[i];

		task->run = &experiment->runs[i];
		task->cost = model_cost(&task->run->config);
		task->before = SIZE_MAX;
		task_look(campaign, task);
		if (task->report.unknown)
			return error_memory(err, sizeof *task);
		task->failed_before =
			task->report.state == RUN_STATE_FAILED || task->report.state == RUN_STATE_DAMAGED;
		task->skipped = task->state == TASK_COMPLETE || task->state == TASK_FAILED;
	}
	campaign_calibrate(campaign);
	return beginning_find(campaign, err);
}

void campaign_clean(struct campaign *campaign)
{
	for (size_t i = 0; campaign->tasks && i < campaign->experiment->run_count; i++)
		free(campaign->tasks[i].from);
	free(campaign->tasks);
	campaign->tasks = NULL;
}

int campaign_execute(struct campaign *campaign, const struct executor *executor, struct error *err)
{
	TRY(file_make_folders(campaign->experiment->folder, err));
	return executor->execute(campaign, err);
}

size_t campaign_count(const struct campaign *campaign, enum task_state state)
{
	size_t count = 0;

	for (size_t i = 0; i < campaign->experiment->run_count; i++)
		count += campaign->tasks[i].state == state;
	return count;
}

/* Of a run that failed: what is wrong with its files has a code of its own. */
static int task_code(const struct task *task)
{
	bool files = task->code == EX_IOERR || task->code == EX_CANTCREAT || task->code == EX_DATAERR;

	return files ? task->code : EX_FAILED;
}

int campaign_code(const struct campaign *campaign)
{
	size_t ended = campaign_count(campaign, TASK_COMPLETE) + campaign_count(campaign, TASK_FAILED) +
				   campaign_count(campaign, TASK_QUEUED) + campaign_count(campaign, TASK_LEFT);
	int worst = 0;

	if (campaign->fault.code)
		return campaign->fault.code;
	if (campaign->gave_up && !campaign->stopping)
		return EX_FAILED;
	if (ended < campaign->experiment->run_count)
		return EX_INTERRUPTED;
	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		int code = campaign->tasks[i].state == TASK_FAILED ? task_code(&campaign->tasks[i]) : 0;

		worst = code > worst ? code : worst;
	}
	return worst;
}

void campaign_calibrate(struct campaign *campaign)
{
	double took = 0, expected = 0;

	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		const struct task *task = &campaign->tasks[i];

		if (task->report.state != RUN_STATE_COMPLETE || !(task->report.cpu_seconds > 0))
			continue;
		took += task->report.cpu_seconds;
		expected += task->cost;
	}
	campaign->scale = expected > 0 ? took / expected : 1;
}

void campaign_look(struct campaign *campaign)
{
	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		struct task *task = &campaign->tasks[i];
		enum task_state before = task->state;

		if (before == TASK_COMPLETE)
			continue;
		task->state = TASK_WAITING;
		task_look(campaign, task);
		if (task->report.unknown) /* as before; the next look may tell */
			task->state = before;
	}
	campaign_calibrate(campaign);
}

int campaign_ask_queue(struct campaign *campaign, struct error *err)
{
	size_t runs = campaign->experiment->run_count;
	struct queue_entry *entries = calloc(runs, sizeof *entries);
	int result;

	if (!entries)
		return error_memory(err, runs * sizeof *entries);
	result = executor_queue(campaign->experiment, entries, err);
	for (size_t i = 0; result == 0 && i < runs; i++)
		campaign->tasks[i].queue = entries[i];
	free(entries);
	return result;
}

double campaign_task_left(const struct campaign *campaign, const struct task *task)
{
	double expected = task->cost * campaign->scale, share = 0;

	if (task->state == TASK_COMPLETE || task->state == TASK_FAILED || task->state == TASK_LEFT)
		return 0;
	if (task->report.time > 0)
		share = fmin(task->report.time / task->run->config.time.end, 1);
	/* one that has taken more than all that was expected still has something left */
	return fmax(
		expected - (share > 0 ? task->report.cpu_seconds : 0), 0.1 * expected * (1 - share));
}

void campaign_work(const struct campaign *campaign, double *done, double *all)
{
	double left = 0;

	*all = 0;
	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		if (campaign->tasks[i].state == TASK_LEFT)
			continue;
		*all += campaign->tasks[i].cost * campaign->scale;
		left += campaign_task_left(campaign, &campaign->tasks[i]);
	}
	*done = fmax(*all - left, 0);
}

/* Does `name` mean this run: its id, the beginning of it, its folder, or digits of its hash? */
static bool is_meant(const struct experiment_run *run, const char *name, bool exactly)
{
	size_t length = strlen(name);
	const char *hash = strrchr(run->id, '-');

	if (!strcmp(run->id, name) || !strcmp(run->folder, name))
		return true;
	if (!strncmp(run->folder, name, length - 1) && name[length - 1] == '/' &&
		strlen(run->folder) == length - 1)
		return true;
	return !exactly && (!strncmp(run->id, name, length) ||
						   (length >= 4 && hash && !strncmp(run->hash, name, length)));
}

int campaign_find_run(
	const struct experiment *experiment, const char *name, size_t *index, struct error *err)
{
	size_t found = 0;
	char shown[160];

	if (!*name)
		return error_set(err, EX_DATAERR, "the name of a run is empty");
	(void)text_excerpt(name, shown, sizeof shown);
	for (int exactly = 1; exactly >= 0 && !found; exactly--)
		for (size_t i = 0; i < experiment->run_count; i++)
			if (is_meant(&experiment->runs[i], name, exactly)) {
				*index = i;
				found++;
			}
	if (found == 1)
		return 0;
	return error_at(err, EX_DATAERR, experiment->path, 0, 0,
		found ? "%s fits %zu runs; write more of the name" : "has no run '%s'", shown, found);
}

int campaign_select_failed(
	struct campaign *campaign, char *const *names, int count, struct error *err)
{
	size_t runs = campaign->experiment->run_count, index = 0;
	bool *named = calloc(runs, sizeof *named);
	int result = 0;

	if (!named)
		return error_memory(err, runs * sizeof *named);
	for (int i = 0; !result && i < count; i++) {
		result = campaign_find_run(campaign->experiment, names[i], &index, err);
		named[index] = true;
	}
	for (size_t i = 0; !result && i < runs; i++)
		if (!campaign->tasks[i].failed_before || (count && !named[i]))
			campaign->tasks[i].state = TASK_LEFT;
	free(named);
	return result;
}

int campaign_cancel(const struct experiment *experiment, struct error *err)
{
	char stamp[CLOCK_STAMP_SIZE], host[BUILD_HOST_SIZE],
		text[CLOCK_STAMP_SIZE + BUILD_HOST_SIZE + 64];
	int length = snprintf(text, sizeof text, "cancelled at %s by process %ld on %s\n",
		clock_stamp(stamp), (long)getpid(), build_host(host));

	return file_replace(&(struct file_place){.folder = experiment->folder, .name = CAMPAIGN_CANCEL},
		&(struct file_part){text, (size_t)length}, 1, err);
}

void campaign_log_end(const struct experiment_run *run, int lines, struct text *out)
{
	struct text path = {0};
	struct error err = {0};
	unsigned char *bytes = NULL;
	size_t size = 0, start;

	if (!file_path(&path, run->folder, "run.log", &err) &&
		!file_read(path.data, &bytes, &size, &err)) {
		while (size && bytes[size - 1] == '\n')
			size--;
		for (start = size; start; start--)
			if (bytes[start - 1] == '\n' && --lines == 0)
				break;
		text_add_bytes(out, (const char *)bytes + start, size - start);
		if (size)
			text_add(out, "\n");
	}
	text_tame(out->data);
	out->failed |= err.code == EX_SOFTWARE;
	free(bytes);
	text_clean(&path);
}
