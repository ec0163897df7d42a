#include "campaign/experiment_plots.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/setting.h"
#include "talus/text.h"

/* What the entries of a plot fill: those of a panel stand in the panel, or in the plot for all of them. */
struct plot_form {
	struct experiment_plot *plot;
	struct experiment_panel *panel;
	const struct node *panels;
};

static struct experiment_panel *panel_of(void *target)
{
	return ((struct plot_form *)target)->panel;
}

static int read_term(const struct reader *reader, const struct node *node, struct term *out)
{
	*out = (struct term){NULL, node->line, node->column};
	return reader_text(reader, node, &out->text);
}

/* What the panel says replaces what its plot said. */
static int read_list(const struct reader *reader, const struct node *node, struct term_list *out)
{
	free(out->items);
	*out = (struct term_list){0};
	return reader_terms(reader, node, out);
}

static int read_settings(
	const struct reader *reader, const struct node *node, struct setting_list *out)
{
	setting_list_clean(out);
	return reader_settings(reader, node, out);
}

static int read_kind(const struct reader *reader, const struct node *node, void *target)
{
	return read_term(reader, node, &panel_of(target)->kind);
}

static int read_panel_title(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &panel_of(target)->title);
}

static int read_y(const struct reader *reader, const struct node *node, void *target)
{
	return read_list(reader, node, &panel_of(target)->y);
}

static int read_x(const struct reader *reader, const struct node *node, void *target)
{
	return read_term(reader, node, &panel_of(target)->x);
}

static int read_at(const struct reader *reader, const struct node *node, void *target)
{
	return read_list(reader, node, &panel_of(target)->at);
}

static int read_at_x(const struct reader *reader, const struct node *node, void *target)
{
	return read_list(reader, node, &panel_of(target)->at_x);
}

static int read_layer(const struct reader *reader, const struct node *node, void *target)
{
	return read_list(reader, node, &panel_of(target)->layer);
}

static int read_lines(const struct reader *reader, const struct node *node, void *target)
{
	return read_list(reader, node, &panel_of(target)->lines);
}

static int read_split(const struct reader *reader, const struct node *node, void *target)
{
	return read_list(reader, node, &panel_of(target)->split);
}

static int read_log(const struct reader *reader, const struct node *node, void *target)
{
	struct term_list *log = &panel_of(target)->log;

	TRY(read_list(reader, node, log));
	for (size_t i = 0; i < log->count; i++)
		if (strcmp(log->items[i].text, "x") != 0 && strcmp(log->items[i].text, "y") != 0)
			return reader_fail(reader, node, "%s is neither x nor y", log->items[i].text);
	return 0;
}

static int read_range(const struct reader *reader, const struct node *node, struct term_list *out)
{
	double from, to;

	TRY(read_list(reader, node, out));
	if (out->count != 2 || !text_to_real(out->items[0].text, &from) ||
		!text_to_real(out->items[1].text, &to) || !(from < to))
		return reader_fail(reader, node, "two increasing numbers are wanted here, like [0, 1.5]");
	return 0;
}

static int read_x_range(const struct reader *reader, const struct node *node, void *target)
{
	return read_range(reader, node, &panel_of(target)->ranges[0]);
}

static int read_y_range(const struct reader *reader, const struct node *node, void *target)
{
	return read_range(reader, node, &panel_of(target)->ranges[1]);
}

static int read_x_unit(const struct reader *reader, const struct node *node, void *target)
{
	return read_term(reader, node, &panel_of(target)->units[0]);
}

static int read_y_unit(const struct reader *reader, const struct node *node, void *target)
{
	return read_term(reader, node, &panel_of(target)->units[1]);
}

static int read_x_label(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &panel_of(target)->labels[0]);
}

static int read_y_label(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &panel_of(target)->labels[1]);
}

static int read_dimensionless(const struct reader *reader, const struct node *node, void *target)
{
	return reader_bool(reader, node, &panel_of(target)->dimensionless);
}

static int read_coordinates(const struct reader *reader, const struct node *node, void *target)
{
	static const char *const names[] = {
		[GIVEN_SAME] = "same", [GIVEN_LOCAL] = "local", [GIVEN_CARTESIAN] = "cartesian", NULL};

	return reader_choice(reader, node, names, &panel_of(target)->coordinates);
}

static int read_above_bed(const struct reader *reader, const struct node *node, void *target)
{
	return reader_bool(reader, node, &panel_of(target)->above_bed);
}

static int read_baseline(const struct reader *reader, const struct node *node, void *target)
{
	return read_settings(reader, node, &panel_of(target)->baseline);
}

static int read_reference(const struct reader *reader, const struct node *node, void *target)
{
	return read_settings(reader, node, &panel_of(target)->reference);
}

static int read_only(const struct reader *reader, const struct node *node, void *target)
{
	return read_settings(reader, node, &panel_of(target)->only);
}

static int read_names(const struct reader *reader, const struct node *node, void *target)
{
	if (node->kind != NODE_MAPPING)
		return reader_fail(reader, node, "a mapping from values to their names is wanted here");
	for (size_t i = 0; i < node->count; i++)
		if (node->items[i].kind != NODE_SCALAR)
			return reader_fail(reader, &node->items[i], "one text is wanted here");
	panel_of(target)->names = node;
	return 0;
}

static int read_points_title(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &((struct experiment_points *)target)->title);
}

static int read_points_line(const struct reader *reader, const struct node *node, void *target)
{
	return reader_terms(reader, node, &((struct experiment_points *)target)->line);
}

static int read_number(const struct reader *reader, const struct node *node, double *out)
{
	if (node->kind != NODE_SCALAR || !text_to_real(node->text, out))
		return reader_fail(reader, node, "a number is wanted here, in the unit of its axis");
	return 0;
}

static int read_points(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment_points *points = target;

	if (node->kind != NODE_SEQUENCE || !node->count)
		return reader_fail(reader, node, "a list of points is wanted here, like [[0, 1], [2, 3]]");
	points->x = calloc(2 * node->count, sizeof *points->x);
	if (!points->x)
		return error_memory(reader->err, 2 * node->count * sizeof *points->x);
	points->y = points->x + node->count;
	points->count = node->count;
	for (size_t i = 0; i < node->count; i++) {
		const struct node *point = &node->items[i];

		if (point->kind != NODE_SEQUENCE || point->count != 2)
			return reader_fail(reader, point, "a point is two numbers, like [0, 1]");
		TRY(read_number(reader, &point->items[0], &points->x[i]));
		TRY(read_number(reader, &point->items[1], &points->y[i]));
	}
	return 0;
}

static void points_clean(struct experiment_panel *panel)
{
	for (size_t i = 0; i < panel->published_count; i++) {
		free(panel->published[i].line.items);
		free(panel->published[i].x);
	}
	free(panel->published);
	panel->published = NULL;
	panel->published_count = 0;
}

static const struct reader_key points_keys[] = {
	{"title", read_points_title, "in the legend"},
	{"line", read_points_line, "values of the `lines` keys: the colour of that line"},
	{"points", read_points, "`[[x, y], ...]` in the units of the axes; required"},
};

static int read_panel_published(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment_panel *panel = panel_of(target);

	if (node->kind != NODE_SEQUENCE)
		return reader_fail(reader, node, "a list of mappings with their 'points' is wanted here");
	points_clean(panel);
	panel->published = calloc(node->count ? node->count : 1, sizeof *panel->published);
	if (!panel->published)
		return error_memory(reader->err, node->count * sizeof *panel->published);
	for (size_t i = 0; i < node->count; i++) {
		struct experiment_points *points = &panel->published[i];

		panel->published_count = i + 1;
		points->title = "";
		TRY(reader_keys(reader, &node->items[i], points_keys,
			sizeof points_keys / sizeof *points_keys, points));
		if (!points->count)
			return reader_fail(
				reader, &node->items[i], "these published values lack their 'points'");
	}
	return 0;
}

/* A plot's name is the name of its files. */
static int read_name(const struct reader *reader, const struct node *node, void *target)
{
	struct term *name = &((struct plot_form *)target)->plot->name;

	TRY(read_term(reader, node, name));
	for (const char *at = name->text; *at; at++)
		if (!(isalnum((unsigned char)*at) && (unsigned char)*at < 0x80) &&
			!(at > name->text && strchr("-._", *at)))
			return reader_fail(reader, node,
				"letters, digits and -._ make a name, and the first is a letter or a digit");
	if (strlen(name->text) > 100)
		return reader_fail(reader, node, "this name has more than 100 bytes");
	return 0;
}

static int read_plot_title(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &((struct plot_form *)target)->plot->title);
}

static int read_plot_columns(const struct reader *reader, const struct node *node, void *target)
{
	return reader_integer(reader, node, 1, 8, &((struct plot_form *)target)->plot->columns);
}

static int read_panels(const struct reader *reader, const struct node *node, void *target)
{
	if (node->kind != NODE_SEQUENCE || !node->count)
		return reader_fail(reader, node, "a list of panels is wanted here");
	((struct plot_form *)target)->panels = node;
	return 0;
}

/* The keys of a panel; `title` of a plot is that of the whole figure. */
#define PANEL_KEYS                                                                                 \
	{"kind", read_kind,                                                                            \
		"series, profile, column, gauge, map or metric: what is shown along which axis "           \
		"(experiments/README.md)"},                                                                \
		{"y", read_y, "datasets of the run file (`ncdump -h` lists them), or metrics"},            \
		{"x", read_x, "of kind metric: a key of the config, or `at`"},                             \
		{"at", read_at,                                                                            \
			"profile times; `all`: those of the file, at most nine; without it the last"},         \
		{"at_x", read_at_x,                                                                        \
			"positions, of which the nearest cell is taken; not needed where there is one cell"},  \
		{"layer", read_layer,                                                                      \
			"layers counted from 1 at the bed, or `top`; without it the top layer, of pressures "  \
			"the bed"},                                                                            \
		{"lines", read_lines,                                                                      \
			"config keys, and `y`, `at`, `at_x`, `layer`: a line for each of their values"},       \
		{"split", read_split, "the same: a panel for each of their values"},                       \
		{"only", read_only, "values that runs must have to be shown"},                             \
		{"baseline", read_baseline, "as in a table, for the metrics that compare"},                \
		{"reference", read_reference, "as in a table, for the metrics that compare"},              \
		{"dimensionless", read_dimensionless,                                                      \
			"true: lengths over h_0, times over tau_c, velocities over v_0 (P1)"},                 \
		{"coordinates", read_coordinates,                                                          \
			"local or cartesian: h over x as a run in these would have it (default: same, as it "  \
			"is)"},                                                                                \
		{"above_bed", read_above_bed,                                                              \
			"true: h, h_gauge or h_station without the erodible bed layer"},                       \
		{"log", read_log, "`x`, `y` or both"},                                                     \
		{"x_range", read_x_range, "`[from, to]` in the unit of the axis"},                         \
		{"y_range", read_y_range, "`[from, to]` in the unit of the axis"},                         \
		{"x_unit", read_x_unit, "`mm`, `ms`, ... instead of SI, or of dimensionless"},             \
		{"y_unit", read_y_unit, "`mm`, `ms`, ... instead of SI, or of dimensionless"},             \
		{"x_label", read_x_label, "instead of what the program writes"},                           \
		{"y_label", read_y_label, "instead of what the program writes"},                           \
		{"names", read_names, "what the legend says for a value: `{hydrostatic: H}`"},             \
		{"published", read_panel_published,                                                        \
			"`[{title: P1, line: [hydrostatic], points: [[x, y], ...]}]`, in the units of the "    \
			"axes"},

static const struct reader_key plot_keys[] = {
	{"name", read_name, "name of the files; letters, digits and -._; required"},
	{"title", read_plot_title, "above the figure"},
	{"columns", read_plot_columns, "panels in a row, 1 to 8"},
	{"panels", read_panels, "a list of panels, whose keys replace those of the plot"}, PANEL_KEYS};
static const struct reader_key panel_keys[] = {
	{"title", read_panel_title, "above the panel"}, PANEL_KEYS};
void experiment_plots_reference(struct text *out)
{
	reader_reference(out, "A plot", plot_keys, sizeof plot_keys / sizeof *plot_keys);
	reader_reference(
		out, "Published points of a plot", points_keys, sizeof points_keys / sizeof *points_keys);
}

static int read_panel(const struct reader *reader, const struct node *plot, const struct node *own,
	struct plot_form *form)
{
	struct experiment_panel *panel = form->panel;

	panel->title = panel->labels[0] = panel->labels[1] = "";
	TRY(reader_keys(reader, plot, plot_keys, sizeof plot_keys / sizeof *plot_keys, form));
	if (own)
		TRY(reader_keys(reader, own, panel_keys, sizeof panel_keys / sizeof *panel_keys, form));
	if (!form->plot->name.text) {
		(void)reader_fail(reader, plot, "this plot lacks its 'name'");
		return -1;
	}
	if (!panel->kind.text)
		return reader_fail(
			reader, own ? own : plot, "plot '%s' lacks its 'kind'", form->plot->name.text);
	if (!panel->y.count)
		return reader_fail(
			reader, own ? own : plot, "plot '%s' lacks its 'y'", form->plot->name.text);
	return 0;
}

static int read_plot(
	const struct reader *reader, const struct node *node, struct experiment_plot *plot)
{
	const struct node *panels = node->kind == NODE_MAPPING ? node_find(node, "panels") : NULL;
	size_t count = panels && panels->count ? panels->count : 1;

	plot->title = "";
	plot->panels = calloc(count, sizeof *plot->panels);
	if (!plot->panels)
		return error_memory(reader->err, count * sizeof *plot->panels);
	plot->panel_count = count;
	for (size_t i = 0; i < count; i++) {
		struct plot_form form = {.plot = plot, .panel = &plot->panels[i]};

		TRY(read_panel(reader, node, panels && panels->count ? &panels->items[i] : NULL, &form));
	}
	return 0;
}

int experiment_plots_read(
	const struct reader *reader, const struct node *node, struct experiment *experiment)
{
	if (node->kind != NODE_SEQUENCE)
		return reader_fail(reader, node, "a list of plots is wanted here");
	experiment->plots = calloc(node->count ? node->count : 1, sizeof *experiment->plots);
	if (!experiment->plots)
		return error_memory(reader->err, node->count * sizeof *experiment->plots);
	for (size_t i = 0; i < node->count; i++) {
		struct experiment_plot *plot = &experiment->plots[i];

		experiment->plot_count = i + 1;
		TRY(read_plot(reader, &node->items[i], plot));
		for (size_t k = 0; k < i; k++)
			if (plot->name.text && !strcmp(experiment->plots[k].name.text, plot->name.text))
				return reader_fail(
					reader, &node->items[i], "plot '%s' stands here twice", plot->name.text);
	}
	return 0;
}

static void panel_clean(struct experiment_panel *panel)
{
	struct term_list *const lists[] = {&panel->y, &panel->at, &panel->at_x, &panel->layer,
		&panel->lines, &panel->split, &panel->log, &panel->ranges[0], &panel->ranges[1]};

	for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
		free(lists[i]->items);
	setting_list_clean(&panel->baseline);
	setting_list_clean(&panel->reference);
	setting_list_clean(&panel->only);
	points_clean(panel);
}

void experiment_plots_clean(struct experiment *experiment)
{
	for (size_t i = 0; i < experiment->plot_count; i++) {
		for (size_t k = 0; k < experiment->plots[i].panel_count; k++)
			panel_clean(&experiment->plots[i].panels[k]);
		free(experiment->plots[i].panels);
	}
	free(experiment->plots);
}
