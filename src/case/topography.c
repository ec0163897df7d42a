#include "case/topography.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <math.h>

/* In long double here, as exp in double is chosen by processor and differs in bits. */
static long double bell(long double t)
{
	return expl(-10 * t * t);
}

/* P1 5.4.1 and P2 (29): a valley with a bump at x = 1 m, in Cartesian heights. */
static double valley(const struct config *config, double x)
{
	return (
		double)(1 - tanhl(x) + config->topography.bump * bell(x - 1.0L) + 0.5L * bell(x - 3.0L));
}

/* P1 5.3 without its random part. */
static double rough(const struct config *config, double x)
{
	(void)config;
	return (double)(2 / (x + 4.0L) - 0.5L + bell(x + 1.5L));
}

double topography_points_value(const struct real_list *points, double x)
{
	const double *low = points->values, *high = points->values + points->count - 2;

	if (x <= low[0])
		return low[1];
	if (x >= high[0])
		return high[1];
	while (high - low > 2) {
		const double *middle = low + (high - low) / 4 * 2;

		*(middle[0] <= x ? &low : &high) = middle;
	}
	return low[1] + (high[1] - low[1]) * (x - low[0]) / (high[0] - low[0]);
}

static double points(const struct config *config, double x)
{
	return topography_points_value(&config->topography.points, x);
}

static double plane(const struct config *config, double x)
{
	return config_bed_is_absolute(config) ? topography_plane(config, x) : 0;
}

/* The index is enum topography_kind. */
static double (*const shapes[])(const struct config *config, double x) = {
	[TOPOGRAPHY_PLANE] = plane,
	[TOPOGRAPHY_BUMP] = valley,
	[TOPOGRAPHY_RANDOM] = rough,
	[TOPOGRAPHY_FILE] = points,
};

double topography_bed(const struct config *config, double x)
{
	return shapes[config->topography.shape](config, x);
}

double topography_plane(const struct config *config, double x)
{
	double end = config->domain.x_max;

	if (config->coordinates == COORDINATES_LOCAL)
		end *= (double)cosl(config->slope);
	return config->topography.plane_height + (end - x) * (double)tanl(config->slope);
}

int topography_add_random(
	const struct config *config, const struct grid *grid, double *row, struct error *err)
{
	gsl_error_handler_t *before;
	gsl_rng *random;

	if (config->topography.shape != TOPOGRAPHY_RANDOM)
		return 0;
	before = gsl_set_error_handler_off();
	random = gsl_rng_alloc(gsl_rng_mt19937);
	(void)gsl_set_error_handler(before);
	if (!random)
		return error_memory(err, 0);
	gsl_rng_set(random, (unsigned long)config->topography.seed);
	for (int i = 1; i <= grid->cells; i++)
		row[i] += config->topography.roughness * gsl_rng_uniform(random);
	gsl_rng_free(random);
	return 0;
}
