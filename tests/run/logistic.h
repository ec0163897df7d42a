/* A model for tests: a logistic map per cell, chaotic, so that one lost bit shows within 60 steps, and
 * exact, so that a run takes milliseconds. Steps depend on the state. What it does beside flowing is
 * asked for in `logistic`. */
#ifndef TALUS_TEST_LOGISTIC_H
#define TALUS_TEST_LOGISTIC_H

#include <ftw.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <setjmp.h> /* what cmocka needs */
#include <stddef.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/stop.h"
#include "run/compare.h"
#include "run/life.h"
#include "run/run_file_parts.h"

/* Steps, counted from 1, at which something happens; 0: never. */
static struct {
	uint64_t fail, vanish, raise_at[2]; /* fail; the time step becomes NaN; raise `number` */
	uint64_t lose;                      /* mass from here on */
	int number;
} logistic;

struct model_state {
	int cells, layers;
	double *value;   /* [layers][cells] */
	double count[2]; /* steps done, sum of what was lost */
	double *axis;
};

static const struct series logistic_series[] = {
	{.name = "front_position", .units = "m", .long_name = "value of the last cell", .slope_of = -1},
	{.name = "front_velocity",
		.units = "m s-1",
		.long_name = "slope of that over 0.05 s",
		.slope_of = 0,
		.window = 0.05},
	{.name = "late", .units = "m", .long_name = "as the front, from step 5 on", .slope_of = -1},
	{.name = "late_velocity",
		.units = "m s-1",
		.long_name = "slope of that over 0.02 s",
		.slope_of = 2,
		.window = 0.02},
	{.name = "steps",
		.units = "1",
		.long_name = "steps",
		.whole = true,
		.slope_of = -1,
		.per_step_sum = true},
	{.name = "mass", .units = "kg", .long_name = "mass", .slope_of = -1},
	{.name = "mass_outflow", .units = "kg", .long_name = "mass lost", .slope_of = -1},
	{.name = "cpu_noise",
		.units = "s",
		.long_name = "never twice the same",
		.slope_of = -1,
		.per_step_sum = true},
};

static const struct profile logistic_profiles[] = {
	{"b", "m", "bed", PROFILE_X, true},
	{"h", "m", "first layer", PROFILE_X, false},
	{"u", "m s-1", "values", PROFILE_LAYER_X, false},
	{"p", "Pa", "values at interfaces", PROFILE_INTERFACE_X, false},
};

static void logistic_free(struct model_state *s)
{
	if (!s)
		return;
	free(s->value);
	free(s->axis);
	free(s);
}

static int logistic_create(const struct config *config, struct model_state **out, struct error *err)
{
	struct model_state *s = calloc(1, sizeof *s);
	size_t cells = (size_t)config->domain.cells, layers = (size_t)config->layers;

	if (!s)
		return error_memory(err, sizeof *s);
	s->cells = config->domain.cells;
	s->layers = config->layers;
	s->value = calloc(cells * layers, sizeof *s->value);
	s->axis = calloc(cells + 2 * layers + 1, sizeof *s->axis);
	if (!s->value || !s->axis) {
		logistic_free(s);
		return error_memory(err, cells);
	}
	for (size_t i = 0; i < cells * layers; i++)
		s->value[i] = 0.1 + 0.8 * (double)i / (double)(cells * layers);
	for (size_t i = 0; i < cells + 2 * layers + 1; i++)
		s->axis[i] = (double)i;
	*out = s;
	return 0;
}

static double logistic_time_step(const struct model_state *s)
{
	if (logistic.vanish && s->count[0] + 1 >= (double)logistic.vanish)
		return NAN;
	return 0.01 * (1 + 0.5 * s->value[0]);
}

static int logistic_step(struct model_state *s, double dt, struct error *err)
{
	s->count[0]++;
	for (int i = 0; i < 2; i++)
		if (logistic.raise_at[i] && s->count[0] == (double)logistic.raise_at[i])
			(void)raise(logistic.number);
	for (int i = 0; i < s->cells * s->layers; i++)
		s->value[i] = 3.99 * s->value[i] * (1 - s->value[i]) + 1e-3 * dt;
	s->count[1] = s->count[0] / 1024;
	if (logistic.fail && s->count[0] == (double)logistic.fail)
		return error_set(err, EX_FAILED, "negative thickness -1 m at x = 3 m");
	return 0;
}

static void logistic_observe(const struct model_state *s, double *values)
{
	values[0] = s->value[s->cells - 1];
	values[2] = s->count[0] < 5 ? NAN : s->value[s->cells - 1];
	values[4] = s->count[0] > 0;
	values[5] = 1024 - s->count[1] - (logistic.lose && s->count[0] >= (double)logistic.lose);
	values[6] = s->count[1];
	values[7] = clock_wall();
}

static void logistic_profile(const struct model_state *s, size_t index, double *values)
{
	static const int rows[] = {0, 1};
	int count = index < 2 ? rows[index] : s->layers + (index == 3);

	for (int a = 0; a < s->cells && index == 0; a++)
		values[a] = a;
	for (int i = 0; i < count * s->cells; i++)
		values[i] = s->value[i % (s->layers * s->cells)] + (double)index;
}

static struct axes logistic_axes(const struct model_state *s)
{
	return (struct axes){
		s->cells, s->layers, s->axis, s->axis + s->cells, s->axis + s->cells + s->layers};
}

static size_t logistic_arrays(struct model_state *s, struct array *list)
{
	list[0] = (struct array){"value", s->value, {(size_t)s->layers, (size_t)s->cells}};
	list[1] = (struct array){"count", s->count, {1, 2}};
	return 2;
}

static void logistic_restored(struct model_state *s)
{
	(void)s;
}

static const struct model logistic_model = {
	.name = "logistic",
	.numerics_version = 7,
	.series = logistic_series,
	.series_count = sizeof logistic_series / sizeof *logistic_series,
	.profiles = logistic_profiles,
	.profile_count = sizeof logistic_profiles / sizeof *logistic_profiles,
	.create = logistic_create,
	.time_step = logistic_time_step,
	.step = logistic_step,
	.observe = logistic_observe,
	.profile = logistic_profile,
	.axes = logistic_axes,
	.arrays = logistic_arrays,
	.restored = logistic_restored,
	.free = logistic_free,
};

/* A small config with "key=value" texts separated by ';'. */
static inline struct config logistic_config(const char *settings)
{
	static const char text[] =
		"slope: 22 deg\nerodible_bed_thickness: 1 mm\nlayers: 3\nn_ini_guess: 0\n"
		"domain: {x_min: 0 m, x_max: 1 m, cells: 16}\ninitial: {height: 0.1 m, front: 0.5 m}\n"
		"time: {end: 1 s}\noutput: {profiles_at: [0.1 s, 0.3 s]}\ncheckpoint: {every: 0 s}\n";
	char copy[1024], *rest;
	const char *list[16];
	struct error err = {0};
	struct config config;
	int count = 0;

	(void)snprintf(copy, sizeof copy, "%s", settings);
	for (char *one = strtok_r(copy, ";", &rest); one; one = strtok_r(NULL, ";", &rest))
		list[count++] = one;
	if (config_parse(&config, text, sizeof text - 1, "test.yaml", list, count, &err) != 0)
		fail_msg("%s", err.text);
	return config;
}

static const struct model *model_in_use = &logistic_model;

/* A folder of its own for each test, made by the setup and removed by the teardown. */
static char folder[] = "/tmp/talus-test-XXXXXX";

static inline int remove_entry(const char *path, const struct stat *st, int kind, struct FTW *at)
{
	(void)st;
	(void)kind;
	(void)at;
	return remove(path);
}

static inline int make_folder(void **state)
{
	(void)state;
	memset(&logistic, 0, sizeof logistic);
	model_in_use = &logistic_model;
	memcpy(folder + sizeof folder - 7, "XXXXXX", 6);
	return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
	(void)state;
	return nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

/* folder/name in one of eight static buffers */
static inline const char *in_folder(const char *name)
{
	static char buffers[8][128];
	static int next;
	char *buffer = buffers[next++ % 8];

	(void)snprintf(buffer, sizeof buffers[0], "%s/%s", folder, name);
	return buffer;
}

static inline int execute(
	const struct config *config, const char *name, bool retry, struct error *err)
{
	const struct run_options options = {.retry = retry};

	return run_execute_model(model_in_use, config, in_folder(name), &options, err);
}

/* The same in a process of its own, because a stop stays asked for. Returns its exit code, or minus
 * the signal that ended it. */
static inline int execute_in_child(const struct config *config, const char *name, bool retry)
{
	int status;
	pid_t pid;

	(void)fflush(NULL);
	pid = fork();
	assert_true(pid >= 0);
	if (pid == 0) {
		struct error err = {0};

		stop_install();
		_exit(execute(config, name, retry, &err) ? err.code : 0);
	}
	assert_int_equal(waitpid(pid, &status, 0), pid);
	return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/* Fails the test unless the command succeeds. */
static inline void must_execute(const struct config *config, const char *name)
{
	struct error err = {0};

	if (execute(config, name, false, &err) != 0)
		fail_msg("%s", err.text);
}

static inline struct run_file *open_run(const char *name)
{
	struct run_file *file = NULL;
	struct text warning = {0};
	struct error err = {0};

	if (run_file_open_any(in_folder(name), &file, &warning, &err) != 0)
		fail_msg("%s", err.text);
	text_clean(&warning);
	return file;
}

static inline struct dataset read_dataset(const char *name, const char *path)
{
	struct run_file *file = open_run(name);
	struct dataset data;
	struct error err = {0};

	if (run_file_dataset(file, path, &data, &err) != 0)
		fail_msg("%s", err.text);
	run_file_close(file);
	return data;
}

static inline void assert_same_bits(const char *a, const char *b)
{
	struct run_file *first = open_run(a), *second = open_run(b);
	struct text out = {0};
	struct error err = {0};

	assert_int_equal(compare_run_files(first, second, &out, &err), 0);
	if (out.length)
		fail_msg("%s and %s differ:\n%s", a, b, out.data);
	text_clean(&out);
	run_file_close(first);
	run_file_close(second);
}

#endif
