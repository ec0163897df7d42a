#include "tables/measured.h"

#include <math.h>
#include <stdlib.h>

#include "tables/scale.h"
#include "talus/run.h"

static void tell(struct text *missing, const char *what, const struct experiment_run *run,
	const char *why, const char *reason)
{
	if (missing)
		text_addf(missing, "%s: run %s: %s%s%s\n", what, run->id, why, *reason ? ": " : "", reason);
}

struct run_file *measured_open(
	const struct experiment_run *run, const char *what, struct text *missing, struct text *warnings)
{
	struct run_report report;
	struct run_file *file = NULL;
	struct text warning = {0};
	struct error err = {0};

	run_report_read(run->folder, &report);
	if (report.state != RUN_STATE_COMPLETE) {
		tell(missing, what, run, run_state_name(report.state), report.reason);
		return NULL;
	}
	if (run_file_open_newest(run->folder, &file, &warning, &err)) {
		char message[sizeof err.text + sizeof err.file + 32];

		tell(missing, what, run, "damaged", error_format(&err, message, sizeof message));
	}
	if (file && warning.length && warnings)
		text_addf(warnings, "%s: %s\n", run->id, text_string(&warning));
	text_clean(&warning);
	return file;
}

static struct run_file *open_other(
	struct measured *measured, struct measured_other *other, size_t index)
{
	if (other->file && other->index == index)
		return other->file;
	run_file_close(other->file);
	other->file =
		measured_open(&measured->layout->experiment->runs[index], "", NULL, &measured->warnings);
	other->index = index;
	return other->file;
}

/* NaN, and why. */
static double miss(struct measured *measured, size_t index, const char *why, const char *reason)
{
	const struct layout *layout = measured->layout;

	tell(&measured->missing, layout->what, &layout->experiment->runs[index], why, reason);
	return NAN;
}

static double miss_other(struct measured *measured, size_t index, size_t other)
{
	return miss(measured, index, "lacks the run it is compared with",
		measured->layout->experiment->runs[other].id);
}

/* What the metric says of one run; of an order, its error. */
static double evaluate(
	struct measured *measured, size_t index, struct run_file *file, const struct measure *measure)
{
	const struct experiment_run *run = &measured->layout->experiment->runs[index];
	const struct metric *metric = measure->metric;
	enum metric_partner kind = metric_partner(metric);
	struct sample sample = {
		.file = file, .config = &run->config, .at = measure->at, .metric = metric};
	struct error err = {0};
	double value = NAN;

	if (isnan(sample.at))
		sample.at = run->config.time.end;
	if (kind != PARTNER_NONE) {
		size_t partner = measured->layout->places[index].partner[kind];

		sample.partner =
			partner == index ? file : open_other(measured, &measured->partner, partner);
		if (!sample.partner)
			return miss_other(measured, index, partner);
	}
	if ((metric->observes && layout_observed(measured->layout, run, metric->observes,
								 metric->profile, &sample.observed, &err)) ||
		metric->value(&sample, &value, &err))
		return miss(measured, index, metric->name, err.text);
	return isfinite(value) ? value : miss(measured, index, metric->name, "is not a number");
}

/* The order of `error` in a run that has a row before it. */
static double evaluate_order(
	struct measured *measured, size_t index, const struct measure *measure, double error)
{
	const struct experiment_run *runs = measured->layout->experiment->runs;
	size_t previous = measured->layout->places[index].previous;
	struct run_file *file = open_other(measured, &measured->previous, previous);
	struct error err = {0};
	double before, order;

	if (!file)
		return miss_other(measured, index, previous);
	before = evaluate(measured, previous, file, measure);
	if (isnan(before))
		return NAN;
	if (metric_order(&runs[previous].config, before, &runs[index].config, error, &order, &err))
		return miss(measured, index, measure->metric->name, err.text);
	return isfinite(order) ? order
						   : miss(measured, index, measure->metric->name, "is not a number");
}

static double measure(
	struct measured *measured, size_t index, struct run_file *file, const struct measure *measure)
{
	const struct layout *layout = measured->layout;
	const struct metric *metric = measure->metric;
	const struct scale *scale =
		layout->wanted->dimensionless ? scale_find(metric->name, metric->unit) : NULL;
	double value;

	if (!layout_asks(layout, index, metric))
		return NAN;
	value = evaluate(measured, index, file, measure);
	if (metric_is_order(metric) && !isnan(value))
		value = evaluate_order(measured, index, measure, value);
	return scale ? value / scale->value(&layout->experiment->runs[index].config) : value;
}

int measured_make(struct measured *measured, const struct layout *layout, struct error *err)
{
	size_t runs = layout->experiment->run_count, measures = layout->measure_count;

	*measured = (struct measured){.layout = layout};
	measured->values = calloc(runs * measures + 1, sizeof *measured->values);
	if (!measured->values)
		return error_memory(err, runs * measures * sizeof *measured->values);
	for (size_t i = 0; i < runs * measures; i++)
		measured->values[i] = NAN;
	for (size_t i = 0; i < runs; i++) {
		const struct experiment_run *run = &layout->experiment->runs[i];
		struct run_file *file;

		if (layout->places[i].row == LAYOUT_NOWHERE)
			continue;
		file = measured_open(run, layout->what, &measured->missing, &measured->warnings);
		if (!file)
			continue;
		for (size_t m = 0; m < measures; m++)
			measured->values[i * measures + m] = measure(measured, i, file, &layout->measures[m]);
		provenance_add(&measured->provenance, file);
		run_file_close(file);
	}
	run_file_close(measured->partner.file);
	run_file_close(measured->previous.file);
	measured->partner.file = measured->previous.file = NULL;
	return 0;
}

void measured_clean(struct measured *measured)
{
	free(measured->values);
	provenance_clean(&measured->provenance);
	text_clean(&measured->warnings);
	text_clean(&measured->missing);
	*measured = (struct measured){0};
}
