/* A small collapse, and steps of the model without a run around them. */
#ifndef TALUS_TEST_DRY_CASES_H
#define TALUS_TEST_DRY_CASES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "dry/chunk.h"
#include "dry/dry.h"

static const char column[] = "slope: 22 deg\n"
							 "erodible_bed_thickness: 1.82 mm\n"
							 "layers: 4\n"
							 "domain: {x_min: -0.2 m, x_max: 1.4 m, cells: 160}\n"
							 "time: {end: 0.3 s, cfl: 0.5}\n";

static inline struct config read_config(const char *const *settings, int count)
{
	struct config config;
	struct error err = {0};

	if (config_parse(&config, column, strlen(column), "column", settings, count, &err))
		fail_msg("%s", err.text);
	return config;
}

static inline struct model_state *create(const struct config *config)
{
	struct model_state *s = NULL;
	struct error err = {0};

	if (dry_model.create(config, &s, &err))
		fail_msg("%s", err.text);
	return s;
}

/* Advance to time.end; fails the test when a step fails. Returns the steps. */
static inline int advance(struct model_state *s, double end)
{
	struct error err = {0};
	double t = 0;
	int steps = 0;

	while (t < end) {
		double dt = fmin(dry_model.time_step(s), end - t);

		if (dry_model.step(s, dt, &err))
			fail_msg("step %d: %s", steps, err.text);
		t = dt == end - t ? end : t + dt;
		steps++;
	}
	return steps;
}

static inline size_t series_index(const char *name)
{
	for (size_t i = 0; i < dry_model.series_count; i++)
		if (!strcmp(dry_model.series[i].name, name))
			return i;
	fail_msg("no series %s", name);
	return 0;
}

static inline size_t profile_index(const char *name)
{
	for (size_t i = 0; i < dry_model.profile_count; i++)
		if (!strcmp(dry_model.profiles[i].name, name))
			return i;
	fail_msg("no profile %s", name);
	return 0;
}

static inline double observed(const struct model_state *s, const char *name)
{
	double values[DRY_SERIES_COUNT];

	dry_model.observe(s, values);
	return values[series_index(name)];
}

#define CASE(...)                                                                                  \
	{                                                                                              \
		(const char *const[]){__VA_ARGS__},                                                        \
			(int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))                     \
	}

#endif
