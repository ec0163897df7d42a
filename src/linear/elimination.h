/* Columns of a symmetric system eliminated from the left, in any range of them.
 *
 * It leaves for column f the dense matrix S_f = D_f - C_f X_{f-1} C_f^T, with X = S^-1, D_f what the column
 * does to itself and C_f what it does with the column before (both tridiagonal over the layers). X is
 * formed by Gauss-Jordan elimination, which needs no pivoting as S is positive definite, so that a solve
 * is two products with X per column. */
#ifndef TALUS_ELIMINATION_H
#define TALUS_ELIMINATION_H

#include "linear/columns.h"

enum { ELIMINATION_BLOCKS_KNOWN = 5 }; /* vectors in a row, up to which it is fastest */

struct elimination {
	struct column_layout columns; /* as many as there is room for */
	int blocks;                   /* vectors in a row of X */
	size_t row;                   /* LANES blocks */
	double *x;                    /* [columns][layers][row]: X of each column */
	double *lower; /* [columns][row]: C_f from layer a to a - 1 of the column before */
	double *same;  /* [columns][row]: to a */
	double *upper; /* [columns][row]: to a + 1 */
	double *diagonal,
		*above; /* [row], of D of the column at hand: itself, and with the layer above */
	void *memory;
};

/* The vectors in a row of X. */
static inline int elimination_blocks(int layers)
{
	return (layers + LANES - 1) / LANES;
}

/* Room for so many columns. EX_SOFTWARE out of memory. */
int elimination_init(struct elimination *e, int layers, int room, struct error *err);
void elimination_clean(struct elimination *e);

/* Factor the system of the `count` columns from face `first` on, all others held at zero. It takes the place of
 * columns at..at + count - 1 in the memory. */
void elimination_factor(
	struct elimination *e, const struct pressure_system *system, int first, int count, int at);

/* Solve what was factored there; `right` is spoiled. Both are the first of `count` columns. */
void elimination_solve(
	const struct elimination *e, double *right, double *solution, int count, int at);

#endif
