#include "campaign/order.h"

#include <stdint.h>
#include <stdlib.h>

/* A task by what is left of it and of all that waits for it. */
struct turn {
	struct task *task;
	double left;
};

/* The longest expected first, so that none is left alone at the end; of equals, the first. */
static int compare_turns(const void *a, const void *b)
{
	const struct turn *x = a, *y = b;

	if (x->left != y->left)
		return x->left < y->left ? 1 : -1;
	return (x->task > y->task) - (x->task < y->task);
}

struct task **campaign_order(const struct campaign *campaign, struct error *err)
{
	size_t count = campaign->experiment->run_count;
	struct turn *turns = calloc(count, sizeof *turns);
	struct task **order = calloc(count, sizeof(struct task *));

	if (!order || !turns) {
		free(turns);
		free(order);
		error_memory(err, count * sizeof *turns);
		return NULL;
	}
	for (size_t i = 0; i < count; i++)
		turns[i].task = &campaign->tasks[i];
	for (size_t i = 0; i < count; i++) {
		double left = campaign_task_left(campaign, &campaign->tasks[i]);

		for (size_t k = i; k != SIZE_MAX; k = campaign->tasks[k].before)
			turns[k].left = left > turns[k].left ? left : turns[k].left;
	}
	if (!campaign->options.in_order && !campaign->experiment->timing)
		qsort(turns, count, sizeof *turns, compare_turns);
	for (size_t i = 0; i < count; i++)
		order[i] = turns[i].task;
	free(turns);
	return order;
}
