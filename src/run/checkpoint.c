#include "run/checkpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/build.h"
#include "base/file.h"
#include "base/lock.h"
#include "run/run_file_parts.h"
#include "run/trailer.h"

static void write_attributes(
	const struct attempt *attempt, enum run_status status, const char *config, struct image *image)
{
	char host[BUILD_HOST_SIZE], title[128];

	(void)snprintf(title, sizeof title, "Talus run of the %s model", attempt->model->name);
	image_text(image, "Conventions", "CF-1.10");
	image_text(image, "title", title);
	image_text(image, "model", attempt->model->name);
	image_text(image, "status", run_status_name(status));
	image_text(image, "created", attempt->created);
	image_whole(image, "attempts", attempt->number);
	image_real(image, "cpu_seconds", attempt_cpu(attempt));
	image_text(image, "talus_version", TALUS_VERSION);
	image_whole(image, "numerics_version", attempt->model->numerics_version);
	image_text(image, "git_revision", build_revision());
	image_text(image, "compiler", build_compiler());
	image_text(image, "compiler_flags", build_flags());
	image_text(image, "host", build_host(host));
	image_text(image, "config_hash", attempt->config_hash);
	image_text(image, "config", config);
}

/* Where the array of the model's state lies in the file. */
static const char *array_path(const char *group, const struct array *array, char path[256])
{
	(void)snprintf(path, 256, "%s/state/%s", group, array->name);
	return path;
}

static size_t array_size(const struct array *array)
{
	return array->extent[0] * array->extent[1];
}

static void write_scalar(struct image *image, const char *group, const struct image_data *scalar)
{
	struct image_data data = *scalar;
	char path[256];

	(void)snprintf(path, sizeof path, "%s/%s", group, scalar->path);
	data.path = path;
	image_dataset(image, &data);
}

/* The present state, or with `mark` that of the mark. */
static void write_state(const struct attempt *attempt, const char *group,
	const struct attempt_mark *mark, struct image *image)
{
	struct array list[MODEL_ARRAYS_MAX];
	size_t count = attempt->model->arrays(attempt->state, list);
	double step = (double)(mark ? mark->step : attempt->step), *next = mark ? mark->values : NULL;
	char path[256], name[256];

	image_group(image, group);
	write_scalar(image, group,
		&(struct image_data){.path = "step",
			.units = "1",
			.long_name = "steps done",
			.whole = true,
			.values = &step});
	write_scalar(image, group,
		&(struct image_data){.path = "time",
			.units = "s",
			.long_name = "simulated time",
			.values = mark ? &mark->time : &attempt->time});
	if (mark)
		write_scalar(image, group,
			&(struct image_data){.path = "cpu_seconds",
				.units = "s",
				.long_name = "CPU time until then",
				.values = &mark->cpu});
	(void)snprintf(path, sizeof path, "%s/state", group);
	image_group(image, path);
	for (size_t i = 0; i < count; i++) {
		(void)snprintf(name, sizeof name, "exact state of the model: %s", list[i].name);
		image_dataset(image, &(struct image_data){.path = array_path(group, &list[i], path),
								 .units = "1",
								 .long_name = name,
								 .rank = 2,
								 .extent = {list[i].extent[0], list[i].extent[1]},
								 .values = mark ? next : list[i].data});
		next += mark ? array_size(&list[i]) : 0;
	}
}

static size_t state_size(const struct attempt *attempt)
{
	struct array list[MODEL_ARRAYS_MAX];
	size_t count = attempt->model->arrays(attempt->state, list), values = 0;

	for (size_t i = 0; i < count; i++)
		values += array_size(&list[i]);
	return values * sizeof(double);
}

/* A second process in this folder would write under the same temporary names. */
static int check_lock(const struct attempt *attempt, struct error *err)
{
	struct text path = {0};
	int result = file_path(&path, attempt->folder, "run.lock", err);

	if (result == 0 && attempt->lock && file_is_folder(attempt->folder) &&
		!lock_is_named(attempt->lock, path.data))
		result = error_at(err, EX_IOERR, path.data, 0, 0,
			"was removed or replaced while this process held it: another may work here");
	text_clean(&path);
	return result;
}

/* End an image and bring it to disk with its trailer; the image is freed in every case. */
static int publish(struct attempt *attempt, struct image *image, const struct run_summary *summary,
	struct error *err)
{
	const struct file_place place = {.folder = attempt->folder,
		.name = RUN_FILE_NEWEST,
		.previous = attempt->keep_newest ? RUN_FILE_PREVIOUS : NULL,
		.durable = true};
	unsigned char *bytes;
	size_t size;
	int result;

	TRY(image_finish(image, TRAILER_SIZE, &bytes, &size, err));
	trailer_write(summary, bytes, size, bytes + size);
	result = check_lock(attempt, err);
	if (result == 0)
		result = file_replace(&place, &(struct file_part){bytes, size + TRAILER_SIZE}, 1, err);
	free(bytes);
	if (result == 0)
		attempt->keep_newest = true;
	return result;
}

int checkpoint_write(struct attempt *attempt, enum run_status status, struct error *err)
{
	struct run_summary summary = {.status = status, .step = attempt->step, .time = attempt->time};
	struct text config = {0};
	struct image *image;

	memcpy(summary.config_hash, attempt->config_hash, sizeof summary.config_hash);
	config_print(attempt->config, &config);
	if (config.failed) {
		text_clean(&config);
		return error_memory(err, config.capacity);
	}
	if (image_create(2 * state_size(attempt) + recorder_size(attempt->recorder), &image, err) !=
		0) {
		text_clean(&config);
		return -1;
	}
	write_attributes(attempt, status, text_string(&config), image);
	text_clean(&config);
	write_state(attempt, RUN_FILE_CHECKPOINT, NULL, image);
	if (attempt->mark.values)
		write_state(attempt, RUN_FILE_CONTINUATION, &attempt->mark, image);
	recorder_write(attempt->recorder, image);
	return publish(attempt, image, &summary, err);
}

int checkpoint_mark(struct attempt *attempt, struct error *err)
{
	struct array list[MODEL_ARRAYS_MAX];
	size_t count = attempt->model->arrays(attempt->state, list), bytes = state_size(attempt);
	double *next = malloc(bytes + 1);

	if (!next)
		return error_memory(err, bytes + 1);
	free(attempt->mark.values);
	attempt->mark = (struct attempt_mark){next, attempt->step, attempt->time, attempt_cpu(attempt)};
	for (size_t i = 0; i < count; i++) {
		memcpy(next, list[i].data, array_size(&list[i]) * sizeof *next);
		next += array_size(&list[i]);
	}
	return recorder_mark(attempt->recorder, err);
}

static int read_arrays(
	struct attempt *attempt, struct run_file *file, const char *group, struct error *err)
{
	struct array list[MODEL_ARRAYS_MAX];
	size_t count = attempt->model->arrays(attempt->state, list);
	char path[256];

	for (size_t i = 0; i < count; i++)
		TRY(run_file_fill(
			file, array_path(group, &list[i], path), list[i].data, array_size(&list[i]), err));
	return 0;
}

/* Step, time and CPU time of the mark, which the trailer does not tell. */
static int read_mark(
	struct run_file *file, uint64_t *step, double *time, double *cpu, struct error *err)
{
	double steps;

	TRY(run_file_fill(file, RUN_FILE_CONTINUATION "/step", &steps, 1, err));
	TRY(run_file_fill(file, RUN_FILE_CONTINUATION "/time", time, 1, err));
	TRY(run_file_fill(file, RUN_FILE_CONTINUATION "/cpu_seconds", cpu, 1, err));
	*step = (uint64_t)steps;
	return 0;
}

int checkpoint_read(struct attempt *attempt, struct run_file *file, struct error *err)
{
	const struct run_summary *summary = run_file_summary(file);
	bool has;

	TRY(run_file_has(file, RUN_FILE_CONTINUATION, &has, err));
	if (has) {
		struct attempt_mark *mark = &attempt->mark;

		TRY(read_arrays(attempt, file, RUN_FILE_CONTINUATION, err));
		TRY(checkpoint_mark(attempt, err));
		TRY(read_mark(file, &mark->step, &mark->time, &mark->cpu, err));
	}
	TRY(read_arrays(attempt, file, RUN_FILE_CHECKPOINT, err));
	attempt->model->restored(attempt->state);
	attempt->step = summary->step;
	attempt->time = summary->time;
	return recorder_read(attempt->recorder, file, false, err);
}

int checkpoint_continue(struct attempt *attempt, struct run_file *file, struct error *err)
{
	bool has;

	TRY(run_file_has(file, RUN_FILE_CONTINUATION, &has, err));
	if (!has) /* stopped before its end made a difference */
		return checkpoint_read(attempt, file, err);
	TRY(read_arrays(attempt, file, RUN_FILE_CONTINUATION, err));
	attempt->model->restored(attempt->state);
	TRY(read_mark(file, &attempt->step, &attempt->time, &attempt->cpu_before, err));
	return recorder_read(attempt->recorder, file, true, err);
}

int checkpoint_fail(struct attempt *attempt, const char *reason, struct error *err)
{
	struct run_file *file = NULL;
	struct run_summary summary;
	struct text warning = {0};
	struct image *image;
	unsigned char *bytes;
	size_t size;
	int result = -1;

	if (run_file_open_newest(attempt->folder, &file, &warning, err) != 0)
		goto done;
	bytes = run_file_image(file, &size);
	if (image_reopen(bytes, size, &image, err) != 0)
		goto done;
	summary = *run_file_summary(file);
	summary.status = RUN_FAILED;
	attempt->keep_newest = run_file_is_newest(file);
	image_text(image, "status", run_status_name(RUN_FAILED));
	image_text(image, "reason", reason);
	image_whole(image, "attempts", attempt->number);
	image_real(image, "cpu_seconds", attempt_cpu(attempt));
	result = publish(attempt, image, &summary, err);
done:
	run_file_close(file);
	text_clean(&warning);
	return result;
}
