/* The order in which the runs of a campaign begin. */
#ifndef TALUS_ORDER_H
#define TALUS_ORDER_H

#include "talus/campaign.h"

/* All tasks, [run_count], owned by the caller: the longest expected first, or in_order as the experiment
 * has them. NULL with `err` when memory is short. */
struct task **campaign_order(const struct campaign *campaign, struct error *err);

#endif
