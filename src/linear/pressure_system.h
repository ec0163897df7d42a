/* The linear system of the pressure step: block tridiagonal over the layers, each block tridiagonal
 * over the faces (P1 32). Unknown (a, f) is the fluctuation of the non-hydrostatic pressure over rho at
 * the interface below layer a = 0..layers-1 and face f = 0..faces-1, m2/s2. */
#ifndef TALUS_PRESSURE_SYSTEM_H
#define TALUS_PRESSURE_SYSTEM_H

#include <stddef.h>

#include "talus/error.h"

struct pressure_system {
	int layers, faces;

	/* Matrix and right side, each [layers][faces]. Row (a, f) couples to faces f - 1, f, f + 1 of its
	 * own layer and of the layers below and above; a coupling that would leave the system is 0. */
	double *lower, *diagonal, *upper;
	double *below_lower, *below_diagonal, *below_upper;
	double *above_lower, *above_diagonal, *above_upper;
	double *rhs;

	double *weight; /* [faces], h dx / layers: of a face in the stopping norms (P1 4), m2 */

	/* The solution, [layers + 2][faces + 2] with a border of zeros: no row needs a special case. */
	double *x;
	size_t x_stride; /* faces + 2 */

	double *memory; /* one block for all of the above */
};

/* Allocate a system, all zeros. EX_SOFTWARE out of memory. */
int pressure_system_init(struct pressure_system *system, int layers, int faces, struct error *err);
void pressure_system_clean(struct pressure_system *system);

/* Row of layer a (from 0) of a [layers][faces] array. */
static inline size_t pressure_system_row(const struct pressure_system *system, int a)
{
	return (size_t)a * (size_t)system->faces;
}

/* The solution at the interface below layer a; a = -1 and a = layers are rows of zeros. */
static inline double *pressure_system_x(const struct pressure_system *system, int a)
{
	return system->x + (size_t)(a + 1) * system->x_stride + 1;
}

/* True relative residual |rhs - A x| / |rhs| in the Euclidean norm; 0 when the right side is 0. */
double pressure_system_residual(const struct pressure_system *system);

/* The face of the largest residual, or of the first that is not a number: where a solver failed. */
int pressure_system_worst_face(const struct pressure_system *system);

#endif
