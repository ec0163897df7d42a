#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "linear/pressure_solver.h"

/* A diagonally dominant system whose exact solution is x(a, f) = sin(1 + a + 3 f). */
static double exact(int a, int f)
{
	return sin(1 + a + 3 * f);
}

static double entry(int a, int f, int da, int df)
{
	return da == 0 && df == 0 ? 9 + 0.1 * a : -1 + 0.05 * ((a + 2 * f + da + df) % 3);
}

static void fill(struct pressure_system *system)
{
	double *const bands[3][3] = {
		{system->below_lower, system->below_diagonal, system->below_upper},
		{system->lower, system->diagonal, system->upper},
		{system->above_lower, system->above_diagonal, system->above_upper},
	};

	for (int a = 0; a < system->layers; a++)
		for (int f = 0; f < system->faces; f++) {
			size_t k = pressure_system_row(system, a) + (size_t)f;

			for (int da = -1; da <= 1; da++)
				for (int df = -1; df <= 1; df++) {
					int up = a + da, right = f + df;

					if (up < 0 || up >= system->layers || right < 0 || right >= system->faces)
						continue;
					bands[da + 1][df + 1][k] = entry(a, f, da, df);
					system->rhs[k] += entry(a, f, da, df) * exact(up, right);
				}
		}
	for (int f = 0; f < system->faces; f++)
		system->weight[f] = 1;
}

static double distance(const struct pressure_system *system)
{
	double worst = 0;

	for (int a = 0; a < system->layers; a++)
		for (int f = 0; f < system->faces; f++)
			worst = fmax(worst, fabs(pressure_system_x(system, a)[f] - exact(a, f)));
	return worst;
}

static int solve(
	int layers, int faces, int norm, double tolerance, int most, double *error, double *residual)
{
	struct pressure_system system;
	struct error err = {0};
	struct stopping_rule rule = {CRITERION_INCREMENT, norm, tolerance, 0, most};
	struct pressure_options options = {.threads = 1};
	void *scratch = NULL;
	int done;

	assert_int_equal(pressure_system_init(&system, layers, faces, true, &err), 0);
	assert_int_equal(block_gauss_seidel.create(layers, faces, &options, &scratch, &err), 0);
	fill(&system);
	done = block_gauss_seidel.solve(&system, &rule, scratch);
	*error = distance(&system);
	*residual = pressure_system_residual(&system);
	block_gauss_seidel.free(scratch);
	pressure_system_clean(&system);
	return done;
}

static void it_finds_the_exact_solution_in_every_norm_and_size(void **state)
{
	static const struct {
		int layers, faces;
	} sizes[] = {{1, 2}, {1, 33}, {2, 3}, {5, 40}, {20, 7}, {8, 641}};

	(void)state;
	for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
		for (int norm = NORM_L1; norm <= NORM_LINF; norm++) {
			double error, residual;

			assert_true(
				solve(sizes[i].layers, sizes[i].faces, norm, 1e-13, 200, &error, &residual) > 0);
			/* the error of a contraction by at least 1/2 is at most the last increment; rounding
			 * adds some ulps of values of order 1 */
			assert_true(error < 1e-12);
			assert_true(residual < 1e-12);
		}
}

static void one_layer_is_solved_by_the_first_sweep(void **state)
{
	double error, residual;

	(void)state;
	assert_int_equal(solve(1, 50, NORM_L2, 1e-12, 10, &error, &residual), 2);
}

static void the_norms_ask_for_different_numbers_of_sweeps(void **state)
{
	double error, residual;
	int l1 = solve(8, 200, NORM_L1, 1e-6, 100, &error, &residual);
	int linf = solve(8, 200, NORM_LINF, 1e-6, 100, &error, &residual);

	(void)state;
	assert_true(
		l1 > linf); /* with weight 1 a sum over 1600 unknowns is more than its largest term */
}

static void too_few_iterations_are_told_as_a_negative_count(void **state)
{
	double error, residual;

	(void)state;
	assert_int_equal(solve(8, 40, NORM_L2, 1e-12, 3, &error, &residual), -3);
	assert_true(residual > 1e-9);
}

static void a_nan_in_the_system_is_not_convergence(void **state)
{
	struct error err = {0};

	(void)state;
	for (int norm = NORM_L1; norm <= NORM_LINF; norm++) {
		struct pressure_system system;
		struct stopping_rule rule = {CRITERION_INCREMENT, norm, 1e-6, 0, 100};
		struct pressure_options options = {.threads = 1};
		void *scratch = NULL;

		assert_int_equal(pressure_system_init(&system, 3, 9, true, &err), 0);
		assert_int_equal(block_gauss_seidel.create(3, 9, &options, &scratch, &err), 0);
		fill(&system);
		system.rhs[4] = NAN;
		assert_true(block_gauss_seidel.solve(&system, &rule, scratch) < 0);
		block_gauss_seidel.free(scratch);
		pressure_system_clean(&system);
	}
}

static void a_zero_right_side_has_residual_zero(void **state)
{
	struct pressure_system system;
	struct error err = {0};

	(void)state;
	assert_int_equal(pressure_system_init(&system, 2, 4, true, &err), 0);
	assert_true(pressure_system_residual(&system) == 0);
	pressure_system_clean(&system);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(it_finds_the_exact_solution_in_every_norm_and_size),
		cmocka_unit_test(one_layer_is_solved_by_the_first_sweep),
		cmocka_unit_test(the_norms_ask_for_different_numbers_of_sweeps),
		cmocka_unit_test(too_few_iterations_are_told_as_a_negative_count),
		cmocka_unit_test(a_nan_in_the_system_is_not_convergence),
		cmocka_unit_test(a_zero_right_side_has_residual_zero),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
