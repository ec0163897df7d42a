/* The linear system of the pressure step: block tridiagonal over the layers, each block tridiagonal
 * over the faces (P1 32). Unknown (a, f) is the fluctuation of the non-hydrostatic pressure over rho at
 * the interface below layer a = 0..layers-1 and face f = 0..faces-1, m2/s2.
 *
 * The matrix has two forms. The symmetric operator is the sum over the cells of T^T T / h, and five
 * numbers per cell say all of it (`cells`): methods that need no more are called matrix-free. The nine
 * bands hold any operator, and are filled for the methods that ask for them.
 *
 * Of a periodic system the first and the last face are one, the seam. Both have the unknown, and each has
 * half of its equation. The matrix is S A S, with S the mean of the two and A what the cells say; norms
 * count the seam once. */
#ifndef TALUS_PRESSURE_SYSTEM_H
#define TALUS_PRESSURE_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"

/* The symmetric operator. Cell i = 1..faces-1 lies between faces i - 1 and i; 0 and `faces` are ghosts
 * and zero, as is a cell without grains. With l, r the unknowns at its faces below layer a and L, R
 * those above, J = (l + L) - (r + R) and D = (L + R) - (l + r), the force of the cell and layer is
 *   T^u = h/(2 dx) J + s/share D,  T^w = -N/(2 share) D,  s = N d_x Z_a/2 = lean place + tilt  (P1 9b, 9c)
 * with share = N l_a, and Z_a the height of the middle of the layer. Of the kinetic energy it has the share
 * l_a, and so the cell adds to the product A q at its four corners the transposes of
 *   g = share stretch J + cross s D,  e = cross s J + (s^2 + N^2/4) inverse/share D:
 * g - e at l, -g - e at r, g + e at L, e - g at R. */
struct pressure_cells {
	double *stretch;   /* [faces + 1], h/(4 dx^2), 1/m */
	double *lean;      /* [faces + 1], m/m: d_x h / 2, per mean layer */
	double *tilt;      /* [faces + 1], m/m: s half a mean layer above the bed */
	double *inverse;   /* [faces + 1], 1/h, 1/m */
	double cross;      /* 1/(2 dx), 1/m */
	double quarter_nn; /* N^2/4, 1 */
	const bool *dry;   /* [faces], true: the unknown is 0 there; not owned */

	/* Of the layers, which are a whole number of vectors and one more: */
	double *share; /* thickness in mean layers, 1 */
	double *thin;  /* 1/share */
	double *place; /* of the middle, in mean layers above half a one: a where all are equal */
};

struct pressure_system {
	int layers, faces;

	bool symmetric; /* `cells` hold the matrix */
	bool periodic;  /* of a symmetric one: the ends are a seam */
	struct pressure_cells cells;

	/* The bands, each [layers][faces]; NULL in a matrix-free system. Row (a, f) couples to faces f - 1,
	 * f, f + 1 of its own layer and of the layers below and above; a coupling that would leave the
	 * system is 0. */
	double *lower, *diagonal, *upper;
	double *below_lower, *below_diagonal, *below_upper;
	double *above_lower, *above_diagonal, *above_upper;

	double *rhs;    /* [layers][faces] */
	double *weight; /* [faces], h dx / layers: of a face in the stopping norms (P1 4), m2 */

	/* The solution, [layers + 2][faces + 2] with a border of zeros: no row needs a special case. */
	double *x;
	size_t x_stride; /* faces + 2 */

	double *rows[5]; /* scratch, [faces + 1] */
	double *memory;  /* one block for all of the above */
};

/* Allocate a system of equal layers, all zeros, with or without bands. EX_SOFTWARE out of memory. */
int pressure_system_init(
	struct pressure_system *system, int layers, int faces, bool bands, struct error *err);
/* The layers have these thicknesses [layers], in mean layers. */
void pressure_system_set_shares(struct pressure_system *system, const double *shares);
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

/* Two values at the seam become their mean. */
static inline void pressure_system_join(double *first, double *last)
{
	*first = *last = 0.5 * (*first + *last);
}

/* True relative residual |rhs - A x| / |rhs| in the Euclidean norm, of 0 = A 0 it is 0. */
double pressure_system_residual(const struct pressure_system *system);

/* The same, with rhs - A x in `rows` [layers][faces]. */
double pressure_system_residual_rows(const struct pressure_system *system, double *rows);

/* The face of the largest residual, or of the first that is not a number: where a solver failed. */
int pressure_system_worst_face(const struct pressure_system *system);

#endif
