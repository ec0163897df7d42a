#include "plots/slice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"
#include "talus/text.h"

enum { RANK_MAX = 3 };

static bool axis_is(
	struct run_file *file, const char *name, int axis, const char *wanted, struct error *err)
{
	struct text text = {0};
	bool same = run_file_scale_name(file, name, axis, &text, err) == 0 &&
				!strcmp(text_string(&text), wanted);

	text_clean(&text);
	return same;
}

bool slice_has_axis(struct run_file *file, const char *name, const char *axis, struct error *err)
{
	for (int i = 0; i < RANK_MAX; i++)
		if (axis_is(file, name, i, axis, err))
			return true;
	return false;
}

/* The first of these axes that the dataset has. */
static const char *first_axis(
	struct run_file *file, const char *name, const char *const *axes, struct error *err)
{
	while (*axes && !slice_has_axis(file, name, *axes, err))
		axes++;
	return *axes;
}

const char *slice_layer_axis(struct run_file *file, const char *name, struct error *err)
{
	return first_axis(file, name, (const char *const[]){"layer", "interface", NULL}, err);
}

const char *slice_position_axis(struct run_file *file, const char *name, struct error *err)
{
	return first_axis(file, name, (const char *const[]){"x", "gauge", "station", NULL}, err);
}

const char *slice_time_axis(struct run_file *file, const char *name, struct error *err)
{
	return first_axis(file, name, (const char *const[]){"profile_time", "time", NULL}, err);
}

/* Numbers along one dimension. */
int slice_axis(
	struct run_file *file, const char *axis, double **values, size_t *count, struct error *err)
{
	struct dataset data;

	*values = NULL;
	TRY(run_file_dataset(file, axis, &data, err));
	if (!data.values || data.rank != 1 || !data.extent[0]) {
		free(data.values);
		(void)error_set(err, EX_DATAERR, "axis '%s' is empty or no axis", axis);
		return -1;
	}
	*values = data.values;
	*count = data.extent[0];
	return 0;
}

bool slice_same_time(double stored, double asked)
{
	return fabs(stored - asked) <= 1e-9 * fmax(1, fabs(asked));
}

static int find_nearest(struct run_file *file, const char *axis, double wanted, size_t *index,
	double *found, struct error *err)
{
	double *values = NULL;
	size_t count = 0;

	TRY(slice_axis(file, axis, &values, &count, err));
	*index = isnan(wanted) ? count - 1 : 0;
	for (size_t i = 1; i < count; i++)
		if (fabs(values[i] - wanted) < fabs(values[*index] - wanted))
			*index = i;
	*found = values[*index];
	free(values);
	return 0;
}

static int find_time(struct run_file *file, double time, size_t *index, struct error *err)
{
	double found;

	TRY(find_nearest(file, "profile_time", time, index, &found, err));
	if (!isnan(time) && !slice_same_time(found, time))
		return error_set(err, EX_DATAERR, "no profile at %g s", time);
	return 0;
}

static int find_x(struct run_file *file, double x, size_t count, size_t *index, struct error *err)
{
	double *values;
	bool within;

	if (isnan(x) && count == 1) {
		*index = 0;
		return 0;
	}
	if (isnan(x))
		return error_set(err, EX_DATAERR, "a position is needed: at_x");
	TRY(slice_axis(file, "x", &values, &count, err));
	within = count == 1 || (x >= values[0] - 0.51 * (values[1] - values[0]) &&
							   x <= values[count - 1] + 0.51 * (values[1] - values[0]));
	free(values);
	if (!within)
		return error_set(err, EX_DATAERR, "x = %g m lies outside the domain", x);
	return find_nearest(file, "x", x, index, &(double){0}, err);
}

/* One of the positions of output.gauges or output.velocity_at. */
static int find_position(struct run_file *file, const char *axis, double x, size_t count,
	size_t *index, struct error *err)
{
	double found;

	if (isnan(x) && count > 1)
		return error_set(err, EX_DATAERR, "a position is needed: at_x");
	TRY(find_nearest(file, axis, isnan(x) ? 0 : x, index, &found, err));
	if (!isnan(x) && !slice_same_time(found, x))
		return error_set(err, EX_DATAERR, "no %s at %g m; the nearest is at %g m", axis, x, found);
	return 0;
}

static int find_layer(int layer, bool interface, size_t count, size_t *index, struct error *err)
{
	if (layer == SLICE_TOP || (layer == SLICE_FIRST && !interface))
		*index = count - 1;
	else if (layer == SLICE_FIRST)
		*index = 0;
	else if ((size_t)layer > count)
		return error_set(err, EX_DATAERR, "there is no %s %d among %zu",
			interface ? "interface" : "layer", layer, count);
	else
		*index = (size_t)layer - 1;
	return 0;
}

/* Where along axis `i` the cut is. */
static int find_index(struct run_file *file, const char *name, int i, size_t count,
	const struct slice_place *place, size_t *index, struct error *err)
{
	if (axis_is(file, name, i, "profile_time", err))
		return find_time(file, place->time, index, err);
	if (axis_is(file, name, i, "time", err))
		return find_nearest(file, "time", place->time, index, &(double){0}, err);
	if (axis_is(file, name, i, "gauge", err))
		return find_position(file, "gauge", place->x, count, index, err);
	if (axis_is(file, name, i, "station", err))
		return find_position(file, "station", place->x, count, index, err);
	if (axis_is(file, name, i, "x", err))
		return find_x(file, place->x, count, index, err);
	if (axis_is(file, name, i, "layer", err))
		return find_layer(place->layer, false, count, index, err);
	if (axis_is(file, name, i, "interface", err))
		return find_layer(place->layer, true, count, index, err);
	return error_set(err, EX_DATAERR, "dataset '%s' is not over %s", name,
		place->along ? place->along : "a profile time");
}

static int cut(struct run_file *file, const char *name, const struct slice_place *place,
	const struct dataset *data, struct slice *out, struct error *err)
{
	size_t start = 0, step = 0, stride = 1, index = 0;

	out->count = 1;
	for (int i = data->rank; i-- > 0; stride *= data->extent[i]) {
		if (place->along && axis_is(file, name, i, place->along, err)) {
			step = stride;
			out->count = data->extent[i];
			continue;
		}
		TRY(find_index(file, name, i, data->extent[i], place, &index, err));
		if (index >= data->extent[i])
			return error_set(err, EX_DATAERR, "dataset '%s' is shorter than its axis", name);
		start += index * stride;
	}
	if (place->along && !step)
		return error_set(err, EX_DATAERR, "dataset '%s' is not over %s", name, place->along);
	out->values = malloc(out->count * sizeof *out->values);
	if (!out->values)
		return error_memory(err, out->count * sizeof *out->values);
	for (size_t i = 0; i < out->count; i++)
		out->values[i] = data->values[start + i * step];
	return 0;
}

int slice_read(struct run_file *file, const char *name, const struct slice_place *place,
	struct slice *out, struct error *err)
{
	struct dataset data;
	size_t length = 0;
	int result;
	bool has;

	*out = (struct slice){0};
	TRY(run_file_has(file, name, &has, err));
	if (!has)
		return error_set(err, EX_DATAERR, "there is no dataset '%s'", name);
	TRY(run_file_dataset(file, name, &data, err));
	result = cut(file, name, place, &data, out, err);
	free(data.values);
	if (result || !place->along)
		return result;
	TRY(slice_axis(file, place->along, &out->axis, &length, err));
	if (length != out->count)
		return error_set(err, EX_DATAERR, "dataset '%s' is not as long as its axis", name);
	return 0;
}

void slice_clean(struct slice *slice)
{
	free(slice->axis);
	free(slice->values);
	*slice = (struct slice){0};
}
