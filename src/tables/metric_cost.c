/* What a run costs. */
#include <stdlib.h>

#include "run/run_file_parts.h"
#include "tables/metric_parts.h"

/* In percent of the CPU time of the whole run. */
int metric_share(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};
	double all, sum = 0;

	TRY(run_file_real(sample->file, "cpu_seconds", &all, err));
	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	for (size_t i = 0; i < metric_count(&data); i++)
		sum += data.values[i];
	free(data.values);
	*out = 100 * sum / all;
	return 0;
}

int metric_cpu_seconds(const struct sample *sample, double *out, struct error *err)
{
	return run_file_real(sample->file, "cpu_seconds", out, err);
}

int metric_speed_up(const struct sample *sample, double *out, struct error *err)
{
	double mine, baseline;

	TRY(run_file_real(sample->file, "cpu_seconds", &mine, err));
	TRY(run_file_real(sample->partner, "cpu_seconds", &baseline, err));
	*out = baseline / mine;
	return 0;
}

/* CPU time of the whole run per cell, layer and step, in ns; a model without x is one cell. */
int metric_ns_per_unknown(const struct sample *sample, double *out, struct error *err)
{
	struct dataset x = {0};
	struct error none = {0};
	double cells = 1;

	TRY(run_file_real(sample->file, "cpu_seconds", out, err));
	if (run_file_dataset(sample->file, "x", &x, &none) == 0 && metric_count(&x))
		cells = (double)metric_count(&x);
	free(x.values);
	*out *= 1e9 / (cells * sample->config->layers * (double)run_file_summary(sample->file)->step);
	return 0;
}

int metric_steps(const struct sample *sample, double *out, struct error *err)
{
	(void)err;
	*out = (double)run_file_summary(sample->file)->step;
	return 0;
}
