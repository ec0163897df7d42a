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

int metric_read(struct run_file *file, const char *name, struct dataset *data, struct error *err)
{
	TRY(run_file_dataset(file, name, data, err));
	if (data->values && metric_count(data))
		return 0;
	free(data->values);
	data->values = NULL;
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

static const struct metric metrics[] = {
	{"iterations", "iterations", "", 0, PARTNER_NONE, false, metric_series_greatest,
		"pressure_iterations"},
	{"coarse-iterations", "coarse iterations", "", 0, PARTNER_NONE, false, metric_series_greatest,
		"coarse_iterations"},
	{"cpu-seconds", "CPU", "s", -1, PARTNER_NONE, false, cpu_seconds, NULL},
	{"speed-up", "speed-up", "", 2, PARTNER_BASELINE, false, speed_up, NULL},
	{"step-share-transport", "step 1", "%", 1, PARTNER_NONE, false, share_transport, NULL},
	{"step-share-friction", "step 2", "%", 1, PARTNER_NONE, false, share_friction, NULL},
	{"step-share-pressure", "step 3", "%", 1, PARTNER_NONE, false, share_pressure, NULL},
	{"steps", "steps", "", 0, PARTNER_NONE, false, steps, NULL},
	{"runout", "runout", "m", 3, PARTNER_NONE, false, runout, "front_position"},
	{"l1-difference", "l1", "%", 2, PARTNER_REFERENCE, true, l1_difference, NULL},
	{"l2-difference", "l2", "%", 2, PARTNER_REFERENCE, true, l2_difference, NULL},
	{"velocity-l1", "v L1", "", -1, PARTNER_NONE, true, metric_steady_l1, "v"},
	{"velocity-l2", "v L2", "", -1, PARTNER_NONE, true, metric_steady_l2, "v"},
	{"velocity-linf", "v Linf", "", -1, PARTNER_NONE, true, metric_steady_linf, "v"},
	{"velocity-l1-order", "order", "", 2, PARTNER_PREVIOUS, true, metric_steady_l1_order, "v"},
	{"velocity-l2-order", "order", "", 2, PARTNER_PREVIOUS, true, metric_steady_l2_order, "v"},
	{"velocity-linf-order", "order", "", 2, PARTNER_PREVIOUS, true, metric_steady_linf_order, "v"},
	{"fraction-l1", "phi L1", "", -1, PARTNER_NONE, true, metric_steady_l1, "phi"},
	{"fraction-l2", "phi L2", "", -1, PARTNER_NONE, true, metric_steady_l2, "phi"},
	{"fraction-linf", "phi Linf", "", -1, PARTNER_NONE, true, metric_steady_linf, "phi"},
	{"fraction-l1-order", "order", "", 2, PARTNER_PREVIOUS, true, metric_steady_l1_order, "phi"},
	{"fraction-l2-order", "order", "", 2, PARTNER_PREVIOUS, true, metric_steady_l2_order, "phi"},
	{"fraction-linf-order", "order", "", 2, PARTNER_PREVIOUS, true, metric_steady_linf_order,
		"phi"},
	{"max-velocity", "v max", "m/s", -1, PARTNER_NONE, true, metric_layer_max, "v"},
	{"final-max-speed", "v max", "m/s", -1, PARTNER_NONE, false, metric_series_last, "max_speed"},
	{"final-mean-speed", "v mean", "m/s", -1, PARTNER_NONE, false, metric_series_last,
		"mean_speed"},
	{"final-fraction", "phi mean", "", 4, PARTNER_NONE, false, metric_series_last, "fraction"},
	{"final-height", "h", "m", 6, PARTNER_NONE, false, metric_series_last, "height"},
	{"final-solid-mass", "solid mass", "kg/m2", 3, PARTNER_NONE, false, metric_series_last,
		"solid_mass"},
	{"final-bottom-pressure", "p bottom", "Pa", 2, PARTNER_NONE, false, metric_series_last,
		"bottom_pressure"},
	{"greatest-excess-pressure", "greatest p_e", "Pa", 2, PARTNER_NONE, false,
		metric_series_greatest, "excess_pressure"},
	{"least-excess-pressure", "least p_e", "Pa", 2, PARTNER_NONE, false, metric_series_least,
		"excess_pressure"},
	{"pressure-error", "p off by", "", -1, PARTNER_NONE, false, metric_series_greatest,
		"pressure_error"},
	{"final-pressure-error", "p off by, at end", "", -1, PARTNER_NONE, false, metric_series_last,
		"pressure_error"},
	{"solid-mass-drift", "mass drift", "1e-12", 4, PARTNER_NONE, false, metric_series_drift,
		"solid_mass"},
	{"height-drift", "h drift", "1e-12", 4, PARTNER_NONE, false, metric_series_drift, "height"},
	{"half-speed-time", "v max/2 at", "s", -1, PARTNER_NONE, false, metric_series_half_time,
		"max_speed"},
	{"transfer-sign-change", "G_f changes sign at", "s", -1, PARTNER_NONE, false,
		metric_series_sign_change, "fluid_transfer"},
	{"speed-difference", "v max apart", "%", 3, PARTNER_REFERENCE, false, metric_series_difference,
		"max_speed"},
	{"newton-iterations", "Newton iterations", "", 0, PARTNER_NONE, false, metric_series_last,
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
