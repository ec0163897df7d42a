/* Stored profiles: how far those stored later are from the first, and the greatest value of one. */
#include <math.h>
#include <stdlib.h>

#include "tables/metric_parts.h"

/* A dataset over profile_time and x, and layers where it has them, with what weights its values. */
struct history {
	struct dataset data, h, x, interface;
	size_t times, layers, cells;
};

static int history_read(
	struct run_file *file, const char *name, struct history *history, struct error *err)
{
	struct dataset *data = &history->data, *h = &history->h;

	TRY(metric_read(file, name, data, err));
	TRY(metric_read(file, "h", h, err));
	TRY(metric_read(file, "x", &history->x, err));
	TRY(metric_read(file, "interface", &history->interface, err));
	history->times = data->extent[0];
	history->layers = data->rank == 3 ? data->extent[1] : 1;
	history->cells = metric_count(&history->x);
	if (data->rank >= 2 && h->rank == 2 && h->extent[0] == history->times &&
		h->extent[1] == history->cells && data->extent[data->rank - 1] == history->cells &&
		history->cells > 1 &&
		(data->rank == 2 || metric_count(&history->interface) == history->layers + 1))
		return 0;
	return error_set(err, EX_DATAERR, "dataset '%s' is not over profile_time and x", name);
}

static void history_clean(struct history *history)
{
	free(history->data.values);
	free(history->h.values);
	free(history->x.values);
	free(history->interface.values);
}

/* P1 (35) between a stored profile and the first. */
static double distance(const struct history *history, size_t time)
{
	size_t count = history->layers * history->cells;
	const double *now = history->data.values + time * count, *first = history->data.values;
	const double *h = history->h.values + time * history->cells;
	double sum = 0;

	for (size_t i = 0; i < count; i++) {
		const double *z = history->interface.values + i / history->cells;
		double weight = history->data.rank == 3 ? h[i % history->cells] * (z[1] - z[0]) : 1;

		sum += weight * fabs(now[i] - first[i]);
	}
	return sum * (history->x.values[1] - history->x.values[0]);
}

int metric_drift_l1(const struct sample *sample, double *out, struct error *err)
{
	struct history history = {0};
	int result = history_read(sample->file, sample->metric->dataset, &history, err);

	*out = 0;
	for (size_t t = 1; !result && t < history.times; t++)
		*out = fmax(*out, distance(&history, t));
	history_clean(&history);
	return result;
}

int metric_drift_largest(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};
	size_t each;

	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	each = metric_count(&data) / data.extent[0];
	*out = 0;
	for (size_t i = each; i < metric_count(&data); i++)
		*out = fmax(*out, fabs(data.values[i] - data.values[i % each]));
	free(data.values);
	return 0;
}

int metric_profile_greatest(const struct sample *sample, double *out, struct error *err)
{
	struct dataset data = {0};
	size_t row, each;

	TRY(metric_profile_row(sample->file, sample->at, &row, err));
	TRY(metric_read(sample->file, sample->metric->dataset, &data, err));
	each = metric_count(&data) / data.extent[0];
	*out = 0;
	for (size_t i = 0; row < data.extent[0] && i < each; i++)
		*out = fmax(*out, fabs(data.values[row * each + i]));
	free(data.values);
	return 0;
}
