/* What is worth seeing of a run, without an experiment that asks for it. */
#include <stdlib.h>
#include <string.h>

#include "plots/kind.h"
#include "plots/meaning.h"
#include "plots/panel.h"
#include "plots/plots_parts.h"
#include "plots/slice.h"
#include "run/run_file_parts.h"

enum {
	SEVERAL = 4,
	FOUND_MAX = 18,
	MAP_LEAST = 4, /* profiles below which a map is no picture of the time between them */
};

/* A figure: the panels whose datasets some run has. */
static const struct run_figure {
	const char *name, *title, *kind;
	const char *y[SEVERAL]; /* a panel each, or one panel for all of them */
	bool together;
	const char *at; /* NULL: the last time */
	bool split;     /* a panel for every run, and position */
} figures[] = {
	{"fronts", "Front and flow in time", "series",
		{"front_position", "front_velocity", "max_thickness", "kinetic_energy"}, false, NULL,
		false},
	{"energy", "Energy in time", "series", {"energy", "potential_energy", "kinetic_energy"}, false,
		NULL, false},
	{"gauges", "Thickness at the gauges", "series", {"h_gauge"}, false, NULL, true},
	{"velocities", "Velocities over the height", "column", {"u_station", "w_station"}, false, "all",
		true},
	{"profiles", "Thickness along the slope", "profile", {"h"}, false, "all", true},
	{"deposit", "Last profile", "profile", {"h", "static_height"}, true, NULL, true},
	{"space-time", "Thickness in space and time", "map", {"h"}, false, NULL, true},
};

/* A run that is open, and its name in the legend. */
struct run_source {
	struct run_file *file;
	struct config config;
	bool config_known;
	char *name;
};

struct run_sources {
	struct run_source *items; /* [count] */
	size_t count;
	bool dimensionless;
};

/* The last two parts of a path say which run it is: of "results/study/layers-8" the last one. */
static char *name_of(const char *path)
{
	size_t length = strlen(path), start;

	while (length > 1 && path[length - 1] == '/')
		length--;
	if (length > 3 && !strncmp(path + length - 3, ".h5", 3)) {
		while (length && path[length - 1] != '/')
			length--;
		while (length > 1 && path[length - 1] == '/')
			length--;
	}
	if (!length)
		return strdup(path);
	for (start = length; start > 0 && path[start - 1] != '/';)
		start--;
	return strndup(path + start, length - start);
}

static int open_source(
	struct run_source *source, const char *path, struct text *missing, struct error *err)
{
	struct text warning = {0};
	struct error unknown = {0};

	source->name = name_of(path);
	if (!source->name)
		return error_memory(err, strlen(path));
	if (run_file_open_any(path, &source->file, &warning, err)) {
		text_clean(&warning);
		if (err->code == EX_NOINPUT)
			err->code = EX_DATAERR;
		return -1;
	}
	if (warning.length)
		text_addf(missing, "%s: %s\n", path, text_string(&warning));
	source->config_known = run_file_config(source->file, &source->config, &unknown) == 0;
	text_clean(&warning);
	if (unknown.code != EX_SOFTWARE)
		return 0;
	*err = unknown;
	return -1;
}

static int any_has(
	const struct run_sources *sources, const char *name, bool *has, struct error *err)
{
	*has = false;
	for (size_t i = 0; i < sources->count && !*has; i++)
		TRY(run_file_has(sources->items[i].file, name, has, err));
	return 0;
}

/* One panel, or one for each run, of all runs. */
static int add_panel(const struct run_sources *sources, const struct experiment_panel *wanted,
	struct figure *figure, struct error *err)
{
	const char *nearest;
	struct kind_cuts cuts;
	struct curves curves = {0};
	struct kind_request request = {kind_find(wanted->kind.text, &nearest), wanted, &cuts, "",
		"plot", &curves, &figure->missing};
	int result = kind_cuts_read(&cuts, wanted, "", err);

	curves.mark = request.kind->mark;
	(void)curves_add_dimension(&curves, "run", wanted->split.count && sources->count > 1, false);
	(void)kind_add_dimensions(&request);
	for (size_t i = 0; !result && i < sources->count; i++) {
		const struct run_source *source = &sources->items[i];
		const char *part = source->name;
		const struct kind_run run = {
			source->file, source->config_known ? &source->config : NULL, source->name, &part, 1};
		bool has = false;

		for (size_t k = 0; !result && !has && k < wanted->y.count; k++)
			result = run_file_has(source->file, wanted->y.items[k].text, &has, err);
		if (!result && has)
			result = kind_add_run(&request, &run, err);
	}
	if (!result)
		result = panel_finish(&curves, wanted, "", figure, err);
	curves_clean(&curves);
	kind_cuts_clean(&cuts);
	return result;
}

/* The panels of a figure with these datasets, each alone or all in one. */
static int add_panels(const struct run_sources *sources, const char *kind, const char *const *names,
	size_t count, const struct run_figure *like, struct figure *figure, struct error *err)
{
	struct term all[SEVERAL], at = {like->at, 0, 0}, apart[] = {{"run", 0, 0}, {"at_x", 0, 0}};
	size_t ways = !like->split ? 0 : !strcmp(kind, "column") ? 2 : 1;
	struct experiment_panel panel = {.kind = {kind, 0, 0},
		.title = "",
		.labels = {"", ""},
		.at = {&at, like->at != NULL},
		.split = {apart, ways},
		.dimensionless = sources->dimensionless};
	size_t kept = 0;

	for (size_t i = 0; i < count; i++) {
		struct term y = {names[i], 0, 0};
		bool has;

		TRY(any_has(sources, names[i], &has, err));
		if (!has)
			continue;
		if (like->together) {
			all[kept++] = y;
			continue;
		}
		panel.y = (struct term_list){&y, 1};
		TRY(add_panel(sources, &panel, figure, err));
	}
	panel.y = (struct term_list){all, kept};
	return kept ? add_panel(sources, &panel, figure, err) : 0;
}

/* Datasets of a model that the table of figures does not know: series, or columns across layers. */
static int find_datasets(const struct run_sources *sources, bool columns, struct text *list,
	const char **names, size_t *count, struct error *err)
{
	struct run_file *file = sources->items[0].file;
	size_t cells = 0;
	char *rest = NULL;

	*count = 0;
	TRY(run_file_names(file, list, err));
	if (columns)
		TRY(run_file_scale_length(file, "x", 0, &cells, err));
	for (char *name = list->data ? strtok_r(list->data, "\n", &rest) : NULL; name;
		 name = strtok_r(NULL, "\n", &rest)) {
		bool fits = columns ? slice_layer_axis(file, name + 1, err) &&
								  slice_has_axis(file, name + 1, "profile_time", err) && cells <= 1
							: slice_has_axis(file, name + 1, "time", err) &&
								  strncmp(name, "/cpu", 4) != 0 && strcmp(name, "/time") != 0 &&
								  strcmp(name, "/dt") != 0;

		if (fits && !strchr(name + 1, '/') && *count < FOUND_MAX)
			names[(*count)++] = name + 1;
	}
	return err->code ? -1 : 0;
}

static int draw_found(
	const struct run_sources *sources, bool columns, struct plots_output *output, struct error *err)
{
	static const struct run_figure like[] = {
		{"series", "Series in time", "series", {0}, false, NULL, false},
		{"columns", "Profiles over height", "column", {0}, false, "all", true}};
	const char *names[FOUND_MAX];
	struct text list = {0};
	struct figure figure = {.name = like[columns].name};
	size_t count;
	int result = find_datasets(sources, columns, &list, names, &count, err);

	text_add(&figure.title, like[columns].title);
	if (!result)
		result =
			add_panels(sources, like[columns].kind, names, count, &like[columns], &figure, err);
	if (!result)
		result = plots_write(&figure, output, err);
	figure_clean(&figure);
	text_clean(&list);
	return result;
}

/* A map of a few profiles would show more than is known. */
static int has_enough(const struct run_sources *sources, const struct run_figure *wanted,
	bool *enough, struct plots_output *output, struct error *err)
{
	size_t most = 0, length;
	bool has;

	TRY(any_has(sources, wanted->y[0], &has, err));
	for (size_t i = 0; i < sources->count; i++) {
		TRY(run_file_scale_length(sources->items[i].file, "profile_time", 0, &length, err));
		most = length > most ? length : most;
	}
	*enough = strcmp(wanted->kind, "map") != 0 || most >= MAP_LEAST;
	if (has && !*enough)
		text_addf(&output->notes,
			"%s: not drawn, %zu profile%s of the %d that it takes: output.profiles_at\n",
			wanted->name, most, most == 1 ? "" : "s", MAP_LEAST);
	return 0;
}

static int draw_figure(const struct run_sources *sources, const struct run_figure *wanted,
	struct plots_output *output, struct error *err)
{
	struct figure figure = {.name = wanted->name};
	size_t count = 0;
	bool enough;
	int result;

	TRY(has_enough(sources, wanted, &enough, output, err));
	if (!enough)
		return 0;
	while (count < SEVERAL && wanted->y[count])
		count++;
	text_addf(&figure.title, "%s%s%s", wanted->title, sources->count == 1 ? ": " : "",
		sources->count == 1 ? sources->items[0].name : "");
	result = add_panels(sources, wanted->kind, wanted->y, count, wanted, &figure, err);
	if (!result)
		result = plots_write(&figure, output, err);
	figure_clean(&figure);
	return result;
}

/* Runs without a front, beside others that have one, are in none of the figures. */
static int tell_others(const struct run_sources *sources, struct text *missing, struct error *err)
{
	for (size_t i = 0; i < sources->count; i++) {
		struct text model = {0};
		bool has;

		TRY(run_file_has(sources->items[i].file, "front_position", &has, err));
		if (has)
			continue;
		if (run_file_text(sources->items[i].file, "model", &model, err)) {
			text_clean(&model);
			return -1;
		}
		text_addf(missing,
			"run %s: not drawn, model: %s has other figures than the rest; plot it on its own\n",
			sources->items[i].name, text_string(&model));
		text_clean(&model);
	}
	return 0;
}

int plots_draw_runs(
	const char *const *paths, size_t count, struct plots_output *output, struct error *err)
{
	struct run_sources sources = {
		calloc(count + 1, sizeof *sources.items), count, output->dimensionless};
	bool fronts = false;
	int result = 0;

	if (!sources.items)
		return error_memory(err, count * sizeof *sources.items);
	for (size_t i = 0; !result && i < count; i++)
		result = open_source(&sources.items[i], paths[i], &output->missing, err);
	for (size_t i = 0; !result && i < sizeof figures / sizeof *figures; i++)
		result = draw_figure(&sources, &figures[i], output, err);
	if (!result)
		result = any_has(&sources, "front_position", &fronts, err);
	if (!result && fronts)
		result = tell_others(&sources, &output->missing, err);
	if (!result && !fronts)
		result = draw_found(&sources, false, output, err);
	if (!result && !fronts)
		result = draw_found(&sources, true, output, err);
	for (size_t i = 0; i < count; i++) {
		run_file_close(sources.items[i].file);
		free(sources.items[i].name);
	}
	free(sources.items);
	return result;
}
