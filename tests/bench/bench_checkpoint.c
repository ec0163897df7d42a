/* Wall clock of one checkpoint with its fsyncs, in a folder of the current directory: a 640 x 20 state
 * (promise: under 30 ms) and a 6400 x 128 one (under 1.5 s). Median and range of the repeats. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "run/checkpoint.h"

enum { REPEATS = 11 };

static int compare(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

/* A run of this size that has taken one step. */
static int begin(struct attempt *attempt, const struct config *config, struct error *err)
{
	struct recorder_step step = {.dt = 1e-4, .to = 1e-4};
	struct axes axes;

	TRY(attempt->model->create(config, &attempt->state, err));
	axes = attempt->model->axes(attempt->state);
	TRY(recorder_create(attempt->model, config, &axes, &attempt->recorder, err));
	TRY(recorder_begin(attempt->recorder, attempt->state, err));
	TRY(attempt->model->step(attempt->state, step.dt, err));
	return recorder_after(attempt->recorder, attempt->state, &step, err);
}

static int measure(const char *folder, int cells, int layers, struct error *err)
{
	char text[256], path[512];
	struct config config;
	struct run_options options = {0};
	struct attempt attempt = {.config = &config, .folder = folder, .options = &options};
	double wall[REPEATS];
	unsigned char *bytes = NULL;
	size_t size = 0;
	int result;

	(void)snprintf(text, sizeof text,
		"slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: %d\ndomain: {cells: %d}\n"
		"pressure_solver: {tolerance: 1}\n",
		layers, cells);
	TRY(config_parse(&config, text, strlen(text), "bench", NULL, 0, err));
	attempt.model = model_find(&config);
	result = begin(&attempt, &config, err);
	for (int i = 0; result == 0 && i < REPEATS; i++) {
		double start = clock_wall();

		result = checkpoint_write(&attempt, RUN_UNFINISHED, err);
		wall[i] = clock_wall() - start;
	}
	(void)snprintf(path, sizeof path, "%s/run.h5", folder);
	if (result == 0)
		result = file_read(path, &bytes, &size, err);
	if (result == 0) {
		qsort(wall, REPEATS, sizeof *wall, compare);
		(void)printf("checkpoint of %4d x %3d: %7.1f ms (%.1f to %.1f, %d times), %.1f MB\n", cells,
			layers, 1e3 * wall[REPEATS / 2], 1e3 * wall[0], 1e3 * wall[REPEATS - 1], REPEATS,
			1e-6 * (double)size);
	}
	free(bytes);
	recorder_free(attempt.recorder);
	attempt.model->free(attempt.state);
	(void)unlink(path);
	(void)snprintf(path, sizeof path, "%s/run.previous.h5", folder);
	(void)unlink(path);
	return result;
}

int main(void)
{
	char folder[] = "bench-checkpoint-XXXXXX", message[3072];
	struct error err = {0};

	if (!mkdtemp(folder)) {
		perror(folder);
		return EX_CANTCREAT;
	}
	if (measure(folder, 640, 20, &err) != 0 || measure(folder, 6400, 128, &err) != 0)
		(void)fprintf(stderr, "%s\n", error_format(&err, message, sizeof message));
	(void)rmdir(folder);
	return err.code;
}
