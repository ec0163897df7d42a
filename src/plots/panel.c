#include "plots/panel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "config/quantity.h"
#include "plots/kind.h"
#include "plots/meaning.h"
#include "tables/measured.h"

/* A panel on its way. */
struct panel {
	const struct experiment *experiment;
	const struct experiment_panel *wanted;
	const struct kind *kind;
	struct experiment_table table; /* the runs of the panel laid out: panels by lines (and x) */
	struct layout layout;
	struct kind_cuts cuts;
	struct curves curves;
};

static bool is_part(const char *name)
{
	static const char *const parts[] = {"y", "at", "at_x", "layer"};

	for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
		if (!strcmp(parts[i], name))
			return true;
	return false;
}

/* The config keys among the terms, and `more` behind them. */
static int copy_keys(const struct term_list *terms, const struct term *more, struct term_list *out,
	struct error *err)
{
	out->items = calloc(terms->count + 1, sizeof *out->items);
	if (!out->items)
		return error_memory(err, (terms->count + 1) * sizeof *out->items);
	for (size_t i = 0; i < terms->count; i++)
		if (!is_part(terms->items[i].text))
			out->items[out->count++] = terms->items[i];
	if (more)
		out->items[out->count++] = *more;
	return 0;
}

/* Is the metric drawn over a key of the config, rather than over the profile times? */
static bool over_key(const struct panel *panel)
{
	return !panel->kind->add && strcmp(panel->wanted->x.text, "at") != 0;
}

static int find_kind(struct panel *panel, struct error *err)
{
	const struct experiment_panel *wanted = panel->wanted;
	const char *nearest;

	panel->kind = kind_find(wanted->kind.text, &nearest);
	if (!panel->kind)
		return error_at(err, EX_DATAERR, panel->experiment->path, wanted->kind.line,
			wanted->kind.column, "unknown kind '%s' of plot; the nearest known one is '%s'",
			wanted->kind.text, nearest);
	if (!panel->kind->add && !wanted->x.text)
		return error_at(err, EX_DATAERR, panel->experiment->path, wanted->kind.line,
			wanted->kind.column, "a metric is drawn over something: 'x' is wanted, a key or at");
	if (panel->kind->add && wanted->x.text)
		return error_at(err, EX_DATAERR, panel->experiment->path, wanted->x.line, wanted->x.column,
			"only plots of kind metric have an 'x' of their own");
	if (wanted->split.count && wanted->published_count)
		return error_at(err, EX_DATAERR, panel->experiment->path, wanted->split.items[0].line,
			wanted->split.items[0].column,
			"published values belong to one panel: list the 'panels' instead of splitting");
	return 0;
}

/* Which run stands in which panel and line; refused as a table would be. */
static int lay_out(struct panel *panel, const struct experiment_plot *plot, struct error *err)
{
	const struct experiment_panel *wanted = panel->wanted;
	struct experiment_table *table = &panel->table;

	TRY(find_kind(panel, err));
	TRY(kind_cuts_read(&panel->cuts, wanted, panel->experiment->path, err));
	table->name = plot->name;
	TRY(copy_keys(&wanted->split, NULL, &table->rows, err));
	TRY(copy_keys(&wanted->lines, over_key(panel) ? &wanted->x : NULL, &table->columns, err));
	table->only = wanted->only;
	if (!panel->kind->add) {
		table->metrics = wanted->y;
		table->at = wanted->at;
		table->baseline = wanted->baseline;
		table->reference = wanted->reference;
	}
	TRY(layout_create(&panel->layout, panel->experiment, table, "plot", err));
	for (size_t i = 0; panel->kind->timed && i < panel->cuts.time_count; i++)
		TRY(layout_check_time(&panel->layout, &wanted->at.items[i], panel->cuts.times[i],
			wanted->at.items[i].text, err));
	return 0;
}

/* The ways in which runs differ: first the panels', then the lines'. */
static int add_key_dimensions(struct panel *panel, struct error *err)
{
	const struct term_list *lists[] = {&panel->table.rows, &panel->table.columns};

	for (size_t l = 0; l < 2; l++) {
		size_t count = lists[l]->count - (l == 1 && over_key(panel));

		for (size_t i = 0; i < count; i++)
			if (!curves_add_dimension(&panel->curves, lists[l]->items[i].text, l == 0, false))
				return layout_fail(&panel->layout, &panel->wanted->kind, err,
					"more than %d keys in lines and split", CURVES_PARTS_MAX - KIND_PARTS);
	}
	return 0;
}

/* The texts of a run in these dimensions; the panel's come first. Room for CURVES_PARTS_MAX. */
static size_t parts_of(const struct panel *panel, size_t run, const char **parts)
{
	const struct place *place = &panel->layout.places[run];
	const struct label *row = &panel->layout.rows.items[place->row];
	const struct label *column = &panel->layout.columns.items[place->column];
	size_t count = 0, columns = panel->table.columns.count - over_key(panel);

	for (size_t i = 0; i < panel->table.rows.count; i++)
		parts[count++] = row->parts[i];
	for (size_t i = 0; i < columns; i++)
		parts[count++] = column->parts[i];
	return count;
}

/* Datasets of every run. */
static int add_runs(struct panel *panel, struct figure *figure, struct error *err)
{
	struct kind_request request = {panel->kind, panel->wanted, &panel->cuts,
		panel->experiment->path, panel->layout.what, &panel->curves, &figure->missing};

	panel->curves.mark = panel->kind->mark;
	if (!kind_add_dimensions(&request))
		return error_set(err, EX_DATAERR, "too many keys in lines and split");
	for (size_t i = 0; i < panel->experiment->run_count; i++) {
		const struct experiment_run *run = &panel->experiment->runs[i];
		const char *parts[CURVES_PARTS_MAX];
		struct kind_run one = {.config = &run->config, .name = run->id, .parts = parts};
		int result;

		/* the repeats of a run are alike but for the clock */
		if (panel->layout.places[i].row == LAYOUT_NOWHERE || run->repeat > 1)
			continue;
		one.file = measured_open(run, panel->layout.what, &figure->missing, NULL);
		if (!one.file)
			continue;
		one.part_count = parts_of(panel, i, parts);
		result = kind_add_run(&request, &one, err);
		run_file_close(one.file);
		TRY(result);
	}
	return 0;
}

/* The number that a key has in a run, in SI, and its unit. */
static int key_number(const struct panel *panel, const struct experiment_run *run, double *value,
	struct text *unit, struct error *err)
{
	const struct term *key = &panel->wanted->x;
	struct text text = {0};
	char *end;
	int result = config_value(&run->config, key->text, &text, err);

	if (!result) {
		*value = strtod(text_string(&text), &end);
		unit->length = 0;
		text_add(unit, *end == ' ' ? end + 1 : end);
		if (end == text_string(&text))
			result = layout_fail(&panel->layout, key, err,
				"%s is %s, which is no number to draw over", key->text, text_string(&text));
	}
	text_clean(&text);
	return result;
}

static struct curve *find_curve(
	struct panel *panel, const char *const *parts, size_t count, struct error *err)
{
	struct curve *curve;

	for (size_t i = 0; i < panel->curves.count; i++) {
		bool same = true;

		for (size_t k = 0; k < count && same; k++)
			same = !strcmp(panel->curves.items[i].parts[k] ? panel->curves.items[i].parts[k] : "",
				parts[k] ? parts[k] : "");
		if (same)
			return &panel->curves.items[i];
	}
	curve = curves_add(&panel->curves, err);
	for (size_t k = 0; curve && k < count; k++)
		if (curves_set_part(curve, k, parts[k], err))
			return NULL;
	return curve;
}

/* Points are added in the order of the runs and sorted later. */
static int add_point(struct curve *curve, double x, double y, struct error *err)
{
	double *xs = realloc(curve->x, (curve->count + 1) * sizeof *xs), *ys;

	if (xs)
		curve->x = xs;
	ys = xs ? realloc(curve->y, (curve->count + 1) * sizeof *ys) : NULL;
	if (!ys)
		return error_memory(err, (curve->count + 1) * sizeof *xs);
	curve->y = ys;
	curve->x[curve->count] = x;
	curve->y[curve->count++] = y;
	return 0;
}

static int compare_points(const void *a, const void *b)
{
	const double *p = a, *q = b;

	if (p[0] != q[0])
		return (p[0] > q[0]) - (p[0] < q[0]);
	return (p[1] > q[1]) - (p[1] < q[1]);
}

/* Sort the points along x, and make of those at the same x, which repeats are, their median and half
 * their range. */
static int gather_points(struct curve *curve, struct error *err)
{
	double(*points)[2] = malloc((curve->count + 1) * sizeof *points);
	size_t count = 0;

	curve->spread = calloc(curve->count + 1, sizeof *curve->spread);
	if (!points || !curve->spread) {
		free(points);
		return error_memory(err, curve->count * sizeof *points);
	}
	for (size_t i = 0; i < curve->count; i++) {
		points[i][0] = curve->x[i];
		points[i][1] = curve->y[i];
	}
	qsort(points, curve->count, sizeof *points, compare_points);
	for (size_t first = 0, end; first < curve->count; first = end) {
		for (end = first + 1; end < curve->count && points[end][0] == points[first][0];)
			end++;
		curve->x[count] = points[first][0];
		curve->y[count] = (points[(first + end - 1) / 2][1] + points[(first + end) / 2][1]) / 2;
		curve->spread[count++] = (points[end - 1][1] - points[first][1]) / 2;
	}
	curve->count = count;
	free(points);
	return 0;
}

/* One value of one run, at its place in the panel. */
static int add_value(struct panel *panel, const struct kind_request *request, size_t run, size_t m,
	double value, struct error *err)
{
	const struct measure *measure = &panel->layout.measures[m];
	const struct config *config = &panel->experiment->runs[run].config;
	const struct kind_run one = {.config = config};
	const char *parts[CURVES_PARTS_MAX];
	size_t count = parts_of(panel, run, parts);
	struct meaning y = {.name = measure->metric->name,
		.words = measure->metric->header,
		.unit = measure->metric->unit};
	struct text unit = {0};
	double x = isnan(measure->at) ? config->time.end : measure->at, factors[2];
	struct curve *curve;

	parts[count++] = measure->metric->name;
	parts[count++] = over_key(panel) ? measure->at_text : NULL;
	if (over_key(panel) && key_number(panel, &panel->experiment->runs[run], &x, &unit, err)) {
		text_clean(&unit);
		return -1;
	}
	int result = kind_axis(request, &one, 0,
		over_key(panel)
			? &(struct meaning){.name = panel->wanted->x.text, .unit = text_string(&unit)}
			: &(struct meaning){.name = "time", .unit = "s"},
		&factors[0], err);

	text_clean(&unit);
	TRY(result);
	TRY(kind_axis(request, &one, 1, &y, &factors[1], err));
	curve = find_curve(panel, parts, count, err);
	return curve ? add_point(curve, x * factors[0], value * factors[1], err) : -1;
}

/* Metrics of every run, over a key or over the profile times. */
static int add_metrics(struct panel *panel, struct figure *figure, struct error *err)
{
	const struct layout *layout = &panel->layout;
	struct kind_request request = {panel->kind, panel->wanted, &panel->cuts,
		panel->experiment->path, layout->what, &panel->curves, &figure->missing};
	struct measured measured;
	int result = measured_make(&measured, layout, err);

	panel->curves.mark = FIGURE_LINE_POINTS;
	if (!result && !kind_add_dimensions(&request))
		result = error_set(err, EX_DATAERR, "too many keys in lines and split");
	for (size_t i = 0; !result && i < panel->experiment->run_count; i++)
		for (size_t m = 0; !result && m < layout->measure_count; m++) {
			double value = measured.values[i * layout->measure_count + m];

			if (!isnan(value))
				result = add_value(panel, &request, i, m, value, err);
		}
	for (size_t i = 0; !result && i < panel->curves.count; i++)
		result = gather_points(&panel->curves.items[i], err);
	text_add(&figure->missing, text_string(&measured.missing));
	measured_clean(&measured);
	return result;
}

static void set_axis(
	const struct experiment_panel *wanted, int index, const char *name, struct figure_axis *axis)
{
	const struct term_list *range = &wanted->ranges[index];

	axis->from = axis->to = NAN;
	if (range->count == 2) {
		(void)text_to_real(range->items[0].text, &axis->from);
		(void)text_to_real(range->items[1].text, &axis->to);
	}
	for (size_t i = 0; i < wanted->log.count; i++)
		axis->log |= !strcmp(wanted->log.items[i].text, name);
}

int panel_finish(struct curves *curves, const struct experiment_panel *wanted, const char *source,
	struct figure *figure, struct error *err)
{
	set_axis(wanted, 0, "x", &curves->x);
	set_axis(wanted, 1, "y", &curves->y);
	return curves_draw(curves, wanted, source, figure, err);
}

static void panel_clean(struct panel *panel)
{
	layout_clean(&panel->layout);
	kind_cuts_clean(&panel->cuts);
	curves_clean(&panel->curves);
	free(panel->table.rows.items);
	free(panel->table.columns.items);
}

int panel_build(const struct experiment *experiment, const struct experiment_plot *plot,
	const struct experiment_panel *wanted, struct figure *figure, struct error *err)
{
	struct panel panel = {.experiment = experiment, .wanted = wanted};
	int result = -1;

	if (lay_out(&panel, plot, err) || add_key_dimensions(&panel, err))
		goto done;
	result = panel.kind->add ? add_runs(&panel, figure, err) : add_metrics(&panel, figure, err);
	if (!result)
		result = panel_finish(&panel.curves, wanted, experiment->source, figure, err);
done:
	panel_clean(&panel);
	return result;
}

int panel_check(const struct experiment *experiment, const struct experiment_plot *plot,
	const struct experiment_panel *wanted, struct error *err)
{
	struct panel panel = {.experiment = experiment, .wanted = wanted};
	struct text unit = {0};
	double value;
	int result = lay_out(&panel, plot, err);

	if (!result && over_key(&panel))
		result = key_number(&panel, &experiment->runs[0], &value, &unit, err);
	text_clean(&unit);
	panel_clean(&panel);
	return result;
}
