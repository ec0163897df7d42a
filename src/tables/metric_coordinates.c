/* Runs in local coordinates beside runs in Cartesian ones (P2 4.1). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "case/topography.h"
#include "case/turn.h"
#include "tables/metric_parts.h"

static struct turn turn_of(const struct config *config)
{
	return config->coordinates == COORDINATES_CARTESIAN ? turn_to_local(config->slope)
														: turn_to_cartesian(config->slope);
}

/* Bed and surface above the reference plane in the middle of the cells, as the run has them. */
static void outline(const struct config *config, const struct dataset *x, const double *b,
	const double *h, double *bed, double *surface)
{
	for (size_t i = 0; i < metric_count(x); i++) {
		bed[i] = b[i];
		if (config->coordinates == COORDINATES_CARTESIAN)
			bed[i] -= topography_plane(config, x->values[i]);
		surface[i] = bed[i] + h[i];
	}
}

int metric_turn_thickness(const struct sample *sample, double **h, size_t *cells, struct error *err)
{
	struct grid grid = grid_make(sample->partner_config);
	struct turn turn = turn_of(sample->config);
	struct dataset x = {0}, b = {0};
	double *memory = calloc(2 * *cells + 2 * grid.stride, sizeof *memory);
	double *bed = memory, *surface = bed + *cells, *below = surface + *cells;
	double *above = below + grid.stride;
	int result = -1;

	if (!memory)
		return error_memory(err, 2 * (*cells + grid.stride) * sizeof *memory);
	if (metric_read(sample->file, "x", &x, err) || metric_read(sample->file, "b", &b, err))
		goto done;
	if (metric_count(&x) != *cells || metric_count(&b) != *cells) {
		(void)error_set(err, EX_DATAERR, "datasets 'x', 'b' and 'h' have different lengths");
		goto done;
	}
	outline(sample->config, &x, b.values, *h, bed, surface);
	turn_add(&turn, x.values, bed, (int)*cells, &grid, below);
	turn_add(&turn, x.values, surface, (int)*cells, &grid, above);
	for (int i = 1; i <= grid.cells; i++)
		below[i - 1] = above[i] - below[i];
	free(*h);
	*h = memory;
	memmove(memory, below, (size_t)grid.cells * sizeof *memory);
	*cells = (size_t)grid.cells;
	memory = NULL;
	result = 0;
done:
	free(memory);
	free(x.values);
	free(b.values);
	return result;
}

/* A series at a time, between its values. */
static int series_at(
	struct run_file *file, const char *name, double at, double *out, struct error *err)
{
	struct dataset time = {0}, data = {0};
	size_t i = 0, count;
	int result = -1;

	if (metric_read(file, "time", &time, err) || metric_read(file, name, &data, err))
		goto done;
	count = metric_count(&time);
	if (metric_count(&data) != count || at < time.values[0] || at > time.values[count - 1]) {
		(void)error_set(err, EX_DATAERR, "'%s' has no value at %g s", name, at);
		goto done;
	}
	while (i + 1 < count && time.values[i + 1] < at)
		i++;
	*out = data.values[i];
	if (i + 1 < count)
		*out += (data.values[i + 1] - data.values[i]) * (at - time.values[i]) /
				(time.values[i + 1] - time.values[i]);
	result = 0;
done:
	free(time.values);
	free(data.values);
	return result;
}

/* The front at a time, from the gate and along the reference plane; it is on the bed, which is taken to be
 * the plane. */
static int front_way(
	struct run_file *file, const struct config *config, double at, double *out, struct error *err)
{
	TRY(series_at(file, "front_position", at, out, err));
	*out -= config->initial.front;
	if (config->coordinates == COORDINATES_CARTESIAN)
		*out /= cos(config->slope);
	return 0;
}

int metric_front_difference(const struct sample *sample, double *out, struct error *err)
{
	double here, there;

	TRY(front_way(sample->file, sample->config, sample->at, &here, err));
	TRY(front_way(sample->partner, sample->partner_config, sample->at, &there, err));
	if (there <= 0)
		return error_set(
			err, EX_DATAERR, "the front of the reference has not moved: nothing to be relative to");
	*out = 100 * fabs(here - there) / there;
	return 0;
}
