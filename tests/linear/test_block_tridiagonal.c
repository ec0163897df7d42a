/* Block-tridiagonal systems against their own residual. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "linear/block_tridiagonal.h"

enum { ROWS_MAX = 40 };

static unsigned long long seed;

/* In [-1, 1); the same on every machine. */
static double random_value(void)
{
	seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
	return (double)(seed >> 11) * 0x1p-52 - 1;
}

static void fill(block *blocks, int rows, double scale)
{
	for (int r = 0; r < rows; r++)
		for (int i = 0; i < BLOCK_SIZE; i++)
			for (int j = 0; j < BLOCK_SIZE; j++)
				blocks[r][i][j] = scale * random_value();
}

static double times(block a, const double *x, int i)
{
	double sum = 0;

	for (int j = 0; j < BLOCK_SIZE; j++)
		sum += a[i][j] * x[j];
	return sum;
}

/* Largest residual of a random system. Blocks on the diagonal are as random as the others, so that rows
 * are exchanged; their zero corner forces it. */
static double residual(int rows, double coupling)
{
	static block below[ROWS_MAX], diagonal[ROWS_MAX], above[ROWS_MAX];
	static double right[ROWS_MAX][BLOCK_SIZE], x[ROWS_MAX][BLOCK_SIZE];
	struct block_tridiagonal system;
	struct error err = {0};
	double worst = 0;

	assert_int_equal(block_tridiagonal_init(&system, rows, &err), 0);
	fill(below, rows, coupling);
	fill(diagonal, rows, 1);
	fill(above, rows, coupling);
	for (int r = 0; r < rows; r++) {
		diagonal[r][0][0] = 0;
		for (int i = 0; i < BLOCK_SIZE; i++)
			x[r][i] = right[r][i] = random_value();
	}
	memcpy(system.below, below, (size_t)rows * sizeof *below);
	memcpy(system.diagonal, diagonal, (size_t)rows * sizeof *diagonal);
	memcpy(system.above, above, (size_t)rows * sizeof *above);
	assert_int_equal(block_tridiagonal_factor(&system), 0);
	block_tridiagonal_solve(&system, x[0]);
	for (int r = 0; r < rows; r++)
		for (int i = 0; i < BLOCK_SIZE; i++) {
			double sum = times(diagonal[r], x[r], i) - right[r][i];

			sum += r > 0 ? times(below[r], x[r - 1], i) : 0;
			sum += r + 1 < rows ? times(above[r], x[r + 1], i) : 0;
			worst = fmax(worst, fabs(sum));
		}
	block_tridiagonal_clean(&system);
	return worst;
}

static void random_systems_are_solved_to_rounding(void **state)
{
	static const int rows[] = {1, 2, 3, 20, ROWS_MAX};

	(void)state;
	seed = 1;
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		for (int repeat = 0; repeat < 100; repeat++)
			/* a random 5 by 5 block has a condition number of up to some 1e5 */
			assert_true(residual(rows[i], 0.01) < 1e-9);
}

static void a_singular_or_infinite_block_is_refused(void **state)
{
	struct block_tridiagonal system;
	struct error err = {0};

	(void)state;
	assert_int_equal(block_tridiagonal_init(&system, 2, &err), 0);
	assert_int_equal(block_tridiagonal_factor(&system), -1);
	for (int i = 0; i < BLOCK_SIZE; i++)
		system.diagonal[0][i][i] = system.diagonal[1][i][i] = 1;
	system.diagonal[1][2][2] = NAN;
	assert_int_equal(block_tridiagonal_factor(&system), -1);
	block_tridiagonal_clean(&system);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(random_systems_are_solved_to_rounding),
		cmocka_unit_test(a_singular_or_infinite_block_is_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
