#include "talus/campaign.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "campaign/task.h"

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
		task_look(campaign, task);
		task->skipped = task->state == TASK_COMPLETE || task->state == TASK_FAILED;
	}
	return 0;
}

void campaign_clean(struct campaign *campaign)
{
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

int campaign_code(const struct campaign *campaign)
{
	size_t ended = campaign_count(campaign, TASK_COMPLETE) + campaign_count(campaign, TASK_FAILED) +
				   campaign_count(campaign, TASK_QUEUED);

	if (ended < campaign->experiment->run_count)
		return EX_INTERRUPTED;
	return campaign_count(campaign, TASK_FAILED) ? EX_FAILED : 0;
}

void campaign_work(const struct campaign *campaign, double *done, double *all)
{
	*done = *all = 0;
	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		const struct task *task = &campaign->tasks[i];
		const struct config *config = &task->run->config;
		double weight = (double)config->domain.cells * config->layers;
		bool ended = task->state == TASK_COMPLETE || task->state == TASK_FAILED;

		*all += weight * config->time.end;
		*done += weight * (ended ? config->time.end : task->report.time);
	}
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
	free(bytes);
	text_clean(&path);
}
