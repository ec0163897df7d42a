/* Wall clock of one checkpoint, fsyncs included, against the limits that the project promises. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "run/checkpoint.h"
#include "run/run_file_parts.h"

enum { TIMES = 5 };

/* The middle of TIMES checkpoints, s; negative after an error. */
static double measure(int cells, int layers, const char *folder, struct error *err)
{
	static const char text[] = "slope: 22 deg\nerodible_bed_thickness: 1 mm\nlayers: 1\n"
							   "n_ini_guess: 0\ninitial: {height: 0.1 m, front: 0 m}\n"
							   "domain: {x_min: -1 m, x_max: 1 m, cells: 10}\n"
							   "time: {end: 1 s}\n";
	const struct run_options options = {0};
	struct attempt attempt = {.folder = folder, .options = &options, .number = 1};
	const struct recorder_step last = {.to = 1, .last = true};
	double times[TIMES], result = -1;
	struct config config;
	struct axes axes;

	if (config_parse(&config, text, sizeof text - 1, "bench.yaml", NULL, 0, err) != 0)
		return -1;
	config.domain.cells = cells;
	config.layers = layers;
	attempt.config = &config;
	attempt.model = model_find(&config);
	if (attempt.model->create(&config, &attempt.state, err) != 0)
		return -1;
	axes = attempt.model->axes(attempt.state);
	if (recorder_create(attempt.model, &config, &axes, &attempt.recorder, err) != 0 ||
		recorder_begin(attempt.recorder, attempt.state, err) != 0 ||
		recorder_after(attempt.recorder, attempt.state, &last, err) != 0)
		goto done;
	for (int i = 0; i < TIMES; i++) {
		double begin = clock_wall();
		int place = i;

		if (checkpoint_write(&attempt, RUN_UNFINISHED, err) != 0)
			goto done;
		begin = clock_wall() - begin;
		for (; place > 0 && times[place - 1] > begin; place--)
			times[place] = times[place - 1];
		times[place] = begin;
	}
	result = times[TIMES / 2];
done:
	recorder_free(attempt.recorder);
	attempt.model->free(attempt.state);
	return result;
}

int main(void)
{
	static const struct {
		int cells, layers;
		double limit; /* s */
	} cases[] = {{640, 20, 0.03}, {6400, 128, 1.5}};
	char folder[] = "bench-checkpoint-XXXXXX", path[128];
	int code = 0;

	if (!mkdtemp(folder)) {
		perror("bench_checkpoint");
		return EX_CANTCREAT;
	}
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		struct error err = {0};
		double time = measure(cases[i].cells, cases[i].layers, folder, &err);

		if (time < 0) {
			(void)fprintf(stderr, "bench_checkpoint: %s\n", err.text);
			code = err.code;
			break;
		}
		printf("checkpoint %d x %d: %.1f ms, limit %.0f ms%s\n", cases[i].cells, cases[i].layers,
			1e3 * time, 1e3 * cases[i].limit, time < cases[i].limit ? "" : " - EXCEEDED");
		code |= time >= cases[i].limit;
	}
	for (int i = 0; i < 2; i++) {
		(void)snprintf(path, sizeof path, "%s/%s", folder, i ? RUN_FILE_PREVIOUS : RUN_FILE_NEWEST);
		(void)unlink(path);
	}
	(void)rmdir(folder);
	return code;
}
