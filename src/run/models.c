#include "talus/model.h"

static const struct model *const models[] = {
	[MODEL_DRY] = &dry_model,
	[MODEL_IMMERSED] = &immersed_model,
};

const struct model *model_find(const struct config *config)
{
	return models[config->model];
}
