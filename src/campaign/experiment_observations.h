/* The `observations` of an experiment file. */
#ifndef TALUS_EXPERIMENT_OBSERVATIONS_H
#define TALUS_EXPERIMENT_OBSERVATIONS_H

#include "campaign/reader.h"

int experiment_observations_read(
	const struct reader *reader, const struct node *node, struct experiment *experiment);

void experiment_observations_clean(struct experiment *experiment);

#endif
