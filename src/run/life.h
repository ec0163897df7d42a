/* A run's life with any model: run_execute is this with the model that the config names. */
#ifndef TALUS_LIFE_H
#define TALUS_LIFE_H

#include "talus/model.h"
#include "talus/run.h"

int run_execute_model(const struct model *model, const struct config *config, const char *folder,
	const struct run_options *options, struct error *err);

#endif
