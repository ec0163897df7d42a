#include "talus/model.h"

static const struct model *const models[] = {
	[MODEL_DRY] = &dry_model,
	[MODEL_IMMERSED] = &immersed_model,
};

const struct model *model_find(const struct config *config)
{
	return models[config->model];
}

double model_cost(const struct config *config)
{
	const struct model *model = model_find(config);

	if (model->cost)
		return model->cost(config);
	return 1e-5 * config->domain.cells * config->layers * config->time.end / config->time.cfl;
}
