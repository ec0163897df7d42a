/* What a run costs before it has begun: the order of the runs of a campaign, and the first time left. */
#include <math.h>

#include "dry/dry.h"

/* Of the pressure step, in nanoseconds per cell, layer and step, measured on one core of an AMD EPYC with
 * 640 cells. The sweeps of block Gauss-Seidel grow with layers and with h/dx, and a coarse first guess
 * saves up to two thirds of them; over-relaxation takes about the root of their number. */
static double pressure_cost(const struct config *config, double dx, double h)
{
	double n = config->layers, guess = config->n_ini_guess / n;
	double sweeps = n * h / (7 * dx) * fmax(0.3, 1 - 1.4 * guess);

	switch (config->pressure_solver.method) {
	case METHOD_BLOCK_GAUSS_SEIDEL:
		return 8.4 * sweeps;
	case METHOD_BLOCK_GAUSS_SEIDEL_FACTORED:
		return 4.5 * sweeps;
	case METHOD_RED_BLACK_LINE_RELAXATION:
		return 20 * sqrt(sweeps);
	case METHOD_LAPACK_BAND:
		return 10 * n;
	case METHOD_BLOCK_DIRECT:
		return 20 + 0.3 * n + 0.025 * n * n;
	default:
		return 22 + 38 / n;
	}
}

/* Transport, friction and recording, which is per cell. What limits the steps runs with sqrt(g h) at first, and
 * the slower the thinner the mass becomes: experiments/energy.yaml. */
double dry_cost(const struct config *config)
{
	const double gravity = 9.81;
	double explicit_cost = 2.8 + 17.0 / config->layers;
	double dx = (config->domain.x_max - config->domain.x_min) / config->domain.cells;
	double h = config->initial.height + config->erodible_bed_thickness;
	double wave = sqrt(gravity * h) * fmax(0.3, 1 - 0.68 * tan(config->slope));
	double steps = wave * config->time.end / (config->time.cfl * dx);
	double pressure =
		config->pressure == PRESSURE_NON_HYDROSTATIC ? pressure_cost(config, dx, h) : 0;

	return 1e-9 * steps * config->domain.cells * config->layers * (explicit_cost + pressure);
}
