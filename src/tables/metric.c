#include "tables/metric.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"
#include "tables/metric_parts.h"

size_t metric_count(const struct dataset *data)
{
	size_t count = 1;

	for (int i = 0; i < data->rank; i++)
		count *= data->extent[i];
	return count;
}

int metric_read(struct run_file *file, const char *name, struct dataset *out, struct error *err)
{
	TRY(run_file_dataset(file, name, out, err));
	if (out->values && metric_count(out))
		return 0;
	free(out->values);
	out->values = NULL;
	(void)error_set(err, EX_DATAERR, "dataset '%s' is empty", name);
	return -1;
}

/* In percent of the CPU time of the whole run. */
static int series_share(
	const struct sample *sample, const char *name, double *out, struct error *err)
{
	struct dataset data = {0};
	double all, sum = 0;

	TRY(run_file_real(sample->file, "cpu_seconds", &all, err));
	TRY(metric_read(sample->file, name, &data, err));
	for (size_t i = 0; i < metric_count(&data); i++)
		sum += data.values[i];
	free(data.values);
	*out = 100 * sum / all;
	return 0;
}

static int cpu_seconds(const struct sample *sample, double *out, struct error *err)
{
	return run_file_real(sample->file, "cpu_seconds", out, err);
}

static int speed_up(const struct sample *sample, double *out, struct error *err)
{
	double mine, baseline;

	TRY(run_file_real(sample->file, "cpu_seconds", &mine, err));
	TRY(run_file_real(sample->partner, "cpu_seconds", &baseline, err));
	*out = baseline / mine;
	return 0;
}

static int share_transport(const struct sample *sample, double *out, struct error *err)
{
	return series_share(sample, "cpu_transport", out, err);
}

static int share_friction(const struct sample *sample, double *out, struct error *err)
{
	return series_share(sample, "cpu_friction", out, err);
}

static int share_pressure(const struct sample *sample, double *out, struct error *err)
{
	return series_share(sample, "cpu_pressure", out, err);
}

static int steps(const struct sample *sample, double *out, struct error *err)
{
	(void)err;
	*out = (double)run_file_summary(sample->file)->step;
	return 0;
}

/* The final front, from the gate. */
static int runout(const struct sample *sample, double *out, struct error *err)
{
	TRY(metric_series_last(sample, out, err));
	*out -= sample->config->initial.front;
	return 0;
}

/* Profiles are stored at the very times that were asked for; the tolerance is for times written in other
 * units. */
int metric_profile_row(struct run_file *file, double time, size_t *row, struct error *err)
{
	struct dataset times = {0};

	TRY(metric_read(file, "profile_time", &times, err));
	*row = 0;
	for (size_t i = 1; i < metric_count(&times); i++)
		if (fabs(times.values[i] - time) < fabs(times.values[*row] - time))
			*row = i;
	if (fabs(times.values[*row] - time) > 1e-9 * fmax(1, fabs(time)))
		(void)error_set(err, EX_DATAERR, "no profile at %g s", time);
	free(times.values);
	return err->code ? -1 : 0;
}

/* h over x at a time. `values` belongs to the caller. */
static int read_thickness(
	struct run_file *file, double time, double **values, size_t *cells, struct error *err)
{
	struct dataset h = {0};
	size_t row;

	*values = NULL;
	TRY(metric_profile_row(file, time, &row, err));
	TRY(metric_read(file, "h", &h, err));
	if (!h.values || h.rank != 2 || row >= h.extent[0]) {
		free(h.values);
		(void)error_set(err, EX_DATAERR, "dataset 'h' is not profile_time by x");
		return -1;
	}
	*cells = h.extent[1];
	memmove(h.values, h.values + row * *cells, *cells * sizeof *h.values);
	*values = h.values;
	return 0;
}

/* ||h - h_ref|| / ||h_ref - h_i|| in percent, over x, in the norm of this power: the papers' errors
 * are against the mass above the erodible bed. */
static int difference(const struct sample *sample, int power, double *out, struct error *err)
{
	double *h = NULL, *reference = NULL, above = 0, apart = 0;
	size_t cells = 0, reference_cells = 0;
	int result = -1;

	if (read_thickness(sample->file, sample->at, &h, &cells, err) ||
		read_thickness(sample->partner, sample->at, &reference, &reference_cells, err))
		goto done;
	if (cells != reference_cells) {
		error_set(
			err, EX_DATAERR, "%zu cells here and %zu in the reference", cells, reference_cells);
		goto done;
	}
	for (size_t i = 0; i < cells; i++) {
		apart += pow(fabs(h[i] - reference[i]), power);
		above += pow(fabs(reference[i] - sample->config->erodible_bed_thickness), power);
	}
	*out = 100 * pow(apart / above, 1.0 / power);
	result = 0;
done:
	free(h);
	free(reference);
	return result;
}

static int l1_difference(const struct sample *sample, double *out, struct error *err)
{
	return difference(sample, 1, out, err);
}

static int l2_difference(const struct sample *sample, double *out, struct error *err)
{
	return difference(sample, 2, out, err);
}

/* The last moment at which some layer was faster than the static speed. */
static int stopping_time(const struct sample *sample, double *out, struct error *err)
{
	struct dataset time = {0}, speed = {0};
	size_t i;
	int result = -1;

	if (metric_read(sample->file, "time", &time, err) ||
		metric_read(sample->file, "max_speed", &speed, err))
		goto done;
	i = metric_count(&speed);
	while (i > 0 && speed.values[i - 1] < sample->config->output.static_speed)
		i--;
	if (i == metric_count(&speed)) {
		error_set(err, EX_DATAERR, "it still flows at the end");
		goto done;
	}
	*out = i < metric_count(&time) ? time.values[i] : NAN;
	result = 0;
done:
	free(time.values);
	free(speed.values);
	return result;
}

/* The greatest velocity of the front and when. At the release it jumps to the next cell, which is no flow. */
static int front_peak(
	const struct sample *sample, double *velocity, double *when, struct error *err)
{
	const double settled = 0.04; /* s: the window of 0.02 s has left the release behind */
	struct dataset time = {0}, front = {0};
	int result = -1;

	*velocity = *when = NAN;
	if (metric_read(sample->file, "time", &time, err) ||
		metric_read(sample->file, "front_velocity", &front, err))
		goto done;
	for (size_t i = 0; i < metric_count(&front) && i < metric_count(&time); i++)
		if (time.values[i] >= settled && !(front.values[i] <= *velocity)) {
			*velocity = front.values[i];
			*when = time.values[i];
		}
	result = 0;
done:
	free(time.values);
	free(front.values);
	return result;
}

static int front_velocity(const struct sample *sample, double *out, struct error *err)
{
	double when;

	return front_peak(sample, out, &when, err);
}

static int front_velocity_time(const struct sample *sample, double *out, struct error *err)
{
	double velocity;

	return front_peak(sample, &velocity, out, err);
}

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
static int l2_observed(const struct sample *sample, double *out, struct error *err)
{
	struct observed_line line = {0};
	struct dataset x = {0};
	double *h = NULL;
	size_t cells = 0;
	int result = -1;

	if (!observed_line(sample->observed, "h", sample->at, &line, err) &&
		!read_thickness(sample->file, sample->at, &h, &cells, err) &&
		!metric_read(sample->file, "x", &x, err))
		result = cells == metric_count(&x)
					 ? distance(&line, x.values, h, cells, half_cell(&x),
						   sample->config->erodible_bed_thickness, out, err)
					 : error_set(err, EX_DATAERR, "dataset 'h' is not as long as 'x'");
	observed_line_clean(&line);
	free(h);
	free(x.values);
	return result;
}

/* Relative to the way that the front was observed to go from the gate. */
static int front_observed(const struct sample *sample, double *out, struct error *err)
{
	struct observed_line line = {0};
	struct dataset time = {0}, front = {0};
	int result = -1;

	if (!observed_line(sample->observed, "front_position", 0, &line, err) &&
		!metric_read(sample->file, "time", &time, err) &&
		!metric_read(sample->file, "front_position", &front, err))
		result = metric_count(&time) == metric_count(&front)
					 ? distance(&line, time.values, front.values, metric_count(&time), 0,
						   sample->config->initial.front, out, err)
					 : error_set(err, EX_DATAERR, "'front_position' is not as long as 'time'");
	observed_line_clean(&line);
	free(time.values);
	free(front.values);
	return result;
}

static const struct metric metrics[] = {
	{"iterations", "iterations", "", 0, PARTNER_NONE, false, NULL, metric_series_greatest,
		"pressure_iterations"},
	{"coarse-iterations", "coarse iterations", "", 0, PARTNER_NONE, false, NULL,
		metric_series_greatest, "coarse_iterations"},
	{"cpu-seconds", "CPU", "s", -1, PARTNER_NONE, false, NULL, cpu_seconds, NULL},
	{"speed-up", "speed-up", "", 2, PARTNER_BASELINE, false, NULL, speed_up, NULL},
	{"step-share-transport", "step 1", "%", 1, PARTNER_NONE, false, NULL, share_transport, NULL},
	{"step-share-friction", "step 2", "%", 1, PARTNER_NONE, false, NULL, share_friction, NULL},
	{"step-share-pressure", "step 3", "%", 1, PARTNER_NONE, false, NULL, share_pressure, NULL},
	{"steps", "steps", "", 0, PARTNER_NONE, false, NULL, steps, NULL},
	{"runout", "runout", "m", 3, PARTNER_NONE, false, NULL, runout, "front_position"},
	{"stopping-time", "stopping time", "s", 3, PARTNER_NONE, false, NULL, stopping_time, NULL},
	{"final-thickness", "final thickness", "m", 4, PARTNER_NONE, false, NULL, metric_series_last,
		"max_thickness"},
	{"front-velocity", "fastest front", "m/s", 3, PARTNER_NONE, false, NULL, front_velocity, NULL},
	{"front-velocity-time", "fastest at", "s", 3, PARTNER_NONE, false, NULL, front_velocity_time,
		NULL},
	{"l2-observed", "l2 from observed", "%", 2, PARTNER_NONE, true, "h", l2_observed, NULL},
	{"front-observed", "front from observed", "%", 2, PARTNER_NONE, false, "front_position",
		front_observed, NULL},
	{"l1-difference", "l1", "%", 2, PARTNER_REFERENCE, true, NULL, l1_difference, NULL},
	{"l2-difference", "l2", "%", 2, PARTNER_REFERENCE, true, NULL, l2_difference, NULL},
	{"velocity-l1", "v L1", "", -1, PARTNER_NONE, true, NULL, metric_steady_l1, "v"},
	{"velocity-l2", "v L2", "", -1, PARTNER_NONE, true, NULL, metric_steady_l2, "v"},
	{"velocity-linf", "v Linf", "", -1, PARTNER_NONE, true, NULL, metric_steady_linf, "v"},
	{"velocity-l1-order", "order", "", 2, PARTNER_PREVIOUS, true, NULL, metric_steady_l1_order,
		"v"},
	{"velocity-l2-order", "order", "", 2, PARTNER_PREVIOUS, true, NULL, metric_steady_l2_order,
		"v"},
	{"velocity-linf-order", "order", "", 2, PARTNER_PREVIOUS, true, NULL, metric_steady_linf_order,
		"v"},
	{"fraction-l1", "phi L1", "", -1, PARTNER_NONE, true, NULL, metric_steady_l1, "phi"},
	{"fraction-l2", "phi L2", "", -1, PARTNER_NONE, true, NULL, metric_steady_l2, "phi"},
	{"fraction-linf", "phi Linf", "", -1, PARTNER_NONE, true, NULL, metric_steady_linf, "phi"},
	{"fraction-l1-order", "order", "", 2, PARTNER_PREVIOUS, true, NULL, metric_steady_l1_order,
		"phi"},
	{"fraction-l2-order", "order", "", 2, PARTNER_PREVIOUS, true, NULL, metric_steady_l2_order,
		"phi"},
	{"fraction-linf-order", "order", "", 2, PARTNER_PREVIOUS, true, NULL, metric_steady_linf_order,
		"phi"},
	{"max-velocity", "v max", "m/s", -1, PARTNER_NONE, true, NULL, metric_layer_max, "v"},
	{"final-max-speed", "v max", "m/s", -1, PARTNER_NONE, false, NULL, metric_series_last,
		"max_speed"},
	{"final-mean-speed", "v mean", "m/s", -1, PARTNER_NONE, false, NULL, metric_series_last,
		"mean_speed"},
	{"final-fraction", "phi mean", "", 4, PARTNER_NONE, false, NULL, metric_series_last,
		"fraction"},
	{"final-height", "h", "m", 6, PARTNER_NONE, false, NULL, metric_series_last, "height"},
	{"final-solid-mass", "solid mass", "kg/m2", 3, PARTNER_NONE, false, NULL, metric_series_last,
		"solid_mass"},
	{"final-bottom-pressure", "p bottom", "Pa", 2, PARTNER_NONE, false, NULL, metric_series_last,
		"bottom_pressure"},
	{"greatest-excess-pressure", "greatest p_e", "Pa", 2, PARTNER_NONE, false, NULL,
		metric_series_greatest, "excess_pressure"},
	{"least-excess-pressure", "least p_e", "Pa", 2, PARTNER_NONE, false, NULL, metric_series_least,
		"excess_pressure"},
	{"pressure-error", "p off by", "", -1, PARTNER_NONE, false, NULL, metric_series_greatest,
		"pressure_error"},
	{"final-pressure-error", "p off by, at end", "", -1, PARTNER_NONE, false, NULL,
		metric_series_last, "pressure_error"},
	{"solid-mass-drift", "mass drift", "1e-12", 4, PARTNER_NONE, false, NULL, metric_series_drift,
		"solid_mass"},
	{"height-drift", "h drift", "1e-12", 4, PARTNER_NONE, false, NULL, metric_series_drift,
		"height"},
	{"half-speed-time", "v max/2 at", "s", -1, PARTNER_NONE, false, NULL, metric_series_half_time,
		"max_speed"},
	{"transfer-sign-change", "G_f changes sign at", "s", -1, PARTNER_NONE, false, NULL,
		metric_series_sign_change, "fluid_transfer"},
	{"speed-difference", "v max apart", "%", 3, PARTNER_REFERENCE, false, NULL,
		metric_series_difference, "max_speed"},
	{"newton-iterations", "Newton iterations", "", 0, PARTNER_NONE, false, NULL, metric_series_last,
		"newton_iterations"},
};

const struct metric *metric_find(const char *name, const char **nearest)
{
	int best = INT_MAX;

	*nearest = "";
	for (size_t i = 0; i < sizeof metrics / sizeof *metrics; i++) {
		int distance = text_distance(name, metrics[i].name);

		if (!distance)
			return &metrics[i];
		if (distance < best) {
			best = distance;
			*nearest = metrics[i].name;
		}
	}
	return NULL;
}
