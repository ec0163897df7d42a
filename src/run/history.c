#include "run/history.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"

void history_init(struct history *history, const struct model *model)
{
	*history = (struct history){.model = model, .width = 1 + model->series_count};
	for (size_t i = 0; i < model->series_count; i++)
		if (model->series[i].slope_of >= 0)
			history->window = fmax(history->window, model->series[i].window);
}

void history_clean(struct history *history)
{
	free(history->values);
	*history = (struct history){0};
}

int history_copy(struct history *copy, const struct history *history, struct error *err)
{
	size_t kept = history->count - history->first, values = kept * history->width;

	*copy = *history;
	copy->first = 0;
	copy->count = copy->capacity = kept;
	copy->values = malloc((values + 1) * sizeof *copy->values);
	if (!copy->values)
		return error_memory(err, (values + 1) * sizeof *copy->values);
	if (values)
		memcpy(copy->values, history->values + history->first * history->width,
			values * sizeof *copy->values);
	return 0;
}

static const double *row(const struct history *history, size_t index)
{
	return history->values + index * history->width;
}

/* Room for one row more: by dropping what is no longer needed, or else by growing. */
static int reserve(struct history *history, struct error *err)
{
	size_t kept = history->count - history->first, capacity, bytes;
	double *values;

	if (history->count < history->capacity)
		return 0;
	if (kept <= history->capacity / 2 && history->capacity) {
		memmove(history->values, row(history, history->first),
			kept * history->width * sizeof *history->values);
		history->first = 0;
		history->count = kept;
		return 0;
	}
	capacity = history->capacity ? 2 * history->capacity : 256;
	bytes = capacity * history->width * sizeof *values;
	values = realloc(history->values, bytes);
	if (!values)
		return error_memory(err, bytes);
	history->values = values;
	history->capacity = capacity;
	return 0;
}

/* (v(t) - v(t - window))/window, over [0, t] while t < window; NaN where the window holds a NaN. */
static double slope(const struct history *history, size_t column, double window)
{
	const double *last = row(history, history->count - 1), *a, *b;
	double begin = fmax(last[0] - window, 0), value;
	size_t i = history->count - 1;

	if (isnan(last[column]))
		return NAN;
	if (last[0] == 0)
		return 0;
	while (i > history->first && row(history, i)[0] > begin)
		if (isnan(row(history, --i)[column]))
			return NAN;
	a = row(history, i);
	b = a + history->width;
	value = a[column];
	if (begin > a[0])
		value += (b[column] - a[column]) * ((begin - a[0]) / (b[0] - a[0]));
	return (last[column] - value) / (last[0] - begin);
}

int history_add(struct history *history, double time, double *values, struct error *err)
{
	const struct series *series = history->model->series;
	double *next;

	if (history->window <= 0)
		return 0;
	TRY(reserve(history, err));
	next = history->values + history->count++ * history->width;
	next[0] = time;
	memcpy(next + 1, values, history->model->series_count * sizeof *values);
	for (size_t i = 0; i < history->model->series_count; i++)
		if (series[i].slope_of >= 0)
			values[i] = slope(history, 1 + (size_t)series[i].slope_of, series[i].window);
	/* the last row at or before the window is still needed to interpolate */
	while (history->first + 1 < history->count &&
		   row(history, history->first + 1)[0] <= time - history->window)
		history->first++;
	return 0;
}

static bool is_watched(const struct model *model, size_t index)
{
	for (size_t i = 0; i < model->series_count; i++)
		if (model->series[i].slope_of == (int)index)
			return true;
	return false;
}

/* Path of column `column` (0: the time); false where no slope needs it. */
static bool column_path(const struct model *model, const char *group, size_t column, char path[256])
{
	if (column > 0 && !is_watched(model, column - 1))
		return false;
	(void)snprintf(
		path, 256, "%s/history/%s", group, column ? model->series[column - 1].name : "time");
	return true;
}

void history_write(const struct history *history, const char *group, struct image *image)
{
	size_t count = history->count - history->first;
	double *column = malloc((count + 1) * sizeof *column);
	char path[256];

	(void)snprintf(path, sizeof path, "%s/history", group);
	if (history->window > 0)
		image_group(image, path);
	for (size_t k = 0; history->window > 0 && k < history->width; k++) {
		const struct series *series = k ? &history->model->series[k - 1] : NULL;

		if (!column_path(history->model, group, k, path))
			continue;
		for (size_t i = 0; column && i < count; i++)
			column[i] = row(history, history->first + i)[k];
		image_dataset(image, &(struct image_data){.path = path,
								 .units = series ? series->units : "s",
								 .long_name = series ? series->long_name : "time of the steps",
								 .rank = 1,
								 .extent = {count},
								 .values = column});
	}
	free(column);
}

int history_read(
	struct history *history, const char *group, struct run_file *file, struct error *err)
{
	struct dataset data;
	char path[256];

	for (size_t k = 0; history->window > 0 && k < history->width; k++) {
		if (!column_path(history->model, group, k, path))
			continue;
		TRY(run_file_dataset(file, path, &data, err));
		if (data.rank != 1 || data.extent[0] < 1 || (k && data.extent[0] != history->count)) {
			free(data.values);
			return error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
				"dataset '%s' has the wrong length", path);
		}
		if (k == 0) {
			history->count = history->capacity = data.extent[0];
			history->first = 0;
			free(history->values);
			history->values = calloc(history->count * history->width, sizeof *history->values);
		}
		for (size_t i = 0; history->values && i < history->count; i++)
			history->values[i * history->width + k] = data.values[i];
		free(data.values);
		if (!history->values)
			return error_memory(err, history->count * history->width * sizeof(double));
	}
	return 0;
}
