/* Runs in local coordinates beside runs in Cartesian ones (P2 4.1). */
#include <math.h>
#include <stdlib.h>

#include "case/turn.h"
#include "tables/metric_parts.h"

int metric_turn_thickness(const struct sample *sample, double **h, size_t *cells, struct error *err)
{
	struct grid grid = grid_make(sample->partner_config);
	struct dataset x = {0}, b = {0};
	double *turned = malloc((size_t)grid.cells * sizeof *turned);
	int result = -1;

	if (!turned)
		return error_memory(err, (size_t)grid.cells * sizeof *turned);
	if (metric_read(sample->file, "x", &x, err) || metric_read(sample->file, "b", &b, err))
		goto done;
	if (metric_count(&x) != *cells || metric_count(&b) != *cells) {
		(void)error_set(err, EX_DATAERR, "datasets 'x', 'b' and 'h' have different lengths");
		goto done;
	}
	result = turn_profile(sample->config, x.values, b.values, *h, (int)*cells, &grid, turned, err);
	if (!result) {
		free(*h);
		*h = turned;
		*cells = (size_t)grid.cells;
		turned = NULL;
	}
done:
	free(turned);
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

	TRY(metric_read_series(file, name, &time, &data, err));
	count = metric_count(&time);
	if (at < time.values[0] || at > time.values[count - 1])
		(void)error_set(err, EX_DATAERR, "'%s' has no value at %g s", name, at);
	while (i + 1 < count && time.values[i + 1] < at)
		i++;
	*out = data.values[i];
	if (i + 1 < count)
		*out += (data.values[i + 1] - data.values[i]) * (at - time.values[i]) /
				(time.values[i + 1] - time.values[i]);
	free(time.values);
	free(data.values);
	return err->code ? -1 : 0;
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
