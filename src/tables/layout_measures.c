/* What a table shows of its runs: every metric at its times and positions. */
#include "tables/layout.h"

#include <math.h>
#include <stdlib.h>

#include "config/quantity.h"
#include "talus/config.h"

int layout_check_time(const struct layout *layout, const struct term *term, double at,
	const char *at_text, struct error *err)
{
	for (size_t i = 0; i < layout->experiment->run_count; i++) {
		const struct config *config = &layout->experiment->runs[i].config;
		const struct real_list *times = &config->output.profiles_at;
		bool found = false;

		for (int k = 0; k < times->count; k++)
			found |= times->values[k] == (isnan(at) ? config->time.end : at);
		if (layout->places[i].row != LAYOUT_NOWHERE && !found)
			return layout_fail(layout, term, err, "run %s has no %s in its output.profiles_at",
				layout->experiment->runs[i].id, at_text);
	}
	return 0;
}

/* What is compared with observations needs some of every run, at the time of the comparison. */
static int check_observed(const struct layout *layout, const struct measure *measure,
	const struct term *term, struct error *err)
{
	const struct metric *metric = measure->metric;

	for (size_t i = 0; i < layout->experiment->run_count; i++) {
		const struct experiment_run *run = &layout->experiment->runs[i];
		double at = isnan(measure->at) ? run->config.time.end : measure->at;
		const struct observed *observed;
		struct observed_line line;
		int result;

		if (layout->places[i].row == LAYOUT_NOWHERE)
			continue;
		TRY(layout_observed(
			layout, run, metric->observes, metric->extent != METRIC_RUN, &observed, err));
		if (!observed)
			return layout_fail(layout, term, err, "run %s has no observations of %s over %s",
				run->id, metric->observes, metric->extent != METRIC_RUN ? "x" : "time");
		result = observed_line(observed, metric->observes, at, &line, err);
		if (!result && line.count < 2)
			result = layout_fail(layout, term, err,
				"the observations of run %s have fewer than two values of %s at %g s", run->id,
				metric->observes, at);
		observed_line_clean(&line);
		TRY(result);
	}
	return 0;
}

static int add_measure(struct layout *layout, const struct metric *metric, const struct term *name,
	const struct term *at, const struct term *x, struct error *err)
{
	struct measure *measure = &layout->measures[layout->measure_count++];

	*measure = (struct measure){metric, NAN, at ? at->text : NULL, NAN, x ? x->text : NULL};
	if (metric->extent == METRIC_COLUMN && !x)
		return layout_fail(layout, name, err, "%s is taken at a position: 'at_x'", metric->name);
	if (x && quantity_read(x->text, "m", &measure->x, err))
		return layout_place_error(layout, x, err);
	if (at && quantity_read(at->text, "s", &measure->at, err))
		return layout_place_error(layout, at, err);
	if (metric->extent != METRIC_RUN)
		TRY(layout_check_time(
			layout, at ? at : name, measure->at, at ? at->text : "time.end", err));
	return metric->observes ? check_observed(layout, measure, at ? at : name, err) : 0;
}

static const struct term *term(const struct term_list *list, size_t i)
{
	return i < list->count ? &list->items[i] : NULL;
}

int layout_list_measures(struct layout *layout, struct error *err)
{
	const struct term_list *names = &layout->wanted->metrics, *at = &layout->wanted->at;
	const struct term_list *at_x = &layout->wanted->at_x;
	size_t most = names->count * (at->count + 1) * (at_x->count + 1);

	layout->measures = calloc(most + 1, sizeof *layout->measures);
	if (!layout->measures)
		return error_memory(err, most * sizeof *layout->measures);
	for (size_t i = 0; i < names->count; i++) {
		const char *nearest;
		const struct metric *metric = metric_find(names->items[i].text, &nearest);

		if (!metric) {
			(void)layout_fail(layout, &names->items[i], err,
				"unknown metric '%s'; the nearest known one is '%s'", names->items[i].text,
				nearest);
			return -1;
		}
		size_t times = metric->extent != METRIC_RUN && at->count ? at->count : 1;
		size_t positions = metric->extent == METRIC_COLUMN && at_x->count ? at_x->count : 1;

		for (size_t k = 0; k < times; k++)
			for (size_t p = 0; p < positions; p++)
				TRY(add_measure(layout, metric, &names->items[i],
					metric->extent != METRIC_RUN ? term(at, k) : NULL,
					metric->extent == METRIC_COLUMN ? term(at_x, p) : NULL, err));
	}
	return 0;
}
