#include "tables/scale.h"

#include <math.h>
#include <string.h>

#define GRAVITY 9.81 /* m/s2, as the models have it */

static double length(const struct config *config)
{
	return config->initial.height;
}

static double duration(const struct config *config)
{
	return sqrt(config->initial.height / (GRAVITY * cos(config->slope)));
}

static double velocity(const struct config *config)
{
	return sqrt(config->initial.height * GRAVITY * cos(config->slope));
}

static const struct scale scales[] = {
	{"m", "h0", "{/:Italic h}_0", length},
	{"s", "tau_c", "{/:Italic τ}_c", duration},
	{"m/s", "v0", "{/:Italic v}_0", velocity},
};

const struct scale *scale_find(const char *name, const char *unit)
{
	if (!strncmp(name, "cpu", 3) || !strncmp(name, "wall", 4))
		return NULL;
	for (size_t i = 0; i < sizeof scales / sizeof *scales; i++)
		if (!strcmp(scales[i].unit, unit))
			return &scales[i];
	return NULL;
}
