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

static int open_partner(
	struct measured *measured, size_t index, struct run_file **out, struct error *err)
{
	if (!measured->partner || measured->partner_index != index) {
		run_file_close(measured->partner);
		measured->partner_index = index;
		TRY(measured_open(&measured->layout->experiment->runs[index], "", NULL, &measured->warnings,
			&measured->partner, err));
	}
	*out = measured->partner;
	return 0;
}

static void tell_missing(struct measured *measured, const struct experiment_run *run,
	const char *why, const char *reason)
{
	tell(&measured->missing, measured->layout->what, run, why, reason);
}

static int measure(struct measured *measured, size_t index, struct run_file *file,
	const struct measure *measure, double *value, struct error *err)
{
	const struct experiment *experiment = measured->layout->experiment;
	const struct experiment_run *run = &experiment->runs[index];
	const struct metric *metric = measure->metric;
	struct sample sample = {.file = file, .config = &run->config, .at = measure->at};
	struct error refusal = {0};

	if (isnan(sample.at))
		sample.at = run->config.time.end;
	if (metric->partner != PARTNER_NONE) {
		size_t partner = measured->layout->places[index].partner[metric->partner];

		if (partner == index)
			sample.partner = file;
		else
			TRY(open_partner(measured, partner, &sample.partner, err));
		if (!sample.partner) {
			tell_missing(
				measured, run, "lacks the run it is compared with", experiment->runs[partner].id);
			return 0;
		}
	}
	if ((metric->observes && layout_observed(measured->layout, run, metric->observes,
								 metric->profile, &sample.observed, &refusal)) ||
		metric->value(&sample, value, &refusal)) {
		*value = NAN;
		if (refusal.code == EX_SOFTWARE) {
			*err = refusal;
			return -1;
		}
		tell_missing(measured, run, metric->name, refusal.text);
	} else if (!isfinite(*value)) {
		*value = NAN;
		tell_missing(measured, run, metric->name, "is not a number");
	} else if (measured->layout->wanted->dimensionless && scale_find(metric->name, metric->unit)) {
		*value /= scale_find(metric->name, metric->unit)->value(&run->config);
	}
	return 0;
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
			(void)measure(
				measured, i, file, &layout->measures[m], &measured->values[i * measures + m], err);
		provenance_add(&measured->provenance, file);
		run_file_close(file);
		if (err->code)
			return -1;
	}
	return 0;
}

void measured_clean(struct measured *measured)
{
	run_file_close(measured->partner);
	free(measured->values);
	provenance_clean(&measured->provenance);
	text_clean(&measured->warnings);
	text_clean(&measured->missing);
	*measured = (struct measured){0};
}
