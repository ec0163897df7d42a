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

int measured_open(const struct experiment_run *run, const char *what, struct text *missing,
	struct text *warnings, struct run_file **out, struct error *err)
{
	struct run_report report;
	struct text warning = {0};
	struct error damage = {0};

	*out = NULL;
	run_report_read(run->folder, &report);
	if (report.unknown)
		return error_memory(err, sizeof report);
	if (report.state != RUN_STATE_COMPLETE) {
		tell(missing, what, run, run_state_name(report.state), report.reason);
		return 0;
	}
	if (run_file_open_newest(run->folder, out, &warning, &damage) && damage.code != EX_SOFTWARE) {
		char message[sizeof damage.text + sizeof damage.file + 32];

		tell(missing, what, run, "damaged", error_format(&damage, message, sizeof message));
	}
	if (*out && warning.length && warnings)
		text_addf(warnings, "%s: %s\n", run->id, text_string(&warning));
	text_clean(&warning);
	if (damage.code != EX_SOFTWARE)
		return 0;
	*err = damage;
	return -1;
}

/* The run that another is compared with, kept open for the next; NULL if it is not there. */
static struct run_file *open_other(
	struct measured *measured, struct measured_other *other, size_t index, struct error *err)
{
	if (other->file && other->index == index)
		return other->file;
	run_file_close(other->file);
	other->index = index;
	(void)measured_open(&measured->layout->experiment->runs[index], "", NULL, &measured->warnings,
		&other->file, err);
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

/* What the metric says of one run; of an order, its error. Out of memory is told in `err`, and NaN. */
static double evaluate(struct measured *measured, size_t index, struct run_file *file,
	const struct measure *measure, struct error *err)
{
	const struct experiment_run *run = &measured->layout->experiment->runs[index];
	const struct metric *metric = measure->metric;
	enum metric_partner kind = metric_partner(metric);
	struct sample sample = {
		.file = file, .config = &run->config, .at = measure->at, .x = measure->x, .metric = metric};
	struct error refusal = {0};
	double value = NAN;

	if (isnan(sample.at))
		sample.at = run->config.time.end;
	if (kind != PARTNER_NONE) {
		size_t partner = measured->layout->places[index].partner[kind];

		sample.partner =
			partner == index ? file : open_other(measured, &measured->partner, partner, err);
		if (!sample.partner)
			return err->code ? NAN : miss_other(measured, index, partner);
		sample.partner_config = &measured->layout->experiment->runs[partner].config;
	}
	if ((metric->observes && layout_observed(measured->layout, run, metric->observes,
								 metric->extent != METRIC_RUN, &sample.observed, &refusal)) ||
		metric->value(&sample, &value, &refusal)) {
		if (refusal.code != EX_SOFTWARE)
			return miss(measured, index, metric->name, refusal.text);
		*err = refusal;
		return NAN;
	}
	return isfinite(value) ? value : miss(measured, index, metric->name, "is not a number");
}

/* The order of `error` in a run that has a row before it. */
static double evaluate_order(struct measured *measured, size_t index, const struct measure *measure,
	double error, struct error *err)
{
	const struct experiment_run *runs = measured->layout->experiment->runs;
	size_t previous = measured->layout->places[index].previous;
	struct run_file *file = open_other(measured, &measured->previous, previous, err);
	struct error refusal = {0};
	double before, order;

	if (!file)
		return err->code ? NAN : miss_other(measured, index, previous);
	before = evaluate(measured, previous, file, measure, err);
	if (isnan(before))
		return NAN;
	if (metric_order(&runs[previous].config, before, &runs[index].config, error, &order, &refusal))
		return miss(measured, index, measure->metric->name, refusal.text);
	return isfinite(order) ? order
						   : miss(measured, index, measure->metric->name, "is not a number");
}

static double measure(struct measured *measured, size_t index, struct run_file *file,
	const struct measure *measure, struct error *err)
{
	const struct layout *layout = measured->layout;
	const struct metric *metric = measure->metric;
	const struct scale *scale =
		layout->wanted->dimensionless ? scale_find(metric->name, metric->unit) : NULL;
	double value;

	if (!layout_asks(layout, index, metric))
		return NAN;
	value = evaluate(measured, index, file, measure, err);
	if (metric_is_order(metric) && !isnan(value))
		value = evaluate_order(measured, index, measure, value, err);
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
		TRY(measured_open(run, layout->what, &measured->missing, &measured->warnings, &file, err));
		if (!file)
			continue;
		for (size_t m = 0; m < measures && !err->code; m++)
			measured->values[i * measures + m] =
				measure(measured, i, file, &layout->measures[m], err);
		provenance_add(&measured->provenance, file);
		run_file_close(file);
		if (err->code)
			return -1;
	}
	return 0;
}

void measured_clean(struct measured *measured)
{
	run_file_close(measured->partner.file);
	run_file_close(measured->previous.file);
	free(measured->values);
	provenance_clean(&measured->provenance);
	text_clean(&measured->warnings);
	text_clean(&measured->missing);
	*measured = (struct measured){0};
}
