#include "plots/panel_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tables/measured.h"

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

bool panel_over_key(const struct panel *panel)
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
	for (size_t i = 0; wanted->above_bed && i < wanted->y.count; i++)
		if (!panel->kind->add || !kind_holds_bed(wanted->y.items[i].text))
			return error_at(err, EX_DATAERR, panel->experiment->path, wanted->y.items[i].line,
				wanted->y.items[i].column,
				"above_bed leaves the erodible bed out of h, h_gauge and h_station; it is not in "
				"'%s'",
				wanted->y.items[i].text);
	if (wanted->split.count && wanted->published_count)
		return error_at(err, EX_DATAERR, panel->experiment->path, wanted->split.items[0].line,
			wanted->split.items[0].column,
			"published values belong to one panel: list the 'panels' instead of splitting");
	return 0;
}

/* Stations are recorded with the series, at any time. */
static bool shows_profiles(const struct panel *panel)
{
	const struct term_list *names = &panel->wanted->y;
	bool profiles = false;

	for (size_t i = 0; i < names->count; i++) {
		const char *end = strrchr(names->items[i].text, '_');

		profiles |= !end || strcmp(end, "_station") != 0;
	}
	return panel->kind->timed && profiles;
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
	TRY(copy_keys(&wanted->lines, panel_over_key(panel) ? &wanted->x : NULL, &table->columns, err));
	table->only = wanted->only;
	if (!panel->kind->add) {
		table->metrics = wanted->y;
		table->at = wanted->at;
		table->at_x = wanted->at_x;
		table->baseline = wanted->baseline;
		table->reference = wanted->reference;
	}
	TRY(layout_create(&panel->layout, panel->experiment, table, "plot", err));
	for (size_t i = 0; shows_profiles(panel) && i < panel->cuts.time_count; i++)
		TRY(layout_check_time(&panel->layout, &wanted->at.items[i], panel->cuts.times[i],
			wanted->at.items[i].text, err));
	return 0;
}

/* The ways in which runs differ: first the panels', then the lines'. */
static int add_key_dimensions(struct panel *panel, struct error *err)
{
	const struct term_list *lists[] = {&panel->table.rows, &panel->table.columns};

	for (size_t l = 0; l < 2; l++) {
		size_t count = lists[l]->count - (l == 1 && panel_over_key(panel));

		for (size_t i = 0; i < count; i++)
			if (!curves_add_dimension(&panel->curves, lists[l]->items[i].text, l == 0, false))
				return layout_fail(&panel->layout, &panel->wanted->kind, err,
					"more than %d keys in lines and split", CURVES_PARTS_MAX - KIND_PARTS);
	}
	return 0;
}

size_t panel_parts(const struct panel *panel, size_t run, const char **parts)
{
	const struct place *place = &panel->layout.places[run];
	const struct label *row = &panel->layout.rows.items[place->row];
	const struct label *column = &panel->layout.columns.items[place->column];
	size_t count = 0, columns = panel->table.columns.count - panel_over_key(panel);

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
		TRY(measured_open(run, panel->layout.what, &figure->missing, NULL, &one.file, err));
		if (!one.file)
			continue;
		one.part_count = panel_parts(panel, i, parts);
		result = kind_add_run(&request, &one, err);
		run_file_close(one.file);
		TRY(result);
	}
	return !strcmp(panel->kind->name, "profile") || !strcmp(panel->kind->name, "series")
			   ? panel_add_observed(panel, &request, err)
			   : 0;
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
	result =
		panel.kind->add ? add_runs(&panel, figure, err) : panel_add_metrics(&panel, figure, err);
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

	if (!result && panel_over_key(&panel))
		result = panel_key_number(&panel, &experiment->runs[0], &value, &unit, err);
	text_clean(&unit);
	panel_clean(&panel);
	return result;
}
