#include "linear/block_tridiagonal.h"

#include <math.h>
#include <stdlib.h>

enum { B = BLOCK_SIZE };

int block_tridiagonal_init(struct block_tridiagonal *system, int rows, struct error *err)
{
	size_t count = (size_t)rows;

	system->rows = rows;
	system->below = calloc(count, sizeof *system->below);
	system->diagonal = calloc(count, sizeof *system->diagonal);
	system->above = calloc(count, sizeof *system->above);
	system->pivots = calloc(count, sizeof *system->pivots);
	if (system->below && system->diagonal && system->above && system->pivots)
		return 0;
	return error_memory(err, 3 * count * sizeof *system->below);
}

void block_tridiagonal_clean(struct block_tridiagonal *system)
{
	free(system->below);
	free(system->diagonal);
	free(system->above);
	free(system->pivots);
	*system = (struct block_tridiagonal){0};
}

static void swap_rows(double *a, double *b)
{
	for (int j = 0; j < B; j++) {
		double kept = a[j];

		a[j] = b[j];
		b[j] = kept;
	}
}

/* LU of one block with row pivots; whole rows are exchanged, so that all exchanges come first in a
 * solution. */
static int factor(block a, int *pivots)
{
	for (int k = 0; k < B; k++) {
		int best = k;

		for (int i = k + 1; i < B; i++)
			if (fabs(a[i][k]) > fabs(a[best][k]))
				best = i;
		if (!(fabs(a[best][k]) > 0) || !isfinite(a[best][k]))
			return -1;
		pivots[k] = best;
		if (best != k)
			swap_rows(a[k], a[best]);
		a[k][k] = 1 / a[k][k];
		for (int i = k + 1; i < B; i++) {
			double times = a[i][k] *= a[k][k];

			for (int j = k + 1; j < B; j++)
				a[i][j] -= times * a[k][j];
		}
	}
	return 0;
}

/* x := a^-1 x for every column of the block x. */
static void solve_block(const block a, const int *pivots, block x)
{
	for (int k = 0; k < B; k++)
		if (pivots[k] != k)
			swap_rows(x[k], x[pivots[k]]);
	for (int k = 0; k < B; k++)
		for (int i = k + 1; i < B; i++)
			for (int j = 0; j < B; j++)
				x[i][j] -= a[i][k] * x[k][j];
	for (int k = B; k-- > 0;)
		for (int j = 0; j < B; j++) {
			for (int i = k + 1; i < B; i++)
				x[k][j] -= a[k][i] * x[i][j];
			x[k][j] *= a[k][k];
		}
}

static void solve_vector(const block a, const int *pivots, double *x)
{
	for (int k = 0; k < B; k++) {
		double kept = x[pivots[k]];

		x[pivots[k]] = x[k];
		x[k] = kept;
	}
	for (int k = 0; k < B; k++)
		for (int i = k + 1; i < B; i++)
			x[i] -= a[i][k] * x[k];
	for (int k = B; k-- > 0;) {
		for (int i = k + 1; i < B; i++)
			x[k] -= a[k][i] * x[i];
		x[k] *= a[k][k];
	}
}

/* The factored `diagonal` is that of the Schur complements, and `above` is multiplied by its inverse. */
int block_tridiagonal_factor(struct block_tridiagonal *system)
{
	for (int r = 0; r < system->rows; r++) {
		if (r > 0)
			for (int i = 0; i < B; i++)
				for (int k = 0; k < B; k++)
					for (int j = 0; j < B; j++)
						system->diagonal[r][i][j] -=
							system->below[r][i][k] * system->above[r - 1][k][j];
		if (factor(system->diagonal[r], system->pivots[r]))
			return -1;
		if (r + 1 < system->rows)
			solve_block(system->diagonal[r], system->pivots[r], system->above[r]);
	}
	return 0;
}

void block_tridiagonal_solve(const struct block_tridiagonal *system, double *x)
{
	for (int r = 0; r < system->rows; r++) {
		double *mine = x + (size_t)r * B;

		for (int i = 0; r > 0 && i < B; i++)
			for (int k = 0; k < B; k++)
				mine[i] -= system->below[r][i][k] * (mine - B)[k];
		solve_vector(system->diagonal[r], system->pivots[r], mine);
	}
	for (int r = system->rows - 1; r-- > 0;) {
		double *mine = x + (size_t)r * B;

		for (int i = 0; i < B; i++)
			for (int k = 0; k < B; k++)
				mine[i] -= system->above[r][i][k] * (mine + B)[k];
	}
}
