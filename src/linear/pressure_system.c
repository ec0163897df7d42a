#include "linear/pressure_system.h"

#include <math.h>
#include <stdlib.h>

int pressure_system_init(struct pressure_system *system, int layers, int faces, struct error *err)
{
	size_t n = (size_t)layers * (size_t)faces, stride = (size_t)faces + 2;
	size_t count = 10 * n + (size_t)faces + ((size_t)layers + 2) * stride;
	double *p = calloc(count, sizeof *p);

	*system = (struct pressure_system){.layers = layers, .faces = faces, .memory = p};
	if (!p)
		return error_memory(err, count * sizeof *p);
	double **parts[] = {&system->lower, &system->diagonal, &system->upper, &system->below_lower,
		&system->below_diagonal, &system->below_upper, &system->above_lower,
		&system->above_diagonal, &system->above_upper, &system->rhs};
	for (size_t i = 0; i < sizeof parts / sizeof *parts; i++, p += n)
		*parts[i] = p;
	system->weight = p;
	system->x = p + faces;
	system->x_stride = stride;
	return 0;
}

void pressure_system_clean(struct pressure_system *system)
{
	free(system->memory);
	*system = (struct pressure_system){0};
}

double pressure_system_residual(const struct pressure_system *system)
{
	double residual = 0, scale = 0;

	for (int a = 0; a < system->layers; a++) {
		size_t row = pressure_system_row(system, a);
		const double *x = pressure_system_x(system, a);
		const double *down = pressure_system_x(system, a - 1);
		const double *up = pressure_system_x(system, a + 1);

		for (int f = 0; f < system->faces; f++) {
			size_t k = row + (size_t)f;
			double b = system->rhs[k];
			double r = b - system->lower[k] * x[f - 1] - system->diagonal[k] * x[f] -
					   system->upper[k] * x[f + 1] - system->below_lower[k] * down[f - 1] -
					   system->below_diagonal[k] * down[f] - system->below_upper[k] * down[f + 1] -
					   system->above_lower[k] * up[f - 1] - system->above_diagonal[k] * up[f] -
					   system->above_upper[k] * up[f + 1];

			residual += r * r;
			scale += b * b;
		}
	}
	return scale > 0 ? sqrt(residual / scale) : 0;
}
