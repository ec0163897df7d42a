/* The ways in which a campaign executes its runs. */
#include <string.h>

#include "campaign/local.h"
#include "talus/campaign.h"

static const struct executor executors[] = {
	{"local", local_execute},
};

const struct executor *executor_find(const char *name)
{
	for (size_t i = 0; i < sizeof executors / sizeof *executors; i++)
		if (!strcmp(name, executors[i].name))
			return &executors[i];
	return NULL;
}
