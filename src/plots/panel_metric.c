/* Metrics as points of a panel: what a table shows, drawn. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plots/meaning.h"
#include "plots/panel_parts.h"
#include "tables/measured.h"

int panel_key_number(const struct panel *panel, const struct experiment_run *run, double *value,
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
	size_t count = panel_parts(panel, run, parts);
	struct meaning y = {.name = measure->metric->name,
		.words = measure->metric->header,
		.unit = measure->metric->unit};
	struct text unit = {0};
	double x = isnan(measure->at) ? config->time.end : measure->at, factors[2];
	struct curve *curve;

	parts[count++] = measure->metric->name;
	parts[count++] = panel_over_key(panel) ? measure->at_text : NULL;
	if (panel_over_key(panel) &&
		panel_key_number(panel, &panel->experiment->runs[run], &x, &unit, err)) {
		text_clean(&unit);
		return -1;
	}
	int result = kind_axis(request, &one, 0,
		panel_over_key(panel)
			? &(struct meaning){.name = panel->wanted->x.text, .unit = text_string(&unit)}
			: &(struct meaning){.name = "time", .unit = "s"},
		&factors[0], err);

	text_clean(&unit);
	TRY(result);
	TRY(kind_axis(request, &one, 1, &y, &factors[1], err));
	curve = find_curve(panel, parts, count, err);
	return curve ? add_point(curve, x * factors[0], value * factors[1], err) : -1;
}

int panel_add_metrics(struct panel *panel, struct figure *figure, struct error *err)
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
