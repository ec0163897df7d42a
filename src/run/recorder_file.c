/* The recorder's content in a run file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run/recorder_parts.h"
#include "run/run_file_parts.h"

static const struct series own_series[RECORDER_OWN] = {
	[RECORDER_TIME] = {.name = "time", .units = "s", .long_name = "simulated time"},
	[RECORDER_DT] = {.name = "dt", .units = "s", .long_name = "length of the time step"},
};

static const struct series *series_at(const struct recorder *r, size_t column)
{
	return column < RECORDER_OWN ? &own_series[column] : &r->model->series[column - RECORDER_OWN];
}

static void write_series(const struct recorder *r, struct image *image)
{
	for (size_t i = 0; i < RECORDER_OWN + r->model->series_count; i++) {
		const struct series *series = series_at(r, i);
		struct image_data data = {.path = series->name,
			.units = series->units,
			.long_name = series->long_name,
			.whole = series->whole,
			.rank = 1,
			.extent = {r->rows},
			.scales = {"time"},
			.values = r->columns[i]};

		if (i == RECORDER_TIME) {
			data.standard_name = "time";
			image_scale(image, &data);
		} else {
			image_dataset(image, &data);
		}
	}
}

static void write_axes(const struct recorder *r, struct image *image)
{
	const struct image_data scales[] = {
		{.path = "profile_time",
			.units = "s",
			.long_name = "simulated time of the profiles",
			.standard_name = "time",
			.extent = {r->profile_rows},
			.values = r->profile_times},
		{.path = "x",
			.units = "m",
			.long_name = "distance along the slope, cell centres",
			.extent = {r->cells},
			.values = r->axes.x},
		{.path = "layer",
			.units = "1",
			.long_name = "relative height of the middle of a layer",
			.extent = {r->layers},
			.values = r->axes.layer},
		{.path = "interface",
			.units = "1",
			.long_name = "relative height of a layer interface",
			.extent = {r->layers + 1},
			.values = r->axes.interface},
	};

	for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
		struct image_data scale = scales[i];

		/* netCDF takes an axis without length for an unlimited one: it comes with the first profile */
		scale.rank = 1;
		if (scale.extent[0])
			image_scale(image, &scale);
	}
}

static void write_profile(const struct recorder *r, size_t index, struct image *image)
{
	const struct profile *profile = &r->model->profiles[index];
	struct image_data data = {.path = profile->name,
		.units = profile->units,
		.long_name = profile->long_name,
		.values = r->fields[index].rows};

	if (!profile->constant) {
		data.extent[data.rank] = r->profile_rows;
		data.scales[data.rank++] = "profile_time";
	}
	if (profile->shape != PROFILE_X) {
		data.extent[data.rank] = profile->shape == PROFILE_LAYER_X ? r->layers : r->layers + 1;
		data.scales[data.rank++] = profile->shape == PROFILE_LAYER_X ? "layer" : "interface";
	}
	data.extent[data.rank] = r->cells;
	data.scales[data.rank++] = "x";
	if (profile->constant || r->profile_rows)
		image_dataset(image, &data);
}

/* Path of the sum that series `index` has gathered since its last row; false for a sampled one. */
static bool sum_path(const struct recorder *r, size_t index, char *path, size_t size)
{
	(void)snprintf(path, size, "/checkpoint/sums/%s", r->model->series[index].name);
	return r->model->series[index].per_step_sum;
}

static void write_checkpoint(const struct recorder *r, struct image *image)
{
	double next_profile = (double)r->next_profile;
	char path[256];

	image_dataset(image, &(struct image_data){.path = "/checkpoint/next_sample",
							 .units = "1",
							 .long_name = "next multiple of series_every that is due",
							 .whole = true,
							 .values = &r->next_sample});
	image_dataset(image, &(struct image_data){.path = "/checkpoint/next_profile",
							 .units = "1",
							 .long_name = "index of the next time in profiles_at",
							 .whole = true,
							 .values = &next_profile});
	image_group(image, "/checkpoint/sums");
	for (size_t i = 0; i < r->model->series_count; i++)
		if (sum_path(r, i, path, sizeof path))
			image_dataset(image, &(struct image_data){.path = path,
									 .units = r->model->series[i].units,
									 .long_name = r->model->series[i].long_name,
									 .values = &r->sums[i]});
	history_write(&r->history, image);
}

void recorder_write(const struct recorder *r, struct image *image)
{
	write_series(r, image);
	write_axes(r, image);
	for (size_t p = 0; p < r->model->profile_count; p++)
		write_profile(r, p, image);
	write_checkpoint(r, image);
}

size_t recorder_size(const struct recorder *r)
{
	size_t values = r->rows * (RECORDER_OWN + r->model->series_count);

	for (size_t p = 0; p < r->model->profile_count; p++)
		values += r->fields[p].size * (r->profile_rows + 1);
	values += (r->history.count - r->history.first) * r->history.width;
	return values * sizeof(double);
}

/* The length of a one-dimensional dataset; 0 where it is absent. */
static int read_length(struct run_file *file, const char *path, size_t *length, struct error *err)
{
	struct dataset data;
	bool has;

	*length = 0;
	TRY(run_file_has(file, path, &has, err));
	if (!has)
		return 0;
	TRY(run_file_dataset(file, path, &data, err));
	*length = data.extent[0];
	free(data.values);
	return 0;
}

static int read_profiles(struct recorder *r, struct run_file *file, struct error *err)
{
	size_t rows;

	TRY(read_length(file, "/profile_time", &rows, err));
	TRY(recorder_reserve_profiles(r, rows, err));
	for (size_t p = 0; p < r->model->profile_count; p++) {
		const struct profile *profile = &r->model->profiles[p];
		struct field_rows *field = &r->fields[p];

		if (profile->constant) {
			free(field->rows);
			field->rows = malloc(field->size * sizeof *field->rows);
			if (!field->rows)
				return error_memory(err, field->size * sizeof *field->rows);
			TRY(run_file_fill(file, profile->name, field->rows, field->size, err));
		} else if (rows) {
			TRY(run_file_fill(file, profile->name, field->rows, rows * field->size, err));
		}
	}
	if (rows)
		TRY(run_file_fill(file, "/profile_time", r->profile_times, rows, err));
	r->profile_rows = rows;
	return 0;
}

int recorder_read(struct recorder *r, struct run_file *file, struct error *err)
{
	double next_profile;
	char path[256];
	size_t rows;

	TRY(read_length(file, "/time", &rows, err));
	TRY(recorder_reserve_rows(r, rows, err));
	for (size_t i = 0; i < RECORDER_OWN + r->model->series_count; i++)
		TRY(run_file_fill(file, series_at(r, i)->name, r->columns[i], rows, err));
	r->rows = rows;
	TRY(read_profiles(r, file, err));
	TRY(run_file_fill(file, "/checkpoint/next_sample", &r->next_sample, 1, err));
	TRY(run_file_fill(file, "/checkpoint/next_profile", &next_profile, 1, err));
	r->next_profile = (size_t)next_profile;
	for (size_t i = 0; i < r->model->series_count; i++)
		if (sum_path(r, i, path, sizeof path))
			TRY(run_file_fill(file, path, &r->sums[i], 1, err));
	return history_read(&r->history, file, err);
}
