/* What a run costs before it has begun: the order of the runs of a campaign, and the first time left. */
#include <math.h>

#include "dry/dry.h"

/* Measured on one core of an AMD EPYC, 640 cells, 3 s: transport and friction take 13 to 29 ns per cell,
 * layer and step, a sweep of block Gauss-Seidel 8.4 ns per cell and layer. Its sweeps per step grow
 * with layers and with h/dx; a coarse first guess saves up to two thirds of them. Of 2 to 20 layers, 640
 * and 1280 cells, with and without a guess, the whole came to 0.4 to 1.9 of what was measured. */
double dry_cost(const struct config *config)
{
	const double explicit_seconds = 25e-9, sweep_seconds = 8.4e-9, gravity = 9.81;
	double dx = (config->domain.x_max - config->domain.x_min) / config->domain.cells;
	double h = config->initial.height + config->erodible_bed_thickness;
	double steps = 0.7 * sqrt(gravity * h) * config->time.end / (config->time.cfl * dx);
	double guess = (double)config->n_ini_guess / config->layers;
	double sweeps = config->layers * h / (7 * dx) * fmax(0.3, 1 - 1.4 * guess);

	if (config->pressure == PRESSURE_HYDROSTATIC)
		sweeps = 0;
	return steps * config->domain.cells * config->layers *
		   (explicit_seconds + sweep_seconds * sweeps);
}
