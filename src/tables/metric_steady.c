/* Profiles over the layers against the exact steady flow that the model stores beside them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tables/metric_parts.h"

/* One row of a profile_time by layer dataset. `values` belongs to the caller. */
static int read_row(
	struct run_file *file, const char *name, double time, struct dataset *out, struct error *err)
{
	size_t row;

	TRY(metric_profile_row(file, time, &row, err));
	TRY(metric_read(file, name, out, err));
	if (out->rank != 2 || row >= out->extent[0]) {
		free(out->values);
		out->values = NULL;
		(void)error_set(err, EX_DATAERR, "dataset '%s' is not profile_time by layer", name);
		return -1;
	}
	memmove(out->values, out->values + row * out->extent[1], out->extent[1] * sizeof *out->values);
	return 0;
}

/* ||x - exact||/||exact||, layers weighted by their thickness; power 0: the largest. */
static int compare(
	struct run_file *file, const char *name, double at, int power, double *out, struct error *err)
{
	struct dataset mine = {0}, exact = {0}, interface = {0};
	double apart = 0, whole = 0;
	char steady[64];
	int result = -1;

	(void)snprintf(steady, sizeof steady, "%s_steady", name);
	if (read_row(file, name, at, &mine, err) || read_row(file, steady, at, &exact, err) ||
		metric_read(file, "interface", &interface, err))
		goto done;
	if (exact.extent[1] != mine.extent[1] || interface.extent[0] != mine.extent[1] + 1) {
		error_set(err, EX_DATAERR, "'%s' and '%s' have different layers", name, steady);
		goto done;
	}
	for (size_t a = 0; a < mine.extent[1]; a++) {
		double weight = interface.values[a + 1] - interface.values[a];
		double off = fabs(mine.values[a] - exact.values[a]), all = fabs(exact.values[a]);

		apart = power ? apart + weight * pow(off, power) : fmax(apart, off);
		whole = power ? whole + weight * pow(all, power) : fmax(whole, all);
	}
	*out = power ? pow(apart / whole, 1.0 / power) : apart / whole;
	result = 0;
done:
	free(mine.values);
	free(exact.values);
	free(interface.values);
	return result;
}

int metric_steady_l1(const struct sample *sample, double *out, struct error *err)
{
	return compare(sample->file, sample->metric->dataset, sample->at, 1, out, err);
}

int metric_steady_l2(const struct sample *sample, double *out, struct error *err)
{
	return compare(sample->file, sample->metric->dataset, sample->at, 2, out, err);
}

int metric_steady_linf(const struct sample *sample, double *out, struct error *err)
{
	return compare(sample->file, sample->metric->dataset, sample->at, 0, out, err);
}

int metric_layer_max(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(read_row(sample->file, sample->metric->dataset, sample->at, &data, err));
	*out = data.values[0];
	for (size_t a = 1; a < data.extent[1]; a++)
		*out = fmax(*out, data.values[a]);
	free(data.values);
	return 0;
}
