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

/* What is left of the right side in the row of interface a and face f. */
static double row_residual(const struct pressure_system *system, int a, int f)
{
	size_t k = pressure_system_row(system, a) + (size_t)f;
	const double *x = pressure_system_x(system, a) + f;
	const double *down = pressure_system_x(system, a - 1) + f;
	const double *up = pressure_system_x(system, a + 1) + f;

	return system->rhs[k] - system->lower[k] * x[-1] - system->diagonal[k] * x[0] -
		   system->upper[k] * x[1] - system->below_lower[k] * down[-1] -
		   system->below_diagonal[k] * down[0] - system->below_upper[k] * down[1] -
		   system->above_lower[k] * up[-1] - system->above_diagonal[k] * up[0] -
		   system->above_upper[k] * up[1];
}

double pressure_system_residual(const struct pressure_system *system)
{
	double residual = 0, scale = 0;

	for (int a = 0; a < system->layers; a++)
		for (int f = 0; f < system->faces; f++) {
			double r = row_residual(system, a, f);
			double b = system->rhs[pressure_system_row(system, a) + (size_t)f];

			residual += r * r;
			scale += b * b;
		}
	return scale > 0 ? sqrt(residual / scale) : 0;
}

int pressure_system_worst_face(const struct pressure_system *system)
{
	double worst = -1;
	int face = 0;

	for (int a = 0; a < system->layers; a++)
		for (int f = 0; f < system->faces; f++) {
			double r = fabs(row_residual(system, a, f));

			if (isnan(r))
				return f;
			if (r > worst) {
				worst = r;
				face = f;
			}
		}
	return face;
}
