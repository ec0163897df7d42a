/* What the keys of a config say has to agree. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "config/config_table.h"

/* An error about two keys, at the place of that which was read later (`other` may be NULL). Returns -1. */
__attribute__((format(printf, 5, 6))) static int refuse(const struct field_reader *reader,
	const char *key, const char *other, struct error *err, const char *format, ...)
{
	char message[sizeof err->text];
	va_list args;

	va_start(args, format);
	(void)vsnprintf(message, sizeof message, format, args);
	va_end(args);
	(void)error_set(err, EX_DATAERR, "%s", message);
	return field_blame(reader, key, other, -1, err);
}

static int check_layers(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	int n = config->n_ini_guess;

	if (n >= config->layers)
		return refuse(reader, "n_ini_guess", "layers", err,
			"n_ini_guess: %d is not below layers (%d)", n, config->layers);
	if (n > 0 && config->layers % n != 0)
		return refuse(reader, "n_ini_guess", "layers", err,
			"n_ini_guess: %d does not divide layers (%d)", n, config->layers);
	return 0;
}

/* Shapes that end at a gate. */
static bool has_front(const struct config *config)
{
	int shape = config->initial.shape;

	return shape == SHAPE_COLUMN || shape == SHAPE_TRIANGLE || shape == SHAPE_CAP ||
		   config->gate.speed != 0;
}

/* Cells have to be told apart, by their places and by what differs between them. */
static int check_cells(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	double x_min = config->domain.x_min, x_max = config->domain.x_max;
	double width = (x_max - x_min) / config->domain.cells;
	double least = fmax(1e-9, 1e-12 * fmax(fabs(x_min), fabs(x_max)));
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (width >= least)
		return 0;
	return refuse(reader, "domain.cells", "domain.x_max", err,
		"domain: %d cells between x_min and x_max are %s m wide each; "
		"here they must be at least %s m",
		config->domain.cells, text_real(width, first), text_real(least, second));
}

static int check_domain(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	double x_min = config->domain.x_min, x_max = config->domain.x_max;
	double front = config->initial.front;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (x_min >= x_max)
		return refuse(reader, "domain.x_min", "domain.x_max", err,
			"domain: x_min (%s m) is not below x_max (%s m)", text_real(x_min, first),
			text_real(x_max, second));
	TRY(check_cells(config, reader, err));
	if (!has_front(config) || (front >= x_min && front <= x_max))
		return 0;
	return refuse(reader, "initial.front", front < x_min ? "domain.x_min" : "domain.x_max", err,
		"initial.front: %s m is outside the domain, %s m is its %s", text_real(front, first),
		text_real(front < x_min ? x_min : x_max, second), front < x_min ? "x_min" : "x_max");
}

/* The rows of P1 (37) tie two faces at either end: fewer cells have no row of their own left. */
static int check_operator(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	int method = config->pressure_solver.method;

	if (config->pressure_solver.operator_ != OPERATOR_POINTWISE)
		return 0;
	if (config_symmetric_only(method))
		return refuse(reader, "pressure_solver.method", "pressure_solver.operator", err,
			"pressure_solver.method: %s solves symmetric systems only, "
			"and pressure_solver.operator is pointwise",
			field_find(&config_table, "pressure_solver.method")->choices[method]);
	if (config->domain.cells >= 4)
		return 0;
	return refuse(reader, "domain.cells", "pressure_solver.operator", err,
		"domain.cells: %d is too few for the pointwise operator, which needs 4",
		config->domain.cells);
}

static int check_rheology(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (config->rheology.law == LAW_LINEAR && config->model != MODEL_IMMERSED)
		return refuse(reader, "rheology.law", "model", err,
			"rheology.law: linear is a law of model: immersed");
	if (config->rheology.law == LAW_CONSTANT && config->model != MODEL_DRY)
		return refuse(reader, "rheology.law", "model", err,
			"rheology.law: constant is a law of model: dry; in the others linear with k_1: 0 is");
	if (config->rheology.law != LAW_MU_I || config->rheology.mu_s <= config->rheology.mu_2)
		return 0;
	return refuse(reader, "rheology.mu_s", "rheology.mu_2", err,
		"rheology: mu_s (%s) is above mu_2 (%s)", text_real(config->rheology.mu_s, first),
		text_real(config->rheology.mu_2, second));
}

static int check_fractions(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *fractions = &config->layer_fractions;
	char shown[TEXT_REAL_SIZE];
	double sum = 0;

	if (!fractions->count)
		return 0;
	for (int i = 0; i < fractions->count; i++)
		sum += fractions->values[i];
	if (fractions->count != config->layers)
		return refuse(reader, "layer_fractions", "layers", err,
			"layer_fractions: %d values for layers: %d", fractions->count, config->layers);
	if (!(fabs(sum - 1) <= 1e-9))
		return refuse(reader, "layer_fractions", NULL, err,
			"layer_fractions: they add up to %s, not to 1", text_real(sum, shown));
	if (config->model != MODEL_DRY || config->pressure == PRESSURE_HYDROSTATIC ||
		config->pressure_solver.operator_ == OPERATOR_SYMMETRIC)
		return 0;
	return refuse(reader, "layer_fractions", "pressure_solver.operator", err,
		"layer_fractions: pressure_solver.operator: pointwise is P1's, of equal layers; "
		"symmetric takes any");
}

/* What leaves at one end comes in at the other. */
static int check_ends(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	bool left = config->domain.left == BOUNDARY_PERIODIC;
	bool right = config->domain.right == BOUNDARY_PERIODIC;

	if (left != right)
		return refuse(reader, "domain.left", "domain.right", err,
			"domain: %s is periodic and %s is not; it takes both ends", left ? "left" : "right",
			left ? "right" : "left");
	if (!left || config->pressure == PRESSURE_HYDROSTATIC)
		return 0;
	if (config->pressure_solver.operator_ == OPERATOR_POINTWISE)
		return refuse(reader, "pressure_solver.operator", "domain.left", err,
			"pressure_solver.operator: pointwise has rows at walls and outflows (P1 37), "
			"none at periodic ends; they take symmetric");
	if (config_periodic_too(config->pressure_solver.method))
		return 0;
	return refuse(reader, "pressure_solver.method", "domain.left", err,
		"pressure_solver.method: %s knows walls and outflows; "
		"periodic ends take auto or conjugate-gradients",
		field_find(&config_table, "pressure_solver.method")
			->choices[config->pressure_solver.method]);
}

/* Grains that do not sink have no weight to press them together. */
static int check_fluid(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (config->model != MODEL_IMMERSED || config->fluid.density < config->grains.density)
		return 0;
	return refuse(reader, "fluid.density", "grains.density", err,
		"fluid.density: %s kg/m3 is not below grains.density (%s kg/m3)",
		text_real(config->fluid.density, first), text_real(config->grains.density, second));
}

/* The times that would do are told as they are to be set: the commonest way here is an earlier end. */
static int check_times(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *times = &config->output.profiles_at;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];
	struct text kept = {0};
	int good = 0;

	while (good < times->count && times->values[good] <= config->time.end) {
		text_addf(&kept, "%s%s", good ? "," : "", text_real(times->values[good], first));
		good++;
	}
	if (good < times->count)
		(void)error_set(err, EX_DATAERR,
			"output.profiles_at: %s s is after time.end (%s s); "
			"an earlier end wants fewer times: output.profiles_at=[%s]",
			text_real(times->values[good], first), text_real(config->time.end, second),
			text_string(&kept));
	text_clean(&kept);
	return good < times->count ? field_blame(reader, "output.profiles_at", "time.end", good, err)
							   : 0;
}

static int check_positions(const struct config *config, const char *key,
	const struct real_list *positions, const struct field_reader *reader, struct error *err)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	for (int i = 0; i < positions->count; i++) {
		double x = positions->values[i];
		bool left = x < config->domain.x_min;

		if (!left && x <= config->domain.x_max)
			continue;
		(void)error_set(err, EX_DATAERR, "%s: %s m is outside the domain, %s m is its %s", key,
			text_real(x, first),
			text_real(left ? config->domain.x_min : config->domain.x_max, second),
			left ? "x_min" : "x_max");
		return field_blame(reader, key, left ? "domain.x_min" : "domain.x_max", i, err);
	}
	return 0;
}

static int check_gauges(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	return check_positions(config, "output.gauges", &config->output.gauges, reader, err);
}

static int check_stations(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	return check_positions(config, "output.velocity_at", &config->output.velocity_at, reader, err);
}

/* Points belong to shape file, which has nothing without them. */
static int check_points(const struct field_reader *reader, const struct real_list *points,
	bool wanted, const char *key, const char *shape, struct error *err)
{
	if (wanted == (points->count > 0))
		return 0;
	if (wanted)
		return refuse(reader, key, shape, err, "%s: shape file needs points", key);
	return refuse(reader, key, shape, err, "%s: points are given, and %s is not file", key, shape);
}

/* The bed is known where the cells are, and can be had in the coordinates of the run. */
static int check_bed(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *points = &config->topography.points;
	int shape = config->topography.shape;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];
	bool here = config_bed_is_given_here(config);

	if (shape == TOPOGRAPHY_BUMP && config->slope > 0 &&
		(config->topography.coordinates == GIVEN_LOCAL ||
			(config->topography.coordinates == GIVEN_SAME &&
				config->coordinates == COORDINATES_LOCAL)))
		return refuse(reader, "topography.shape", "topography.coordinates", err,
			"topography.shape: bump is given in cartesian heights; "
			"write topography.coordinates: cartesian");
	if (shape == TOPOGRAPHY_RANDOM && !here)
		return refuse(reader, "topography.coordinates", "topography.shape", err,
			"topography.coordinates: a random bed is drawn cell by cell "
			"in the coordinates of the run and cannot be changed into others");
	if (shape == TOPOGRAPHY_RANDOM && config->domain.x_min <= -4)
		return refuse(reader, "domain.x_min", "topography.shape", err,
			"domain.x_min: %s m; the random bed of P1 5.3 begins beyond -4 m",
			text_real(config->domain.x_min, first));
	TRY(check_points(
		reader, points, shape == TOPOGRAPHY_FILE, "topography.points", "topography.shape", err));
	if (!points->count || !here ||
		(points->values[0] <= config->domain.x_min &&
			points->values[points->count - 2] >= config->domain.x_max))
		return 0;
	return refuse(reader, "topography.points", "domain.x_max", err,
		"topography.points: they go from %s m to %s m, and do not cover the domain",
		text_real(points->values[0], first), text_real(points->values[points->count - 2], second));
}

static int check_initial(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *points = &config->initial.points;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	TRY(check_points(reader, points, config->initial.shape == SHAPE_FILE, "initial.points",
		"initial.shape", err));
	for (int i = 0; i + 1 < points->count; i += 2)
		if (points->values[i + 1] < 0)
			return refuse(reader, "initial.points", NULL, err,
				"initial.points: at x = %s m the thickness is %s m; it must be at least 0",
				text_real(points->values[i], first), text_real(points->values[i + 1], second));
	return 0;
}

static int check_gate(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	if (config->gate.speed == 0)
		return 0;
	if (config->pressure == PRESSURE_HYDROSTATIC)
		return refuse(reader, "gate.speed", "pressure", err,
			"gate.speed: hydrostatic pressure has no vertical velocity that could begin with it");
	if (config_bed_is_given_here(config))
		return 0;
	return refuse(reader, "gate.speed", "topography.coordinates", err,
		"gate.speed: the gate stands across the coordinates of the run, "
		"and here the grains are given in others");
}

/* P2's friction step knows no layers. */
static int check_friction(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	if (config->scheme.friction == FRICTION_VISCOUS)
		return 0;
	if (config->walls.mu_w > 0 || config->bottom == BOTTOM_NO_SLIP ||
		config->rheology.strain_rate == STRAIN_RATE_SECOND_ORDER ||
		config->regularisation.viscosity == VISCOSITY_BOUNDED) {
		const char *key = config->walls.mu_w > 0             ? "walls.mu_w"
						  : config->bottom == BOTTOM_NO_SLIP ? "bottom"
						  : config->regularisation.viscosity == VISCOSITY_BOUNDED
							  ? "regularisation.viscosity"
							  : "rheology.strain_rate";

		return refuse(reader, "scheme.friction", key, err,
			"scheme.friction: coulomb knows neither side walls nor viscous stresses, "
			"which %s asks for",
			key);
	}
	if (config->scheme.viscosity_updates > 0)
		return refuse(reader, "scheme.viscosity_updates", "scheme.friction", err,
			"scheme.viscosity_updates: there is no viscosity where scheme.friction is coulomb");
	if (config->layers == 1)
		return 0;
	return refuse(reader, "scheme.friction", "layers", err,
		"scheme.friction: coulomb stops a whole column, and here are %d layers that shear",
		config->layers);
}

/* The config is kept in one attribute of the run file, of which HDF5 holds 64 kB. */
static int check_length(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	enum { FITS = 60000 };
	struct text text = {0};
	size_t length;

	if (config->topography.points.count + config->initial.points.count < FITS / 64)
		return 0;
	config_print(config, &text);
	length = text.length;
	text_clean(&text);
	if (length <= FITS)
		return 0;
	return refuse(reader, "topography.points", "initial.points", err,
		"topography.points, initial.points: as text the config has %zu bytes, "
		"and a run file holds %d; fewer points or fewer digits are needed",
		length, FITS);
}

/* The first that does not hold is told. */
static const struct check {
	int (*check)(const struct config *config, const struct field_reader *reader, struct error *err);
	bool dry; /* of this model alone */
} checks[] = {
	{check_layers, false},
	{check_domain, false},
	{check_ends, false},
	{check_rheology, false},
	{check_times, false},
	{check_gauges, false},
	{check_stations, false},
	{check_operator, false},
	{check_fractions, false},
	{check_fluid, false},
	{check_bed, true},
	{check_initial, true},
	{check_gate, true},
	{check_friction, true},
	{check_length, true},
};

int config_check(const struct config *config, const struct field_reader *reader, struct error *err)
{
	for (size_t i = 0; i < sizeof checks / sizeof *checks; i++)
		if (!checks[i].dry || config->model == MODEL_DRY)
			TRY(checks[i].check(config, reader, err));
	return 0;
}
