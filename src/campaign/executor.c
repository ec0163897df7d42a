/* The ways in which a campaign executes its runs. */
#include <string.h>

#include "campaign/local.h"
#include "campaign/slurm.h"
#include "talus/campaign.h"

static const struct executor executors[] = {
	{.name = "local", .execute = local_execute},
	{"slurm", slurm_execute, slurm_plan, slurm_queue, slurm_cancel},
};

const struct executor *executor_find(const char *name)
{
	for (size_t i = 0; i < sizeof executors / sizeof *executors; i++)
		if (!strcmp(name, executors[i].name))
			return &executors[i];
	return NULL;
}

int executor_queue(
	const struct experiment *experiment, struct queue_entry *entries, struct error *err)
{
	for (size_t i = 0; i < sizeof executors / sizeof *executors; i++)
		if (executors[i].queue)
			TRY(executors[i].queue(experiment, entries, err));
	return 0;
}

int executor_cancel(const struct experiment *experiment, size_t *count, struct error *err)
{
	size_t taken;

	*count = 0;
	for (size_t i = 0; i < sizeof executors / sizeof *executors; i++)
		if (executors[i].cancel) {
			TRY(executors[i].cancel(experiment, NULL, &taken, err));
			*count += taken;
		}
	return 0;
}
