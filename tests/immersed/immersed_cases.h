/* The flows of P4 Tables 1 and 2, and steps of the model without a run around them. */
#ifndef TALUS_TEST_IMMERSED_CASES_H
#define TALUS_TEST_IMMERSED_CASES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "immersed/immersed.h"

#define COMMON                                                                                     \
	"model: immersed\n"                                                                            \
	"grains: {diameter: 160 um, density: 2500 kg/m3}\n"                                            \
	"rheology: {law: linear, mu_s: 0.415, k_1: 90.5, mu_2: 0.8, i_0: 0.005}\n"                     \
	"dilatancy: {k: 4.09, k_2: 25, critical_fraction: 0.582}\n"
#define LOW                                                                                        \
	COMMON "slope: 28 deg\nlayers: 20\nfluid: {density: 1026, viscosity: 9.8e-3}\n"                \
		   "time.end: 300 s\ninitial: {height: 6.1 mm, solid_fraction: "
#define HIGH                                                                                       \
	COMMON "slope: 25 deg\nlayers: 20\nfluid: {density: 1041, viscosity: 96e-3}\n"                 \
		   "time.end: 8000 s\ninitial: {height: 4.9 mm, solid_fraction: "

static const char low_dense[] = LOW "0.592}\n", low_loose[] = LOW "0.576}\n",
				  high_dense[] = HIGH "0.588}\n", high_loose[] = HIGH "0.562}\n";

/* A config with "key=value" texts separated by ';'. */
static inline struct config case_config(const char *text, const char *settings)
{
	const char *list[16];
	char copy[1024], *rest;
	struct config config;
	struct error err = {0};
	int count = 0;

	(void)snprintf(copy, sizeof copy, "%s", settings);
	for (char *item = strtok_r(copy, ";", &rest); item; item = strtok_r(NULL, ";", &rest))
		list[count++] = item;
	if (config_parse(&config, text, strlen(text), "case", list, count, &err))
		fail_msg("%s", err.text);
	return config;
}

static inline struct model_state *case_create(const struct config *config)
{
	struct model_state *s = NULL;
	struct error err = {0};

	if (immersed_model.create(config, &s, &err))
		fail_msg("%s", err.text);
	return s;
}

static inline double case_observed(const struct model_state *s, const char *name)
{
	double values[IMMERSED_SERIES_COUNT];

	immersed_model.observe(s, values);
	for (size_t i = 0; i < IMMERSED_SERIES_COUNT; i++)
		if (!strcmp(immersed_series[i].name, name))
			return values[i];
	fail_msg("no series %s", name);
	return 0;
}

/* One step, not beyond `end`. Returns the time after it. */
static inline double case_step(struct model_state *s, double t, double end)
{
	double left = end - t, dt = fmin(immersed_model.time_step(s), left);
	struct error err = {0};

	if (immersed_model.step(s, dt, &err))
		fail_msg("t = %g: %s", t, err.text);
	return immersed_model.taken(s) == left ? end : t + immersed_model.taken(s);
}

static inline void case_advance(struct model_state *s, double t, double end)
{
	while (t < end)
		t = case_step(s, t, end);
}

/* The state at `end`. */
static inline struct model_state *case_run(const char *text, const char *settings, double end)
{
	struct config config = case_config(text, settings);
	struct model_state *s = case_create(&config);

	case_advance(s, 0, end > 0 ? end : config.time.end);
	return s;
}

#endif
