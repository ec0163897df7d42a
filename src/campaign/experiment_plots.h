/* The `plots` of an experiment file. */
#ifndef TALUS_EXPERIMENT_PLOTS_H
#define TALUS_EXPERIMENT_PLOTS_H

#include "campaign/reader.h"

int experiment_plots_read(
	const struct reader *reader, const struct node *node, struct experiment *experiment);

void experiment_plots_clean(struct experiment *experiment);

#endif
