/* Numbers of one series over the whole run. */
#include <math.h>
#include <stdlib.h>

#include "tables/metric_parts.h"

int metric_series_last(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	*out = data.values[metric_count(&data) - 1];
	free(data.values);
	return 0;
}

int metric_series_greatest(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	*out = data.values[0];
	for (size_t i = 1; i < metric_count(&data); i++)
		*out = fmax(*out, data.values[i]);
	free(data.values);
	return 0;
}

int metric_series_least(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	*out = data.values[0];
	for (size_t i = 1; i < metric_count(&data); i++)
		*out = fmin(*out, data.values[i]);
	free(data.values);
	return 0;
}

/* The largest relative distance from the first value, in units of 1e-12. */
int metric_series_drift(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	*out = 0;
	for (size_t i = 1; i < metric_count(&data); i++)
		*out = fmax(*out, 1e12 * fabs(data.values[i] / data.values[0] - 1));
	free(data.values);
	return 0;
}

/* The same of what is there and what has left through the ends, in units of 1e-15. */
int metric_mass_drift(const struct sample *sample, double *out, struct error *err)
{
	struct dataset mass = {0}, left = {0};
	int result = -1;

	if (metric_read(sample->file, sample->metric->dataset, &mass, err) ||
		metric_read(sample->file, "mass_outflow", &left, err))
		goto done;
	*out = 0;
	for (size_t i = 1; i < metric_count(&mass) && i < metric_count(&left); i++) {
		double whole = (mass.values[i] + left.values[i]) / (mass.values[0] + left.values[0]);

		*out = fmax(*out, 1e15 * fabs(whole - 1));
	}
	result = 0;
done:
	free(mass.values);
	free(left.values);
	return result;
}

/* How far the series rises between two records at most, or in all, relative to its first value. */
static int rises(const struct sample *sample, bool all, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	*out = 0;
	for (size_t i = 1; i < metric_count(&data); i++) {
		double rise = fmax(0, data.values[i] - data.values[i - 1]) / fabs(data.values[0]);

		*out = all ? *out + rise : fmax(*out, rise);
	}
	free(data.values);
	return 0;
}

int metric_series_rise(const struct sample *sample, double *out, struct error *err)
{
	return rises(sample, false, out, err);
}

int metric_series_rises(const struct sample *sample, double *out, struct error *err)
{
	return rises(sample, true, out, err);
}

/* What of its first value is gone at the end, in percent. */
int metric_series_loss(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	*out = 100 * (1 - data.values[metric_count(&data) - 1] / data.values[0]);
	free(data.values);
	return 0;
}

/* A series and the times of its values. */
int metric_read_series(struct run_file *file, const char *name, struct dataset *times,
	struct dataset *values, struct error *err)
{
	TRY(metric_read(file, "time", times, err));
	if (metric_read(file, name, values, err) == 0 && metric_count(times) == metric_count(values))
		return 0;
	free(times->values);
	free(values->values);
	times->values = values->values = NULL;
	(void)error_set(err, EX_DATAERR, "series '%s' has no time for each value", name);
	return -1;
}

/* When the series first passes `level`, linear between its values; NaN: never. */
static double crossing(const struct dataset *times, const struct dataset *values, double level)
{
	for (size_t i = 1; i < metric_count(values); i++) {
		double before = values->values[i - 1] - level, after = values->values[i] - level;

		if ((before < 0) != (after < 0) && before != 0)
			return times->values[i - 1] +
				   (times->values[i] - times->values[i - 1]) * before / (before - after);
	}
	return NAN;
}

/* When the series first reaches half its last value. */
int metric_series_half_time(const struct sample *sample, double *out, struct error *err)
{
	struct dataset times = {0}, values = {0};

	TRY(metric_read_series(sample->file, sample->metric->dataset, &times, &values, err));
	*out = crossing(&times, &values, 0.5 * values.values[metric_count(&values) - 1]);
	free(times.values);
	free(values.values);
	return 0;
}

int metric_series_sign_change(const struct sample *sample, double *out, struct error *err)
{
	struct dataset times = {0}, values = {0};

	TRY(metric_read_series(sample->file, sample->metric->dataset, &times, &values, err));
	*out = crossing(&times, &values, 0);
	free(times.values);
	free(values.values);
	return 0;
}

/* The largest distance from the reference, linear between its values, in percent of its largest. */
int metric_series_difference(const struct sample *sample, double *out, struct error *err)
{
	struct dataset times = {0}, values = {0}, at = {0}, reference = {0};
	double worst = 0, largest = 0;
	size_t k = 1, count;

	TRY(metric_read_series(sample->file, sample->metric->dataset, &times, &values, err));
	if (metric_read_series(sample->partner, sample->metric->dataset, &at, &reference, err)) {
		free(times.values);
		free(values.values);
		return -1;
	}
	count = metric_count(&reference);
	for (size_t i = 0; i < count; i++)
		largest = fmax(largest, fabs(reference.values[i]));
	for (size_t i = 0; i < metric_count(&values) && count > 1; i++) {
		double share, between;

		while (k + 1 < count && at.values[k] < times.values[i])
			k++;
		share = (times.values[i] - at.values[k - 1]) / (at.values[k] - at.values[k - 1]);
		between = reference.values[k - 1] + share * (reference.values[k] - reference.values[k - 1]);
		worst = fmax(worst, fabs(values.values[i] - between));
	}
	*out = 100 * worst / largest;
	free(times.values);
	free(values.values);
	free(at.values);
	free(reference.values);
	return 0;
}
