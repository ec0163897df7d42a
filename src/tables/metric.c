#include "tables/metric.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"
#include "tables/metric_parts.h"
#include "talus/tables.h"

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

/* CPU time of the whole run per cell, layer and step, in ns; a model without x is one cell. */
static int ns_per_unknown(const struct sample *sample, double *out, struct error *err)
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

/* In percent of that of the reference run. */
static int runout_change(const struct sample *sample, double *out, struct error *err)
{
	struct sample other = *sample;
	double reference;

	other.file = sample->partner;
	TRY(runout(&other, &reference, err));
	TRY(runout(sample, out, err));
	*out = 100 * (*out / reference - 1);
	return 0;
}

/* h_f of P3, which falls as the bed gets thicker. */
static int deposit_height(const struct sample *sample, double *out, struct error *err)
{
	TRY(metric_series_last(sample, out, err));
	*out -= sample->config->erodible_bed_thickness;
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
	if (sample->config->coordinates != sample->partner_config->coordinates &&
		metric_turn_thickness(sample, &h, &cells, err))
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

/* The last moment at which the speed `dataset` was above the static speed. */
static int stopping_time(const struct sample *sample, double *out, struct error *err)
{
	struct dataset time = {0}, speed = {0};
	size_t i;
	int result = -1;

	if (metric_read(sample->file, "time", &time, err) ||
		metric_read(sample->file, sample->metric->dataset, &speed, err))
		goto done;
	i = metric_count(&speed);
	while (i > 0 && fabs(speed.values[i - 1]) < sample->config->output.static_speed)
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

/* The first and the greatest velocity of the front, and when it has that. At the release it jumps to the
 * next cell, which is no flow. */
static int front_peak(
	const struct sample *sample, double *first, double *velocity, double *when, struct error *err)
{
	const double settled = 0.04; /* s: the window of 0.02 s has left the release behind */
	struct dataset time = {0}, front = {0};
	int result = -1;

	*first = *velocity = *when = NAN;
	if (metric_read(sample->file, "time", &time, err) ||
		metric_read(sample->file, "front_velocity", &front, err))
		goto done;
	for (size_t i = 0; i < metric_count(&front) && i < metric_count(&time); i++)
		if (time.values[i] >= settled && !(front.values[i] <= *velocity)) {
			if (isnan(*first))
				*first = front.values[i];
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
	double first, when;

	return front_peak(sample, &first, out, &when, err);
}

static int front_velocity_time(const struct sample *sample, double *out, struct error *err)
{
	double first, velocity;

	return front_peak(sample, &first, &velocity, out, err);
}

static int first_front_velocity(const struct sample *sample, double *out, struct error *err)
{
	double velocity, when;

	return front_peak(sample, out, &velocity, &when, err);
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
	{"iterations", "iterations", "", 0, PARTNER_NONE, METRIC_RUN, NULL, metric_series_greatest,
		"pressure_iterations",
		"the greatest number of iterations of the pressure solver in a step"},
	{"coarse-iterations", "coarse iterations", "", 0, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_greatest, "coarse_iterations",
		"the same of the coarse system behind the first guess"},
	{"cpu-seconds", "CPU", "s", -1, PARTNER_NONE, METRIC_RUN, NULL, cpu_seconds, NULL,
		"CPU time of the whole run, all attempts"},
	{"ns-per-unknown", "CPU", "ns/cell/layer/step", -1, PARTNER_NONE, METRIC_RUN, NULL,
		ns_per_unknown, NULL, "CPU time of the whole run over cells, layers and steps"},
	{"residual", "residual", "", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_greatest,
		"pressure_residual",
		"the greatest true relative residual of the pressure system in a step"},
	{"speed-up", "speed-up", "", 2, PARTNER_BASELINE, METRIC_RUN, NULL, speed_up, NULL,
		"CPU time of the `baseline` run over that of this one"},
	{"step-share-transport", "step 1", "%", 1, PARTNER_NONE, METRIC_RUN, NULL, share_transport,
		NULL, "share of step 1, transport, in the CPU time"},
	{"step-share-friction", "step 2", "%", 1, PARTNER_NONE, METRIC_RUN, NULL, share_friction, NULL,
		"share of step 2, friction"},
	{"step-share-pressure", "step 3", "%", 1, PARTNER_NONE, METRIC_RUN, NULL, share_pressure, NULL,
		"share of step 3, non-hydrostatic pressure"},
	{"steps", "steps", "", 0, PARTNER_NONE, METRIC_RUN, NULL, steps, NULL, "number of time steps"},
	{"runout", "runout", "m", 3, PARTNER_NONE, METRIC_RUN, NULL, runout, "front_position",
		"final position of the front, from the gate"},
	{"runout-change", "change of runout", "%", 1, PARTNER_REFERENCE, METRIC_RUN, NULL,
		runout_change, "front_position",
		"how much longer the runout is than that of the `reference` run"},
	{"stopping-time", "stopping time", "s", 3, PARTNER_NONE, METRIC_RUN, NULL, stopping_time,
		"max_speed", "the last time at which some layer is faster than output.static_speed"},
	{"front-stopping-time", "front stops at", "s", 3, PARTNER_NONE, METRIC_RUN, NULL, stopping_time,
		"front_velocity", "the last time at which the front is faster than output.static_speed"},
	{"final-thickness", "final thickness", "m", 4, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_last, "max_thickness", "the greatest thickness at the end"},
	{"mass-drift", "mass drift", "1e-15", 1, PARTNER_NONE, METRIC_RUN, NULL, metric_mass_drift,
		"mass", "greatest relative change of the mass and what has left, in 1e-15"},
	{"deposit-height", "height of deposit", "m", 4, PARTNER_NONE, METRIC_RUN, NULL, deposit_height,
		"max_thickness", "the same above the erodible bed layer"},
	{"mean-velocity", "mean velocity", "m/s", 3, PARTNER_NONE, METRIC_COLUMN, NULL,
		metric_mean_velocity, "u",
		"velocity along the slope averaged over the layers, at a profile time and a position"},
	{"energy-rise", "rise in a step", "", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_rise,
		"energy",
		"how far the energy of P1 Theorem 1 rises between two records at most, over its first "
		"value"},
	{"energy-rises", "rises in all", "", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_rises,
		"energy", "the sum of these rises"},
	{"energy-loss", "energy lost", "%", 2, PARTNER_NONE, METRIC_RUN, NULL, metric_series_loss,
		"energy",
		"share of the energy that is gone at the end, by friction and with the mass that left"},
	{"front-velocity", "fastest front", "m/s", 3, PARTNER_NONE, METRIC_RUN, NULL, front_velocity,
		NULL, "the greatest velocity of the front after its first 0.04 s"},
	{"front-velocity-time", "fastest at", "s", 3, PARTNER_NONE, METRIC_RUN, NULL,
		front_velocity_time, NULL, "when the front has that velocity"},
	{"first-front-velocity", "front at first", "m/s", 3, PARTNER_NONE, METRIC_RUN, NULL,
		first_front_velocity, NULL, "the velocity of the front after its first 0.04 s"},
	{"l2-observed", "l2 from observed", "%", 2, PARTNER_NONE, METRIC_PROFILE, "h", l2_observed,
		NULL, "difference in thickness from observations at a profile time, as l2-difference"},
	{"front-observed", "front from observed", "%", 2, PARTNER_NONE, METRIC_RUN, "front_position",
		front_observed, NULL,
		"difference of the front from observations over time, relative to its way from the gate"},
	{"l1-difference", "l1", "%", 2, PARTNER_REFERENCE, METRIC_PROFILE, NULL, l1_difference, NULL,
		"difference in thickness from the `reference` run, over the mass above the bed: l1 norm, "
		"at a profile time, in the coordinates of the reference"},
	{"l2-difference", "l2", "%", 2, PARTNER_REFERENCE, METRIC_PROFILE, NULL, l2_difference, NULL,
		"the same in the l2 norm"},
	{"front-difference", "front", "%", 1, PARTNER_REFERENCE, METRIC_PROFILE, NULL,
		metric_front_difference, NULL,
		"difference of the front from the `reference` run at a profile time, relative to its way "
		"from "
		"the gate along the plane"},
	{"h-drift", "h L1", "m2", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_drift_l1, "h",
		"the greatest distance of a stored thickness from the first one stored, L1 as P1 (35)"},
	{"u-drift", "u L1", "m3/s", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_drift_l1, "u",
		"the same of the layer velocities along the slope"},
	{"w-drift", "w L1", "m3/s", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_drift_l1, "w",
		"the same of those normal to the slope"},
	{"h-change", "h moves", "m", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_drift_largest, "h",
		"the greatest change of the thickness at any place since the first profile stored"},
	{"normal-velocity", "greatest w", "m/s", 3, PARTNER_NONE, METRIC_PROFILE, NULL,
		metric_profile_greatest, "w",
		"the greatest velocity of a layer normal to the slope, up or down, at a profile time"},
	{"kinetic-energy", "kinetic energy", "J/m", 2, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_greatest, "kinetic_energy", "the greatest kinetic energy"},
	{"h-l1", "h L1", "m2", -1, PARTNER_REFERENCE, METRIC_PROFILE, NULL, metric_reference_l1, "h",
		"difference in thickness from the `reference` run, which is averaged over the cells of "
		"this "
		"one: L1 as P1 (35), at a profile time"},
	{"h-l1-order", "order", "", 2, PARTNER_REFERENCE_PREVIOUS, METRIC_PROFILE, NULL,
		metric_reference_l1, "h", "its order, from the row before"},
	{"u-l1", "u L1", "m3/s", -1, PARTNER_REFERENCE, METRIC_PROFILE, NULL, metric_reference_l1, "u",
		"as h-l1, of the layer velocities along the slope, over cells and layers"},
	{"u-l1-order", "order", "", 2, PARTNER_REFERENCE_PREVIOUS, METRIC_PROFILE, NULL,
		metric_reference_l1, "u", "its order, from the row before"},
	{"w-l1", "w L1", "m3/s", -1, PARTNER_REFERENCE, METRIC_PROFILE, NULL, metric_reference_l1, "w",
		"as h-l1, of the layer velocities normal to the slope, over cells and layers"},
	{"w-l1-order", "order", "", 2, PARTNER_REFERENCE_PREVIOUS, METRIC_PROFILE, NULL,
		metric_reference_l1, "w", "its order, from the row before"},
	{"velocity-l1", "v L1", "", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_steady_l1, "v",
		"error of the velocity profile against the exact steady flow, L1, at a profile time"},
	{"velocity-l2", "v L2", "", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_steady_l2, "v",
		"the same in L2"},
	{"velocity-linf", "v Linf", "", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_steady_linf, "v",
		"the same, the greatest"},
	{"velocity-l1-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_PROFILE, NULL, metric_steady_l1,
		"v", "its order, from the row before"},
	{"velocity-l2-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_PROFILE, NULL, metric_steady_l2,
		"v", "its order, from the row before"},
	{"velocity-linf-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_PROFILE, NULL,
		metric_steady_linf, "v", "its order, from the row before"},
	{"fraction-l1", "phi L1", "", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_steady_l1, "phi",
		"error of the solid fraction against the exact steady flow, L1, at a profile time"},
	{"fraction-l2", "phi L2", "", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_steady_l2, "phi",
		"the same in L2"},
	{"fraction-linf", "phi Linf", "", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_steady_linf,
		"phi", "the same, the greatest"},
	{"fraction-l1-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_PROFILE, NULL, metric_steady_l1,
		"phi", "its order, from the row before"},
	{"fraction-l2-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_PROFILE, NULL, metric_steady_l2,
		"phi", "its order, from the row before"},
	{"fraction-linf-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_PROFILE, NULL,
		metric_steady_linf, "phi", "its order, from the row before"},
	{"max-velocity", "v max", "m/s", -1, PARTNER_NONE, METRIC_PROFILE, NULL, metric_layer_max, "v",
		"greatest layer velocity at a profile time"},
	{"final-max-speed", "v max", "m/s", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_last,
		"max_speed", "greatest layer velocity at the end"},
	{"steady-max-speed", "exact v max", "m/s", -1, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_last, "steady_max_speed", "the same of the exact steady flow"},
	{"bagnold-error", "u L2", "", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_last,
		"bagnold_error",
		"error of the velocity profile of a dry uniform flow against the exact steady one at the "
		"end, "
		"P3 (53)"},
	{"bagnold-error-order", "order", "", 2, PARTNER_PREVIOUS, METRIC_RUN, NULL, metric_series_last,
		"bagnold_error", "its order, from the row before"},
	{"final-mean-speed", "v mean", "m/s", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_last,
		"mean_speed", "mean velocity at the end"},
	{"final-fraction", "phi mean", "", 4, PARTNER_NONE, METRIC_RUN, NULL, metric_series_last,
		"fraction", "mean solid fraction at the end"},
	{"final-height", "h", "m", 6, PARTNER_NONE, METRIC_RUN, NULL, metric_series_last, "height",
		"height at the end"},
	{"final-solid-mass", "solid mass", "kg/m2", 3, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_last, "solid_mass", "solid mass at the end"},
	{"final-bottom-pressure", "p bottom", "Pa", 2, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_last, "bottom_pressure", "solid pressure at the bottom at the end"},
	{"greatest-excess-pressure", "greatest p_e", "Pa", 2, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_greatest, "excess_pressure", "greatest excess pore pressure"},
	{"least-excess-pressure", "least p_e", "Pa", 2, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_least, "excess_pressure", "least excess pore pressure"},
	{"pressure-error", "p off by", "", -1, PARTNER_NONE, METRIC_RUN, NULL, metric_series_greatest,
		"pressure_error", "greatest relative error of the pressure root against its exact value"},
	{"final-pressure-error", "p off by, at end", "", -1, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_last, "pressure_error", "the same at the end"},
	{"solid-mass-drift", "mass drift", "1e-12", 4, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_drift, "solid_mass", "greatest relative change of the solid mass, in 1e-12"},
	{"height-drift", "h drift", "1e-12", 4, PARTNER_NONE, METRIC_RUN, NULL, metric_series_drift,
		"height", "greatest relative change of the height, in 1e-12"},
	{"half-speed-time", "v max/2 at", "s", -1, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_half_time, "max_speed",
		"when the greatest velocity has reached half of its end value"},
	{"transfer-sign-change", "G_f changes sign at", "s", -1, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_sign_change, "fluid_transfer",
		"when the fluid transfer at the top changes its sign"},
	{"speed-difference", "v max apart", "%", 3, PARTNER_REFERENCE, METRIC_RUN, NULL,
		metric_series_difference, "max_speed",
		"greatest difference of the greatest velocity from the `reference` run, over its greatest "
		"value"},
	{"newton-iterations", "Newton iterations", "", 0, PARTNER_NONE, METRIC_RUN, NULL,
		metric_series_last, "newton_iterations", "Newton iterations of the whole run"},
};

enum metric_partner metric_partner(const struct metric *metric)
{
	return metric->partner % PARTNER_PREVIOUS;
}

bool metric_is_order(const struct metric *metric)
{
	return metric->partner & PARTNER_PREVIOUS;
}

int metric_order(const struct config *before, double error_before, const struct config *config,
	double error, double *out, struct error *err)
{
	double finer = (double)config->domain.cells / before->domain.cells;

	if (finer == 1)
		finer = (double)config->layers / before->layers;
	if (finer == 1)
		return error_set(err, EX_DATAERR, "the row before has the same cells and layers");
	*out = log(error_before / error) / log(finer);
	return 0;
}

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

void table_reference(struct text *out)
{
	text_add(out, "\n## Metrics\n\n| metric | column head | meaning |\n| --- | --- | --- |\n");
	for (size_t i = 0; i < sizeof metrics / sizeof *metrics; i++)
		text_addf(out, "| `%s` | %s | %s%s |\n", metrics[i].name, metrics[i].header,
			metrics[i].meaning ? metrics[i].meaning : "",
			metric_partner(&metrics[i]) == PARTNER_BASELINE    ? " (needs `baseline`)"
			: metric_partner(&metrics[i]) == PARTNER_REFERENCE ? " (needs `reference`)"
															   : "");
}
