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

/* The pressure below h_0, J/m and kg/m of h_0 by h_0; the immersed model has its fraction elsewhere. */
static double density(const struct config *config)
{
	double fraction =
		config->model == MODEL_DRY ? config->grains.solid_fraction : config->initial.solid_fraction;

	return fraction * config->grains.density;
}

static double pressure(const struct config *config)
{
	return density(config) * pow(velocity(config), 2);
}

static double energy(const struct config *config)
{
	return pressure(config) * pow(length(config), 2);
}

static double mass(const struct config *config)
{
	return density(config) * pow(length(config), 2);
}

static double power(const struct config *config)
{
	return pressure(config) * velocity(config);
}

static const struct scale scales[] = {
	{"m", "h0", "{/:Italic h}_0", length},
	{"s", "tau_c", "{/:Italic τ}_c", duration},
	{"m/s", "v0", "{/:Italic v}_0", velocity},
	{"Pa", "p0", "{/:Italic p}_0", pressure},
	{"J/m", "E0", "{/:Italic E}_0", energy},
	{"kg/m", "M0", "{/:Italic M}_0", mass},
	{"W/m²", "p0 v0", "({/:Italic p}_0{/:Italic v}_0)", power},
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
