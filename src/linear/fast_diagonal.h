/* The symmetric pressure operator without its xi terms, solved exactly: a preconditioner.
 *
 * Without xi the operator is B^T B (x) K + D^T D (x) M, where B q = q_a + q_{a+1} and
 * D q = q_a - q_{a+1} act over the layers, and K and M are tridiagonal along x. With
 * t_m = (m + 1/2) pi/N the vectors cos(a t_m), m = 0..N-1, diagonalise both, to 2 + 2 cos t_m and
 * 2 - 2 cos t_m (with half the weight at the bed), so that N tridiagonal systems along x are left. */
#ifndef TALUS_FAST_DIAGONAL_H
#define TALUS_FAST_DIAGONAL_H

#include "linear/columns.h"

struct fast_diagonal {
	struct columns columns;
	double *to_modes;   /* [layers][stride], sqrt(2/N) cos(a t_m), m along the row */
	double *to_layers;  /* its transpose */
	double *of_stretch; /* [stride], 2 + 2 cos t_m; 1 in the padding */
	double *of_mean;    /* [stride], 2 - 2 cos t_m; 1 in the padding */
	double *multiplier; /* columns of modes: L of the L D L^T of each tridiagonal system */
	double *inverse;    /* columns of modes: 1/D */
	double *bands[4]; /* [faces + 1]: diagonals of K and M, and their coupling to the face before */
	double *memory;
};

int fast_diagonal_init(struct fast_diagonal *fast, int layers, int faces, struct error *err);
void fast_diagonal_clean(struct fast_diagonal *fast);

/* K and M of a system. Then, for blocks [first, last) of modes, the factors. */
void fast_diagonal_prepare(struct fast_diagonal *fast, const struct pressure_system *system);
void fast_diagonal_factor(struct fast_diagonal *fast, int first, int last);

/* Columns of layers into columns of modes (`modes` = to_modes) or back (`to_layers`), in groups
 * [first, last). */
void fast_diagonal_transform(const struct fast_diagonal *fast, const double *matrix,
	const double *from, double *to, int first, int last);

/* Solve the systems of blocks [first, last) of modes in place. Returns in `sums` [blocks] the product of
 * right side and solution, which the preconditioned residual norm is made of. */
void fast_diagonal_solve(
	const struct fast_diagonal *fast, double *modes, double *sums, int first, int last);

#endif
