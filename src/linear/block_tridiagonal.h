/* Linear systems of dense blocks that couple each row with its two neighbours. */
#ifndef TALUS_BLOCK_TRIDIAGONAL_H
#define TALUS_BLOCK_TRIDIAGONAL_H

#include "talus/error.h"

enum { BLOCK_SIZE = 5 };

typedef double block[BLOCK_SIZE][BLOCK_SIZE];

/* Row i: below[i] x[i-1] + diagonal[i] x[i] + above[i] x[i+1] = right[i]. */
struct block_tridiagonal {
	int rows;
	block *below, *diagonal, *above; /* [rows] */
	int (*pivots)[BLOCK_SIZE];       /* [rows] */
};

int block_tridiagonal_init(struct block_tridiagonal *system, int rows, struct error *err);
void block_tridiagonal_clean(struct block_tridiagonal *system); /* NULL-safe */

/* Factor in place, by Gaussian elimination with pivots within the diagonal blocks. Returns -1 where a
 * pivot is zero or no number. */
int block_tridiagonal_factor(struct block_tridiagonal *system);

/* Solve with the factors; `x`, [rows][BLOCK_SIZE], holds the right side and then the solution. */
void block_tridiagonal_solve(const struct block_tridiagonal *system, double *x);

#endif
