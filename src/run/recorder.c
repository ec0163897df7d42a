#include "run/recorder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/history.h"
#include "run/recorder_parts.h"

/* The length of each axis of a profile; 1 along one that it does not have. */
static const struct {
	bool layers, interfaces, x;
} shapes[] = {
	[PROFILE_X] = {.x = true},
	[PROFILE_LAYER_X] = {.layers = true, .x = true},
	[PROFILE_INTERFACE_X] = {.interfaces = true, .x = true},
	[PROFILE_LAYER] = {.layers = true},
	[PROFILE_INTERFACE] = {.interfaces = true},
};

struct recorder_axes recorder_axes(const struct recorder *r, const struct profile *profile)
{
	bool layers = shapes[profile->shape].layers, interfaces = shapes[profile->shape].interfaces;

	return (struct recorder_axes){
		.up = layers       ? "layer"
			  : interfaces ? "interface"
						   : NULL,
		.ups = layers       ? r->layers
			   : interfaces ? r->layers + 1
							: 1,
		.x = shapes[profile->shape].x ? "x" : NULL,
		.xs = shapes[profile->shape].x ? r->cells : 1,
	};
}

static size_t profile_size(const struct recorder *r, const struct profile *profile)
{
	struct recorder_axes axes = recorder_axes(r, profile);

	return axes.ups * axes.xs;
}

/* Series that are made of every step must see every step; others only when they are recorded. */
static bool watches_steps(const struct model *model)
{
	for (size_t i = 0; i < model->series_count; i++)
		if (model->series[i].slope_of >= 0 || model->series[i].per_step_sum)
			return true;
	return false;
}

static int grow(double **values, size_t count, struct error *err)
{
	double *larger = realloc(*values, (count + 1) * sizeof *larger);

	if (!larger)
		return error_memory(err, count * sizeof *larger);
	*values = larger;
	return 0;
}

int recorder_create(const struct model *model, const struct config *config, const struct axes *axes,
	struct recorder **out, struct error *err)
{
	struct recorder *r = calloc(1, sizeof *r);
	size_t most = 0;

	if (!r)
		return error_memory(err, sizeof *r);
	*out = r;
	r->model = model;
	r->watches_steps = watches_steps(model);
	r->config = config;
	r->axes = *axes;
	r->cells = (size_t)axes->cells;
	r->layers = (size_t)axes->layers;
	history_init(&r->now.history, model);
	r->columns = calloc(RECORDER_OWN + model->series_count, sizeof *r->columns);
	r->observed = calloc(model->series_count + 1, sizeof *r->observed);
	r->now.sums = calloc(model->series_count + 1, sizeof *r->now.sums);
	r->fields = calloc(model->profile_count + 1, sizeof *r->fields);
	if (!r->columns || !r->observed || !r->now.sums || !r->fields)
		goto failed;
	for (size_t p = 0; p < model->profile_count; p++) {
		struct field_rows *field = &r->fields[p];

		field->size = profile_size(r, &model->profiles[p]);
		most = field->size > most ? field->size : most;
		if (grow(&field->before, field->size, err))
			goto failed;
	}
	r->after = malloc((most + 1) * sizeof *r->after);
	if (r->after && probes_init(&r->probes, model, config, &r->axes, err) == 0)
		return 0;
failed:
	recorder_free(r);
	*out = NULL;
	return error_memory(err, most * sizeof(double));
}

static void place_clean(struct recorder_place *place)
{
	history_clean(&place->history);
	free(place->sums);
	place->sums = NULL;
}

void recorder_free(struct recorder *r)
{
	if (!r)
		return;
	for (size_t i = 0; r->columns && i < RECORDER_OWN + r->model->series_count; i++)
		free(r->columns[i]);
	for (size_t p = 0; r->fields && p < r->model->profile_count; p++) {
		free(r->fields[p].rows);
		free(r->fields[p].before);
	}
	place_clean(&r->now);
	place_clean(&r->mark);
	probes_clean(&r->probes);
	free(r->columns);
	free(r->observed);
	free(r->fields);
	free(r->profile_times);
	free(r->after);
	free(r);
}

int recorder_reserve_rows(struct recorder *r, size_t rows, struct error *err)
{
	size_t capacity = r->capacity ? r->capacity : 1024;

	if (rows <= r->capacity)
		return 0;
	while (capacity < rows)
		capacity *= 2;
	for (size_t i = 0; i < RECORDER_OWN + r->model->series_count; i++)
		TRY(grow(&r->columns[i], capacity, err));
	TRY(probes_reserve(&r->probes, capacity, err));
	r->capacity = capacity;
	return 0;
}

int recorder_reserve_profiles(struct recorder *r, size_t rows, struct error *err)
{
	size_t capacity = r->profile_capacity ? r->profile_capacity : 1;

	if (rows <= r->profile_capacity)
		return 0;
	while (capacity < rows)
		capacity *= 2;
	for (size_t p = 0; p < r->model->profile_count; p++)
		if (!r->model->profiles[p].constant)
			TRY(grow(&r->fields[p].rows, capacity * r->fields[p].size, err));
	TRY(grow(&r->profile_times, capacity, err));
	r->profile_capacity = capacity;
	return 0;
}

/* One profile time; `weight` is the place of `time` between the states before (0) and now (1). */
static int add_profile(struct recorder *r, const struct model_state *state, double time,
	double weight, struct error *err)
{
	TRY(recorder_reserve_profiles(r, r->now.profile_rows + 1, err));
	for (size_t p = 0; p < r->model->profile_count; p++) {
		struct field_rows *field = &r->fields[p];
		double *row = field->rows + r->now.profile_rows * field->size;

		if (r->model->profiles[p].constant)
			continue;
		if (weight >= 1) {
			r->model->profile(state, p, row);
			continue;
		}
		r->model->profile(state, p, r->after);
		for (size_t i = 0; i < field->size; i++)
			row[i] = field->before[i] + weight * (r->after[i] - field->before[i]);
	}
	r->profile_times[r->now.profile_rows++] = time;
	return 0;
}

static bool is_due(const struct recorder *r, double time)
{
	const struct real_list *at = &r->config->output.profiles_at;

	return r->now.next_profile < (size_t)at->count && at->values[r->now.next_profile] <= time;
}

static int add_profiles(struct recorder *r, const struct model_state *state,
	const struct recorder_step *step, struct error *err)
{
	while (is_due(r, step->to)) {
		double time = r->config->output.profiles_at.values[r->now.next_profile++];
		double weight = time < step->to ? (time - step->from) / (step->to - step->from) : 1;

		TRY(add_profile(r, state, time, weight, err));
	}
	if (step->last &&
		(r->now.profile_rows == 0 || r->profile_times[r->now.profile_rows - 1] != step->to))
		return add_profile(r, state, step->to, 1, err);
	return 0;
}

/* Whether the series are recorded at this step; the next time is then behind it. */
static bool is_sampled(struct recorder *r, const struct recorder_step *step)
{
	double every = r->config->output.series_every;

	/* finer than any step, and than whole numbers of it can count */
	if (every <= 0 || step->to / every >= 0x1p53)
		return true;
	if (step->to < r->now.next_sample * every)
		return step->last;
	r->now.next_sample = floor(step->to / every);
	while (r->now.next_sample * every <= step->to)
		r->now.next_sample++;
	return true;
}

static int add_series(struct recorder *r, const struct model_state *state,
	const struct recorder_step *step, struct error *err)
{
	const struct model *model = r->model;
	bool sampled = is_sampled(r, step);

	if (!sampled && !r->watches_steps)
		return 0;
	model->observe(state, r->observed);
	TRY(history_add(&r->now.history, step->to, r->observed, err));
	for (size_t i = 0; i < model->series_count; i++)
		r->now.sums[i] =
			model->series[i].per_step_sum ? r->now.sums[i] + r->observed[i] : r->observed[i];
	if (!sampled)
		return 0;
	TRY(recorder_reserve_rows(r, r->now.rows + 1, err));
	r->columns[RECORDER_TIME][r->now.rows] = step->to;
	r->columns[RECORDER_DT][r->now.rows] = step->dt;
	for (size_t i = 0; i < model->series_count; i++) {
		r->columns[RECORDER_OWN + i][r->now.rows] = r->now.sums[i];
		r->now.sums[i] = 0;
	}
	probes_observe(&r->probes, model, state, r->now.rows);
	r->now.rows++;
	return 0;
}

int recorder_begin(struct recorder *r, const struct model_state *state, struct error *err)
{
	struct recorder_step start = {0};

	for (size_t p = 0; p < r->model->profile_count; p++)
		if (r->model->profiles[p].constant) {
			TRY(grow(&r->fields[p].rows, r->fields[p].size, err));
			r->model->profile(state, p, r->fields[p].rows);
		}
	TRY(add_series(r, state, &start, err));
	return add_profiles(r, state, &start, err);
}

void recorder_before(
	struct recorder *r, const struct model_state *state, const struct recorder_step *step)
{
	for (size_t p = 0; is_due(r, step->to) && p < r->model->profile_count; p++)
		if (!r->model->profiles[p].constant)
			r->model->profile(state, p, r->fields[p].before);
}

int recorder_after(struct recorder *r, const struct model_state *state,
	const struct recorder_step *step, struct error *err)
{
	TRY(add_series(r, state, step, err));
	return add_profiles(r, state, step, err);
}

const double *recorder_series(const struct recorder *r, const char *name, size_t *count)
{
	*count = r->now.rows;
	for (size_t i = 0; i < r->model->series_count; i++)
		if (!strcmp(r->model->series[i].name, name))
			return r->columns[RECORDER_OWN + i];
	return NULL;
}

int recorder_mark(struct recorder *r, struct error *err)
{
	size_t bytes = (r->model->series_count + 1) * sizeof *r->mark.sums;

	place_clean(&r->mark);
	r->mark = r->now;
	r->mark.history = (struct history){0};
	r->mark.sums = malloc(bytes);
	if (!r->mark.sums)
		return error_memory(err, bytes);
	memcpy(r->mark.sums, r->now.sums, bytes);
	return history_copy(&r->mark.history, &r->now.history, err);
}
