/* Measured values as points of a panel. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plots/meaning.h"
#include "plots/panel_parts.h"

/* Is this very curve there already? Many runs share what was observed. */
static bool is_there(const struct panel *panel, const struct curve *curve)
{
	for (size_t i = 0; i + 1 < panel->curves.count; i++) {
		const struct curve *other = &panel->curves.items[i];
		bool same = other->title && !strcmp(other->title, curve->title);

		for (size_t k = 0; k < CURVES_PARTS_MAX && same; k++)
			same = !strcmp(
				other->parts[k] ? other->parts[k] : "", curve->parts[k] ? curve->parts[k] : "");
		if (same)
			return true;
	}
	return false;
}

/* Points of a dataset as they were observed, at a time (NaN: at any), in the panel of a run. */
static int add_points(struct panel *panel, const struct kind_request *request, size_t run, size_t o,
	const char *name, const char *at, double time, struct error *err)
{
	const struct experiment_run *one = &panel->experiment->runs[run];
	const struct kind_run source = {.config = &one->config};
	const char *parts[CURVES_PARTS_MAX];
	size_t rows = panel->table.rows.count, count = panel_parts(panel, run, parts);
	struct observed_line line = {0};
	struct curve *curve;
	double factors[2];

	if (observed_line(&panel->layout.observed[o], name, time, &line, err))
		goto failed;
	if (!line.count) {
		observed_line_clean(&line);
		return 0;
	}
	curve = curves_add(&panel->curves, err);
	if (!curve)
		goto failed;
	curve->x = line.at;
	curve->y = line.values;
	curve->count = line.count;
	curve->title = strdup(panel->experiment->observations[o].title);
	if (!curve->title)
		return error_memory(err, 1);
	for (size_t i = 0; i < rows; i++)
		TRY(curves_set_part(curve, i, parts[i], err));
	TRY(curves_set_part(curve, count + KIND_Y, name, err));
	TRY(curves_set_part(curve, count + KIND_AT, at, err));
	if (is_there(panel, curve)) {
		curves_drop(&panel->curves);
		return 0;
	}
	for (int axis = 0; axis < 2; axis++)
		TRY(kind_axis(request, &source, axis,
			&(struct meaning){.name = axis ? name : panel->kind->along,
				.unit = text_string(&panel->curves.units[axis])},
			&factors[axis], err));
	for (size_t i = 0; i < curve->count; i++) {
		curve->x[i] *= factors[0];
		curve->y[i] *= factors[1];
	}
	return 0;
failed:
	observed_line_clean(&line);
	return -1;
}

int panel_add_observed(struct panel *panel, const struct kind_request *request, struct error *err)
{
	const struct experiment *experiment = panel->experiment;
	bool over_x = !strcmp(panel->kind->along, "x");

	/* without anything of ours there is no panel either */
	for (size_t o = 0; panel->curves.count && o < experiment->observation_count; o++)
		for (size_t i = 0; i < experiment->run_count; i++) {
			bool has = panel->layout.places[i].row != LAYOUT_NOWHERE;

			if (has)
				TRY(experiment_has(experiment, &experiment->runs[i],
					&experiment->observations[o].only, &has, err));
			for (size_t k = 0; has && k < panel->wanted->y.count; k++) {
				const char *name = panel->wanted->y.items[k].text;

				if (!observed_has(&panel->layout.observed[o], name, over_x))
					continue;
				if (!over_x)
					TRY(add_points(panel, request, i, o, name, NULL, NAN, err));
				for (size_t t = 0; over_x && t < panel->cuts.time_count; t++)
					TRY(add_points(panel, request, i, o, name, panel->wanted->at.items[t].text,
						panel->cuts.times[t], err));
			}
		}
	return 0;
}
