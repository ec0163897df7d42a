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
			.extent = {r->now.rows},
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
			.extent = {r->now.profile_rows},
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
	struct recorder_axes axes = recorder_axes(r, profile);
	struct image_data data = {.path = profile->name,
		.units = profile->units,
		.long_name = profile->long_name,
		.values = r->fields[index].rows};

	if (!profile->constant) {
		data.extent[data.rank] = r->now.profile_rows;
		data.scales[data.rank++] = "profile_time";
	}
	if (axes.up) {
		data.extent[data.rank] = axes.ups;
		data.scales[data.rank++] = axes.up;
	}
	if (axes.x) {
		data.extent[data.rank] = axes.xs;
		data.scales[data.rank++] = axes.x;
	}
	if (profile->constant || r->now.profile_rows)
		image_dataset(image, &data);
}

/* Path of the sum that series `index` has gathered since its last row; false for a sampled one. */
static bool sum_path(const struct recorder *r, const char *group, size_t index, char path[256])
{
	(void)snprintf(path, 256, "%s/sums/%s", group, r->model->series[index].name);
	return r->model->series[index].per_step_sum;
}

static void write_count(
	struct image *image, const char *group, const char *name, const char *long_name, double value)
{
	char path[256];

	(void)snprintf(path, sizeof path, "%s/%s", group, name);
	image_dataset(image,
		&(struct image_data){
			.path = path, .units = "1", .long_name = long_name, .whole = true, .values = &value});
}

static void write_place(const struct recorder *r, const struct recorder_place *place,
	const char *group, struct image *image)
{
	char path[256];

	write_count(image, group, "next_sample", "next multiple of series_every that is due",
		place->next_sample);
	write_count(image, group, "next_profile", "index of the next time in profiles_at",
		(double)place->next_profile);
	if (place != &r->now) {
		write_count(image, group, "rows", "length of the series then", (double)place->rows);
		write_count(image, group, "profile_rows", "number of the profiles then",
			(double)place->profile_rows);
	}
	(void)snprintf(path, sizeof path, "%s/sums", group);
	image_group(image, path);
	for (size_t i = 0; i < r->model->series_count; i++)
		if (sum_path(r, group, i, path))
			image_dataset(image, &(struct image_data){.path = path,
									 .units = r->model->series[i].units,
									 .long_name = r->model->series[i].long_name,
									 .values = &place->sums[i]});
	history_write(&place->history, group, image);
}

void recorder_write(const struct recorder *r, struct image *image)
{
	write_series(r, image);
	write_axes(r, image);
	probes_write(&r->probes, r->now.rows, image);
	for (size_t p = 0; p < r->model->profile_count; p++)
		write_profile(r, p, image);
	write_place(r, &r->now, RUN_FILE_CHECKPOINT, image);
	if (r->mark.sums)
		write_place(r, &r->mark, RUN_FILE_CONTINUATION, image);
}

size_t recorder_size(const struct recorder *r)
{
	size_t row = RECORDER_OWN + r->model->series_count + probes_width(&r->probes);
	size_t values = r->now.rows * row;

	for (size_t p = 0; p < r->model->profile_count; p++)
		values += r->fields[p].size * (r->now.profile_rows + 1);
	values += (r->now.history.count - r->now.history.first) * r->now.history.width;
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
	r->now.profile_rows = rows;
	return 0;
}

static int read_count(struct run_file *file, const char *group, const char *name, size_t most,
	size_t *out, struct error *err)
{
	double value;
	char path[256];

	(void)snprintf(path, sizeof path, "%s/%s", group, name);
	TRY(run_file_fill(file, path, &value, 1, err));
	if (!(value >= 0 && value <= (double)most))
		return error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
			"dataset '%s' is %g, not 0 to %zu", path, value, most);
	*out = (size_t)value;
	return 0;
}

/* `place` has its sums allocated, and its history empty. */
static int read_place(struct recorder *r, struct recorder_place *place, const char *group,
	struct run_file *file, struct error *err)
{
	char path[256];

	(void)snprintf(path, sizeof path, "%s/next_sample", group);
	TRY(run_file_fill(file, path, &place->next_sample, 1, err));
	TRY(read_count(file, group, "next_profile", (size_t)r->config->output.profiles_at.count,
		&place->next_profile, err));
	if (strcmp(group, RUN_FILE_CHECKPOINT) != 0) {
		TRY(read_count(file, group, "rows", r->now.rows, &place->rows, err));
		TRY(read_count(
			file, group, "profile_rows", r->now.profile_rows, &place->profile_rows, err));
	}
	for (size_t i = 0; i < r->model->series_count; i++)
		if (sum_path(r, group, i, path))
			TRY(run_file_fill(file, path, &place->sums[i], 1, err));
	return history_read(&place->history, group, file, err);
}

int recorder_read(struct recorder *r, struct run_file *file, bool at_mark, struct error *err)
{
	size_t rows;
	bool has;

	TRY(read_length(file, "/time", &rows, err));
	TRY(recorder_reserve_rows(r, rows, err));
	for (size_t i = 0; i < RECORDER_OWN + r->model->series_count; i++)
		TRY(run_file_fill(file, series_at(r, i)->name, r->columns[i], rows, err));
	TRY(probes_read(&r->probes, file, rows, err));
	r->now.rows = rows;
	TRY(read_profiles(r, file, err));
	if (at_mark)
		return read_place(r, &r->now, RUN_FILE_CONTINUATION, file, err);
	TRY(run_file_has(file, RUN_FILE_CONTINUATION, &has, err));
	if (has) {
		TRY(recorder_mark(r, err)); /* for the room */
		TRY(read_place(r, &r->mark, RUN_FILE_CONTINUATION, file, err));
	}
	return read_place(r, &r->now, RUN_FILE_CHECKPOINT, file, err);
}
