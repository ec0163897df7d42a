/* What a config says of bed, initial shape and gate has to agree. */
#include "config/config_table.h"

/* Points belong to shape file, which has nothing without them. */
static int check_points(const struct field_reader *reader, const struct real_list *points,
	bool wanted, const char *key, const char *shape, struct error *err)
{
	if (wanted == (points->count > 0))
		return 0;
	if (wanted)
		(void)error_set(err, EX_DATAERR, "%s: shape file needs points", key);
	else
		(void)error_set(err, EX_DATAERR, "%s: points are given, and %s is not file", key, shape);
	return field_blame(reader, key, shape, -1, err);
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
				config->coordinates == COORDINATES_LOCAL))) {
		(void)error_set(err, EX_DATAERR,
			"topography.shape: bump is given in cartesian heights; write topography.coordinates: "
			"cartesian");
		return field_blame(reader, "topography.shape", "topography.coordinates", -1, err);
	}
	if (shape == TOPOGRAPHY_RANDOM && !here) {
		(void)error_set(err, EX_DATAERR,
			"topography.coordinates: a random bed is drawn cell by cell in the coordinates of the "
			"run and cannot be changed into others");
		return field_blame(reader, "topography.coordinates", "topography.shape", -1, err);
	}
	if (shape == TOPOGRAPHY_RANDOM && config->domain.x_min <= -4) {
		(void)error_set(err, EX_DATAERR,
			"domain.x_min: %s m; the random bed of P1 5.3 begins beyond -4 m",
			text_real(config->domain.x_min, first));
		return field_blame(reader, "domain.x_min", "topography.shape", -1, err);
	}
	TRY(check_points(
		reader, points, shape == TOPOGRAPHY_FILE, "topography.points", "topography.shape", err));
	if (!points->count || !here ||
		(points->values[0] <= config->domain.x_min &&
			points->values[points->count - 2] >= config->domain.x_max))
		return 0;
	(void)error_set(err, EX_DATAERR,
		"topography.points: they go from %s m to %s m, and do not cover the domain",
		text_real(points->values[0], first), text_real(points->values[points->count - 2], second));
	return field_blame(reader, "topography.points", "domain.x_max", -1, err);
}

static int check_thickness(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *points = &config->initial.points;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	for (int i = 0; i + 1 < points->count; i += 2) {
		if (points->values[i + 1] >= 0)
			continue;
		(void)error_set(err, EX_DATAERR,
			"initial.points: at x = %s m the thickness is %s m; it must be at least 0",
			text_real(points->values[i], first), text_real(points->values[i + 1], second));
		return field_blame(reader, "initial.points", NULL, -1, err);
	}
	return 0;
}

static int check_gate(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	if (config->gate.speed == 0)
		return 0;
	if (config->pressure == PRESSURE_HYDROSTATIC) {
		(void)error_set(err, EX_DATAERR,
			"gate.speed: hydrostatic pressure has no vertical velocity that could begin with it");
		return field_blame(reader, "gate.speed", "pressure", -1, err);
	}
	if (config_bed_is_given_here(config))
		return 0;
	(void)error_set(err, EX_DATAERR,
		"gate.speed: the gate stands across the coordinates of the run, and here the grains are "
		"given "
		"in others");
	return field_blame(reader, "gate.speed", "topography.coordinates", -1, err);
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

		(void)error_set(err, EX_DATAERR,
			"scheme.friction: coulomb knows neither side walls nor viscous stresses, which %s asks "
			"for",
			key);
		return field_blame(reader, "scheme.friction", key, -1, err);
	}
	if (config->scheme.viscosity_updates > 0) {
		(void)error_set(err, EX_DATAERR,
			"scheme.viscosity_updates: there is no viscosity where scheme.friction is coulomb");
		return field_blame(reader, "scheme.viscosity_updates", "scheme.friction", -1, err);
	}
	if (config->layers == 1)
		return 0;
	(void)error_set(err, EX_DATAERR,
		"scheme.friction: coulomb stops a whole column, and here are %d layers that shear",
		config->layers);
	return field_blame(reader, "scheme.friction", "layers", -1, err);
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
	(void)error_set(err, EX_DATAERR,
		"topography.points, initial.points: as text the config has %zu bytes, and a run file holds "
		"%d; fewer points or fewer digits are needed",
		length, FITS);
	return field_blame(reader, "topography.points", "initial.points", -1, err);
}

int config_check_geometry(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	if (config->model != MODEL_DRY)
		return 0;
	TRY(check_bed(config, reader, err));
	TRY(check_points(reader, &config->initial.points, config->initial.shape == SHAPE_FILE,
		"initial.points", "initial.shape", err));
	TRY(check_thickness(config, reader, err));
	TRY(check_gate(config, reader, err));
	TRY(check_friction(config, reader, err));
	return check_length(config, reader, err);
}
