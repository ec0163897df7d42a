#include "tables/metric.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* What a value is taken of, and what that is compared with. */
#define ALONE(extent) PARTNER_NONE, extent, NULL
#define AGAINST(partner, extent) partner, extent, NULL
#define OBSERVED(extent, dataset) PARTNER_NONE, extent, dataset

/* clang-format off */
static const struct metric metrics[] = {
	{"iterations", "iterations", "", 0, ALONE(METRIC_RUN), metric_series_greatest, "pressure_iterations",
		"the greatest number of iterations of the pressure solver in a step"},
	{"coarse-iterations", "coarse iterations", "", 0, ALONE(METRIC_RUN), metric_series_greatest, "coarse_iterations",
		"the same of the coarse system behind the first guess"},
	{"cpu-seconds", "CPU", "s", -1, ALONE(METRIC_RUN), metric_cpu_seconds, NULL,
		"CPU time of the whole run, all attempts"},
	{"ns-per-unknown", "CPU", "ns/cell/layer/step", -1, ALONE(METRIC_RUN), metric_ns_per_unknown, NULL,
		"CPU time of the whole run over cells, layers and steps"},
	{"residual", "residual", "", -1, ALONE(METRIC_RUN), metric_series_greatest, "pressure_residual",
		"the greatest true relative residual of the pressure system in a step"},
	{"speed-up", "speed-up", "", 2, AGAINST(PARTNER_BASELINE, METRIC_RUN), metric_speed_up, NULL,
		"CPU time of the `baseline` run over that of this one"},
	{"step-share-transport", "step 1", "%", 1, ALONE(METRIC_RUN), metric_share, "cpu_transport",
		"share of step 1, transport, in the CPU time"},
	{"step-share-friction", "step 2", "%", 1, ALONE(METRIC_RUN), metric_share, "cpu_friction",
		"share of step 2, friction"},
	{"step-share-pressure", "step 3", "%", 1, ALONE(METRIC_RUN), metric_share, "cpu_pressure",
		"share of step 3, non-hydrostatic pressure"},
	{"steps", "steps", "", 0, ALONE(METRIC_RUN), metric_steps, NULL,
		"number of time steps"},
	{"runout", "runout", "m", 3, ALONE(METRIC_RUN), metric_runout, "front_position",
		"final position of the front, from the gate"},
	{"runout-change", "change of runout", "%", 1, AGAINST(PARTNER_REFERENCE, METRIC_RUN),
		metric_runout_change, "front_position",
		"how much longer the runout is than that of the `reference` run"},
	{"stopping-time", "stopping time", "s", 3, ALONE(METRIC_RUN), metric_stopping_time, "max_speed",
		"the last time at which some layer is faster than output.static_speed"},
	{"front-stopping-time", "front stops at", "s", 3, ALONE(METRIC_RUN), metric_stopping_time, "front_velocity",
		"the last time at which the front is faster than output.static_speed"},
	{"final-thickness", "final thickness", "m", 4, ALONE(METRIC_RUN), metric_series_last, "max_thickness",
		"the greatest thickness at the end"},
	{"deposit-height", "height of deposit", "m", 4, ALONE(METRIC_RUN), metric_deposit_height, "max_thickness",
		"the same above the erodible bed layer"},
	{"mass-drift", "mass drift", "1e-15", 1, ALONE(METRIC_RUN), metric_mass_drift, "mass",
		"greatest relative change of the mass and what has left, in 1e-15"},
	{"mean-velocity", "mean velocity", "m/s", 3, ALONE(METRIC_COLUMN), metric_mean_velocity, "u",
		"velocity along the slope averaged over the layers, at a profile time and a position"},
	{"energy-rise", "rise in a step", "", -1, ALONE(METRIC_RUN), metric_series_rise, "energy",
		"how far the energy of P1 Theorem 1 rises between two records at most, over its first value"},
	{"energy-rises", "rises in all", "", -1, ALONE(METRIC_RUN), metric_series_rises, "energy",
		"the sum of these rises"},
	{"energy-loss", "energy lost", "%", 2, ALONE(METRIC_RUN), metric_series_loss, "energy",
		"share of the energy that is gone at the end, by friction and with the mass that left"},
	{"front-velocity", "fastest front", "m/s", 3, ALONE(METRIC_RUN), metric_front_velocity, NULL,
		"the greatest velocity of the front after its first 0.04 s"},
	{"front-velocity-time", "fastest at", "s", 3, ALONE(METRIC_RUN), metric_front_velocity_time, NULL,
		"when the front has that velocity"},
	{"first-front-velocity", "front at first", "m/s", 3, ALONE(METRIC_RUN), metric_first_front_velocity, NULL,
		"the velocity of the front after its first 0.04 s"},
	{"l2-observed", "l2 from observed", "%", 2, OBSERVED(METRIC_PROFILE, "h"), metric_l2_observed, NULL,
		"difference in thickness from observations at a profile time, as l2-difference"},
	{"front-observed", "front from observed", "%", 2, OBSERVED(METRIC_RUN, "front_position"),
		metric_front_observed, NULL,
		"difference of the front from observations over time, relative to its way from the gate"},
	{"l1-difference", "l1", "%", 2, AGAINST(PARTNER_REFERENCE, METRIC_PROFILE), metric_l1_difference, NULL,
		"difference in thickness from the `reference` run, over the mass above the bed: l1 norm, at a profile time, "
		"in the coordinates of the reference"},
	{"l2-difference", "l2", "%", 2, AGAINST(PARTNER_REFERENCE, METRIC_PROFILE), metric_l2_difference, NULL,
		"the same in the l2 norm"},
	{"front-difference", "front", "%", 1, AGAINST(PARTNER_REFERENCE, METRIC_PROFILE), metric_front_difference, NULL,
		"difference of the front from the `reference` run at a profile time, "
		"relative to its way from the gate along the plane"},
	{"h-drift", "h L1", "m2", -1, ALONE(METRIC_RUN), metric_drift_l1, "h",
		"the greatest distance of a stored thickness from the first one stored, L1 as P1 (35)"},
	{"u-drift", "u L1", "m3/s", -1, ALONE(METRIC_RUN), metric_drift_l1, "u",
		"the same of the layer velocities along the slope"},
	{"w-drift", "w L1", "m3/s", -1, ALONE(METRIC_RUN), metric_drift_l1, "w",
		"the same of those normal to the slope"},
	{"h-change", "h moves", "m", -1, ALONE(METRIC_RUN), metric_drift_largest, "h",
		"the greatest change of the thickness at any place since the first profile stored"},
	{"normal-velocity", "greatest w", "m/s", 3, ALONE(METRIC_PROFILE), metric_profile_greatest, "w",
		"the greatest velocity of a layer normal to the slope, up or down, at a profile time"},
	{"kinetic-energy", "kinetic energy", "J/m", 2, ALONE(METRIC_RUN), metric_series_greatest, "kinetic_energy",
		"the greatest kinetic energy"},
	{"h-l1", "h L1", "m2", -1, AGAINST(PARTNER_REFERENCE, METRIC_PROFILE), metric_reference_l1, "h",
		"difference in thickness from the `reference` run, which is averaged over the cells of this one: "
		"L1 as P1 (35), at a profile time"},
	{"h-l1-order", "order", "", 2, AGAINST(PARTNER_REFERENCE_PREVIOUS, METRIC_PROFILE), metric_reference_l1, "h",
		"its order, from the row before"},
	{"u-l1", "u L1", "m3/s", -1, AGAINST(PARTNER_REFERENCE, METRIC_PROFILE), metric_reference_l1, "u",
		"as h-l1, of the layer velocities along the slope, over cells and layers"},
	{"u-l1-order", "order", "", 2, AGAINST(PARTNER_REFERENCE_PREVIOUS, METRIC_PROFILE), metric_reference_l1, "u",
		"its order, from the row before"},
	{"w-l1", "w L1", "m3/s", -1, AGAINST(PARTNER_REFERENCE, METRIC_PROFILE), metric_reference_l1, "w",
		"as h-l1, of the layer velocities normal to the slope, over cells and layers"},
	{"w-l1-order", "order", "", 2, AGAINST(PARTNER_REFERENCE_PREVIOUS, METRIC_PROFILE), metric_reference_l1, "w",
		"its order, from the row before"},
	{"velocity-l1", "v L1", "", -1, ALONE(METRIC_PROFILE), metric_steady_l1, "v",
		"error of the velocity profile against the exact steady flow, L1, at a profile time"},
	{"velocity-l2", "v L2", "", -1, ALONE(METRIC_PROFILE), metric_steady_l2, "v",
		"the same in L2"},
	{"velocity-linf", "v Linf", "", -1, ALONE(METRIC_PROFILE), metric_steady_linf, "v",
		"the same, the greatest"},
	{"velocity-l1-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_PROFILE), metric_steady_l1, "v",
		"its order, from the row before"},
	{"velocity-l2-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_PROFILE), metric_steady_l2, "v",
		"its order, from the row before"},
	{"velocity-linf-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_PROFILE), metric_steady_linf, "v",
		"its order, from the row before"},
	{"fraction-l1", "phi L1", "", -1, ALONE(METRIC_PROFILE), metric_steady_l1, "phi",
		"error of the solid fraction against the exact steady flow, L1, at a profile time"},
	{"fraction-l2", "phi L2", "", -1, ALONE(METRIC_PROFILE), metric_steady_l2, "phi",
		"the same in L2"},
	{"fraction-linf", "phi Linf", "", -1, ALONE(METRIC_PROFILE), metric_steady_linf, "phi",
		"the same, the greatest"},
	{"fraction-l1-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_PROFILE), metric_steady_l1, "phi",
		"its order, from the row before"},
	{"fraction-l2-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_PROFILE), metric_steady_l2, "phi",
		"its order, from the row before"},
	{"fraction-linf-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_PROFILE), metric_steady_linf, "phi",
		"its order, from the row before"},
	{"max-velocity", "v max", "m/s", -1, ALONE(METRIC_PROFILE), metric_layer_max, "v",
		"greatest layer velocity at a profile time"},
	{"final-max-speed", "v max", "m/s", -1, ALONE(METRIC_RUN), metric_series_last, "max_speed",
		"greatest layer velocity at the end"},
	{"steady-max-speed", "exact v max", "m/s", -1, ALONE(METRIC_RUN), metric_series_last, "steady_max_speed",
		"the same of the exact steady flow"},
	{"bagnold-error", "u L2", "", -1, ALONE(METRIC_RUN), metric_series_last, "bagnold_error",
		"error of the velocity profile of a dry uniform flow against the exact steady one at the end, P3 (53)"},
	{"bagnold-error-order", "order", "", 2, AGAINST(PARTNER_PREVIOUS, METRIC_RUN), metric_series_last, "bagnold_error",
		"its order, from the row before"},
	{"final-mean-speed", "v mean", "m/s", -1, ALONE(METRIC_RUN), metric_series_last, "mean_speed",
		"mean velocity at the end"},
	{"final-fraction", "phi mean", "", 4, ALONE(METRIC_RUN), metric_series_last, "fraction",
		"mean solid fraction at the end"},
	{"final-height", "h", "m", 6, ALONE(METRIC_RUN), metric_series_last, "height",
		"height at the end"},
	{"final-solid-mass", "solid mass", "kg/m2", 3, ALONE(METRIC_RUN), metric_series_last, "solid_mass",
		"solid mass at the end"},
	{"final-bottom-pressure", "p bottom", "Pa", 2, ALONE(METRIC_RUN), metric_series_last, "bottom_pressure",
		"solid pressure at the bottom at the end"},
	{"greatest-excess-pressure", "greatest p_e", "Pa", 2, ALONE(METRIC_RUN), metric_series_greatest, "excess_pressure",
		"greatest excess pore pressure"},
	{"least-excess-pressure", "least p_e", "Pa", 2, ALONE(METRIC_RUN), metric_series_least, "excess_pressure",
		"least excess pore pressure"},
	{"pressure-error", "p off by", "", -1, ALONE(METRIC_RUN), metric_series_greatest, "pressure_error",
		"greatest relative error of the pressure root against its exact value"},
	{"final-pressure-error", "p off by, at end", "", -1, ALONE(METRIC_RUN), metric_series_last, "pressure_error",
		"the same at the end"},
	{"solid-mass-drift", "mass drift", "1e-12", 4, ALONE(METRIC_RUN), metric_series_drift, "solid_mass",
		"greatest relative change of the solid mass, in 1e-12"},
	{"height-drift", "h drift", "1e-12", 4, ALONE(METRIC_RUN), metric_series_drift, "height",
		"greatest relative change of the height, in 1e-12"},
	{"half-speed-time", "v max/2 at", "s", -1, ALONE(METRIC_RUN), metric_series_half_time, "max_speed",
		"when the greatest velocity has reached half of its end value"},
	{"transfer-sign-change", "G_f changes sign at", "s", -1, ALONE(METRIC_RUN),
		metric_series_sign_change, "fluid_transfer",
		"when the fluid transfer at the top changes its sign"},
	{"speed-difference", "v max apart", "%", 3, AGAINST(PARTNER_REFERENCE, METRIC_RUN),
		metric_series_difference, "max_speed",
		"greatest difference of the greatest velocity from the `reference` run, over its greatest value"},
	{"newton-iterations", "Newton iterations", "", 0, ALONE(METRIC_RUN), metric_series_last, "newton_iterations",
		"Newton iterations of the whole run"},
};
/* clang-format on */

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
