/* A run beside what was observed. */
#include <math.h>
#include <stdlib.h>

#include "tables/metric_parts.h"

/* A value between those of a rising axis; up to `edge` beyond its ends it is that of the end. */
static int interpolate(const double *axis, const double *values, size_t count, double edge,
	double at, double *out, struct error *err)
{
	size_t i = 0;
	double share;

	if (!count || at < axis[0] - edge || at > axis[count - 1] + edge)
		return error_set(err, EX_DATAERR, "observed at %g, where the run has no values", at);
	while (i + 2 < count && axis[i + 1] < at)
		i++;
	share = count == 1 ? 0 : fmin(1, fmax(0, (at - axis[i]) / (axis[i + 1] - axis[i])));
	*out = count == 1 ? values[0] : values[i] + (values[i + 1] - values[i]) * share;
	return isfinite(*out)
			   ? 0
			   : error_set(err, EX_DATAERR, "observed at %g, where ours is no number", at);
}

/* ||ours - observed|| / ||observed - level|| in percent, in l2 over the observed places, by trapezoids. */
static int distance(const struct observed_line *line, const double *axis, const double *values,
	size_t count, double edge, double level, double *out, struct error *err)
{
	double apart = 0, size = 0;

	for (size_t i = 0; i < line->count; i++) {
		double left = i ? line->at[i] - line->at[i - 1] : 0;
		double right = i + 1 < line->count ? line->at[i + 1] - line->at[i] : 0;
		double weight = 0.5 * (left + right), ours = NAN;

		TRY(interpolate(axis, values, count, edge, line->at[i], &ours, err));
		apart += weight * (ours - line->values[i]) * (ours - line->values[i]);
		size += weight * (line->values[i] - level) * (line->values[i] - level);
	}
	if (size <= 0)
		return error_set(err, EX_DATAERR, "the observations are level: nothing to be relative to");
	*out = 100 * sqrt(apart / size);
	return 0;
}

/* The domain goes half a cell beyond the middles of its cells. */
static double half_cell(const struct dataset *x)
{
	return metric_count(x) > 1 ? 0.500001 * (x->values[1] - x->values[0]) : INFINITY;
}

/* P1 Figure 13, relative to what was observed above the erodible bed, as the differences of Table 9 are. */
int metric_l2_observed(const struct sample *sample, double *out, struct error *err)
{
	struct observed_line line = {0};
	struct dataset x = {0};
	double *h = NULL;
	size_t cells = 0;
	int result = -1;

	if (!observed_line(sample->observed, "h", sample->at, &line, err) &&
		!metric_thickness(sample->file, sample->at, &h, &cells, err) &&
		!metric_read(sample->file, "x", &x, err))
		result = cells == metric_count(&x)
					 ? distance(&line, x.values, h, cells, half_cell(&x),
						   config_bed_thickness(sample->config), out, err)
					 : error_set(err, EX_DATAERR, "dataset 'h' is not as long as 'x'");
	observed_line_clean(&line);
	free(h);
	free(x.values);
	return result;
}

/* Relative to the way that the front was observed to go from the gate. */
int metric_front_observed(const struct sample *sample, double *out, struct error *err)
{
	struct observed_line line = {0};
	struct dataset time = {0}, front = {0};
	int result = -1;

	if (!observed_line(sample->observed, "front_position", 0, &line, err) &&
		!metric_read_series(sample->file, "front_position", &time, &front, err))
		result = distance(&line, time.values, front.values, metric_count(&time), 0,
			sample->config->initial.front, out, err);
	observed_line_clean(&line);
	free(time.values);
	free(front.values);
	return result;
}
