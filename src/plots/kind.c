#include "plots/kind.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/turn.h"
#include "plots/meaning.h"
#include "plots/slice.h"
#include "run/run_file_parts.h"

enum { TIMES_MAX = 9 }; /* that "all" shows: more lines cannot be told apart */

/* The axis of a dataset, or the dataset itself, as its run file describes it. */
static int dataset_axis(const struct kind_request *request, const struct kind_run *run, int index,
	const char *name, double *factor, struct error *err)
{
	struct text unit = {0}, words = {0};
	struct meaning meaning = {.name = name};
	int result = run_file_dataset_text(run->file, name, "units", &unit, err) ||
				 run_file_dataset_text(run->file, name, "long_name", &words, err);

	meaning.unit = text_string(&unit);
	meaning.words = text_string(&words);
	if (!result)
		result = kind_axis(request, run, index, &meaning, factor, err);
	text_clean(&unit);
	text_clean(&words);
	return result;
}

static void multiply(double *values, size_t count, double factor)
{
	for (size_t i = 0; values && i < count; i++)
		values[i] *= factor;
}

bool kind_holds_bed(const char *name)
{
	return !strcmp(name, "h") || !strcmp(name, "h_gauge") || !strcmp(name, "h_station");
}

/* What lengths along x become in the coordinates that the plot asks for; heights become that much less. */
static double turned_scale(
	const struct kind_request *request, const struct kind_run *run, const char *along)
{
	int wanted = request->wanted->coordinates;

	if (wanted == GIVEN_SAME || !run->config || strcmp(along, "x") != 0 ||
		(wanted == GIVEN_CARTESIAN) == (run->config->coordinates == COORDINATES_CARTESIAN))
		return 1;
	return wanted == GIVEN_CARTESIAN ? cos(run->config->slope) : 1 / cos(run->config->slope);
}

static void leave_bed_out(const struct kind_request *request, const struct kind_run *run,
	const char *name, const char *along, double *values, size_t count)
{
	if (!request->wanted->above_bed || !run->config || !kind_holds_bed(name))
		return;
	for (size_t i = 0; i < count; i++)
		values[i] -= config_bed_thickness(run->config) / turned_scale(request, run, along);
}

static int lacks(const struct kind_request *request, const struct kind_run *run, struct error *err)
{
	if (err->code != EX_DATAERR && err->code != EX_NOINPUT)
		return -1;
	text_addf(request->missing, "%s: run %s: %s\n", request->what, run->name, err->text);
	*err = (struct error){0};
	return 0;
}

/* A curve with its parts set; NULL out of memory. */
static struct curve *open_curve(
	const struct kind_request *request, const struct kind_run *run, struct error *err)
{
	struct curve *curve = curves_add(request->curves, err);

	for (size_t i = 0; curve && i < run->part_count; i++)
		if (curves_set_part(curve, i, run->parts[i], err))
			return NULL;
	return curve;
}

static int set_part(const struct kind_run *run, struct curve *curve, enum kind_part part,
	const char *text, struct error *err)
{
	return curves_set_part(curve, run->part_count + (size_t)part, text, err);
}

/* Heights of the layers of a column: relative ones times the thickness there, where it is known. */
static int stretch(const struct kind_request *request, const struct kind_run *run, bool station,
	const struct slice_place *place, struct slice *slice, struct error *err)
{
	struct slice_place one = *place;
	struct slice h = {0};
	struct error none = {0};
	double factor;
	bool known;

	one.along = NULL;
	known = slice_read(run->file, station ? "h_station" : "h", &one, &h, &none) == 0;
	if (known)
		multiply(slice->axis, slice->count, h.values[0]);
	slice_clean(&h);
	TRY(kind_axis(request, run, 1,
		known ? &(struct meaning){.name = "z", .unit = "m"}
			  : &(struct meaning){.name = "relative height", .unit = ""},
		&factor, err));
	multiply(slice->axis, slice->count, factor);
	return 0;
}

/* The numbers of a slice in the units of the axes, as a curve. */
static int add_slice(const struct kind_request *request, const struct kind_run *run,
	const struct kind *kind, const char *name, const struct slice_place *place, struct slice *slice,
	struct curve *curve, struct error *err)
{
	double factor;

	if (!strcmp(place->along, "time"))
		for (size_t i = 0; i < slice->count && slice->axis[i] < meaning_settles(name); i++)
			slice->values[i] = NAN;
	leave_bed_out(request, run, name, place->along, slice->values, slice->count);
	TRY(dataset_axis(request, run, kind->upright ? 0 : 1, name, &factor, err));
	multiply(slice->values, slice->count, factor);
	if (kind->upright) {
		TRY(stretch(
			request, run, slice_has_axis(run->file, name, "station", err), place, slice, err));
	} else {
		TRY(dataset_axis(request, run, 0, place->along, &factor, err));
		multiply(slice->axis, slice->count, factor);
	}
	curve->x = kind->upright ? slice->values : slice->axis;
	curve->y = kind->upright ? slice->axis : slice->values;
	curve->count = slice->count;
	*slice = (struct slice){0};
	return 0;
}

/* The thickness over x in the other coordinates, where the plot asks for them. */
static int turn(const struct kind_request *request, const struct kind_run *run, const char *name,
	const struct slice_place *place, struct slice *slice, struct error *err)
{
	double scale = turned_scale(request, run, place->along), *turned = NULL;
	struct slice_place everywhere = *place;
	struct slice b = {0};
	struct config other;
	struct grid onto;

	if (scale == 1)
		return 0;
	if (strcmp(name, "h") != 0)
		return error_set(
			err, EX_DATAERR, "'%s' cannot be shown in other coordinates, only h can", name);
	other = *run->config;
	other.domain.x_min *= scale;
	other.domain.x_max *= scale;
	onto = grid_make(&other);
	turned = malloc((size_t)onto.cells * sizeof *turned);
	if (!turned)
		return error_memory(err, (size_t)onto.cells * sizeof *turned);
	if (slice_read(run->file, "b", &everywhere, &b, err) || b.count != slice->count ||
		onto.cells != (int)slice->count ||
		turn_profile(
			run->config, slice->axis, b.values, slice->values, onto.cells, &onto, turned, err)) {
		slice_clean(&b);
		free(turned);
		return error_set(err, EX_DATAERR, "the thickness is not as long as the bed");
	}
	slice_clean(&b);
	free(slice->values);
	slice->values = turned;
	for (int i = 1; i <= onto.cells; i++)
		slice->axis[i - 1] = grid_centre(&onto, i);
	return 0;
}

/* Where a curve is cut out, and what the experiment says of it. */
struct cut {
	struct slice_place place;
	const char *time, *position, *layer; /* texts of the parts, NULL: not chosen */
};

static int add_cut(const struct kind_request *request, const struct kind_run *run,
	const struct kind *kind, const char *name, const struct cut *cut, struct error *err)
{
	struct slice slice = {0};
	struct curve *curve;
	int result = -1;

	if (slice_read(run->file, name, &cut->place, &slice, err) ||
		turn(request, run, name, &cut->place, &slice, err)) {
		slice_clean(&slice);
		return lacks(request, run, err);
	}
	curve = open_curve(request, run, err);
	if (curve && !set_part(run, curve, KIND_Y, name, err) &&
		!set_part(run, curve, KIND_AT, cut->time, err) &&
		!set_part(run, curve, KIND_AT_X, cut->position, err) &&
		!set_part(run, curve, KIND_LAYER, cut->layer, err))
		result = add_slice(request, run, kind, name, &cut->place, &slice, curve, err);
	slice_clean(&slice);
	return result;
}

static const char *term_text(const struct term_list *list, size_t i)
{
	return i < list->count ? list->items[i].text : NULL;
}

/* The layers asked for, at one place and time. */
static int add_layers(const struct kind_request *request, const struct kind_run *run,
	const struct kind *kind, const char *name, const struct cut *at, struct error *err)
{
	const struct kind_cuts *cuts = request->cuts;
	const char *layers = slice_layer_axis(run->file, name, err);
	bool has_layers = layers && strcmp(at->place.along, layers) != 0;
	size_t count = has_layers && cuts->layer_count ? cuts->layer_count : 1;

	if (err->code)
		return -1;
	for (size_t k = 0; k < count; k++) {
		struct cut cut = *at;

		if (has_layers && cuts->layer_count) {
			cut.place.layer = cuts->layers[k];
			cut.layer = term_text(&request->wanted->layer, k);
		}
		TRY(add_cut(request, run, kind, name, &cut, err));
	}
	return 0;
}

/* Every position asked for, at one time; without any, all those of gauges and stations. */
static int add_places(const struct kind_request *request, const struct kind_run *run,
	const struct kind *kind, const char *name, const struct cut *at, struct error *err)
{
	const struct kind_cuts *cuts = request->cuts;
	const char *axis = slice_position_axis(run->file, name, err);
	double *all = NULL;
	size_t count = cuts->position_count;
	int result = 0;

	if (err->code)
		return -1;
	if (!axis || !strcmp(at->place.along, axis) || (!count && !strcmp(axis, "x")))
		return add_layers(request, run, kind, name, at, err);
	if (!count && slice_axis(run->file, axis, &all, &count, err))
		return lacks(request, run, err);
	for (size_t i = 0; !result && i < count; i++) {
		struct cut cut = *at;
		char text[TEXT_REAL_SIZE + 2];

		cut.place.x = all ? all[i] : cuts->positions[i];
		(void)snprintf(text, sizeof text, "%.4g m", cut.place.x);
		cut.position = all ? text : term_text(&request->wanted->at_x, i);
		result = add_layers(request, run, kind, name, &cut, err);
	}
	free(all);
	return result;
}

/* The axis of the dataset that stays: across the layers it is known by two names. */
static const char *along_of(
	const struct kind *kind, const struct kind_run *run, const char *name, struct error *err)
{
	const char *layers = slice_layer_axis(run->file, name, err);

	return !strcmp(kind->along, "layer") && layers ? layers : kind->along;
}

static int add_lines(const struct kind_request *request, const struct kind_run *run,
	const char *name, const struct kind *kind, struct error *err)
{
	const struct kind_cuts *cuts = request->cuts;
	const char *axis = slice_time_axis(run->file, name, err);
	bool timed = axis && strcmp(kind->along, axis) != 0;
	struct cut cut = {.place = {along_of(kind, run, name, err), NAN, NAN, SLICE_FIRST}};
	double *times = NULL, stride;
	size_t count = 0;
	int result = 0;

	if (err->code)
		return -1;
	if (!timed || (!cuts->all_times && !cuts->time_count))
		return add_places(request, run, kind, name, &cut, err);
	if (cuts->all_times && slice_axis(run->file, axis, &times, &count, err))
		return lacks(request, run, err);
	if (!cuts->all_times)
		count = cuts->time_count;
	/* of very many times some, evenly, with the first and the last */
	stride = times && count > TIMES_MAX ? (double)(count - 1) / (TIMES_MAX - 1) : 1;
	for (double place = 0; !result && lround(place) < (long)count; place += stride) {
		size_t i = (size_t)lround(place);
		char text[TEXT_REAL_SIZE + 2];

		cut.place.time = times ? times[i] : cuts->times[i];
		(void)snprintf(text, sizeof text, "%.4g s", cut.place.time);
		cut.time = times ? text : request->wanted->at.items[i].text;
		result = add_places(request, run, kind, name, &cut, err);
	}
	free(times);
	return result;
}

/* Thickness over x and time, say: the whole of a dataset of profile_time by x. */
static int add_map(const struct kind_request *request, const struct kind_run *run, const char *name,
	const struct kind *kind, struct error *err)
{
	struct figure_map map = {0};
	struct slice slice = {0};
	struct curve *curve;
	struct text unit = {0}, words = {0};
	struct meaning meaning = {.name = name};
	double factor;
	int result = -1;

	if (request->wanted->coordinates != GIVEN_SAME)
		return error_set(err, EX_DATAERR, "a map cannot be shown in other coordinates");
	if (slice_axis(run->file, "profile_time", &map.y, &map.rows, err))
		return lacks(request, run, err);
	for (size_t row = 0; row < map.rows; row++) {
		struct slice_place place = {kind->along, map.y[row], NAN, SLICE_FIRST};

		slice_clean(&slice);
		if (slice_read(run->file, name, &place, &slice, err)) {
			result = lacks(request, run, err);
			goto done;
		}
		if (!map.values) {
			map.columns = slice.count;
			map.values = calloc(map.rows * map.columns, sizeof *map.values);
		}
		if (!map.values) {
			error_memory(err, map.rows * map.columns * sizeof *map.values);
			goto done;
		}
		leave_bed_out(request, run, name, kind->along, slice.values, slice.count);
		memcpy(map.values + row * map.columns, slice.values, map.columns * sizeof *map.values);
	}
	map.x = slice.axis;
	slice.axis = NULL;
	curve = open_curve(request, run, err);
	if (!curve || set_part(run, curve, KIND_Y, name, err) ||
		dataset_axis(request, run, 0, kind->along, &factor, err))
		goto done;
	multiply(map.x, map.columns, factor);
	if (dataset_axis(request, run, 1, "profile_time", &factor, err))
		goto done;
	multiply(map.y, map.rows, factor);
	if (run_file_dataset_text(run->file, name, "units", &unit, err) ||
		run_file_dataset_text(run->file, name, "long_name", &words, err))
		goto done;
	meaning.unit = text_string(&unit);
	meaning.words = text_string(&words);
	meaning.dimensionless = request->wanted->dimensionless && run->config;
	if (meaning.dimensionless)
		multiply(
			map.values, map.rows * map.columns, 1 / meaning_scale(name, meaning.unit, run->config));
	meaning_label(&meaning, &map.label);
	curve->map = map;
	map = (struct figure_map){0};
	result = 0;
done:
	slice_clean(&slice);
	free(map.x);
	free(map.y);
	free(map.values);
	text_clean(&unit);
	text_clean(&words);
	return result;
}

static const struct kind kinds[] = {
	{"series", "time", FIGURE_LINE, false, false, add_lines},
	{"profile", "x", FIGURE_LINE, false, true, add_lines},
	{"column", "layer", FIGURE_LINE_POINTS, true, true, add_lines},
	{"gauge", "profile_time", FIGURE_LINE, false, false, add_lines},
	{"map", "x", FIGURE_LINE, false, false, add_map},
	{"metric", NULL, FIGURE_LINE_POINTS, false, false, NULL},
};

const struct kind *kind_find(const char *name, const char **nearest)
{
	int best = INT_MAX;

	*nearest = "";
	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
		int distance = text_distance(name, kinds[i].name);

		if (!distance)
			return &kinds[i];
		if (distance < best) {
			best = distance;
			*nearest = kinds[i].name;
		}
	}
	return NULL;
}

int kind_add_run(const struct kind_request *request, const struct kind_run *run, struct error *err)
{
	for (size_t i = 0; i < request->wanted->y.count; i++)
		TRY(request->kind->add(request, run, request->wanted->y.items[i].text, request->kind, err));
	return 0;
}
