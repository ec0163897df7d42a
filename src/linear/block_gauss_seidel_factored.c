/* The block Gauss-Seidel iteration of P1 4 with its tridiagonal blocks factored once per system: the
 * iterates of block_gauss_seidel.c up to rounding, without its divisions. */
#include <stdlib.h>

#include "linear/arrays.h"
#include "linear/sweeps.h"

/* Of every row, [layers][faces] like the bands: 1/pivot, lower/pivot and upper/pivot. */
struct factors {
	double *inverse, *multiplier, *ratio;
	double *right; /* [faces], right side of a layer, then its solution */
	void *block;
};

static void destroy(void *factors)
{
	if (factors)
		free(((struct factors *)factors)->block);
	free(factors);
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct factors *factors = calloc(1, sizeof *factors);
	size_t count = (size_t)layers * (size_t)faces;

	(void)options;
	if (!factors)
		return error_memory(err, sizeof *factors);
	if (arrays_allocate((struct arrays_part[]){ARRAY(factors->inverse, count),
							ARRAY(factors->multiplier, count), ARRAY(factors->ratio, count),
							ARRAY(factors->right, (size_t)faces), {0}},
			&factors->block, err) != 0) {
		destroy(factors);
		return -1;
	}
	*out = factors;
	return 0;
}

static void factor_layer(const struct pressure_system *system, int a, const struct factors *factors)
{
	size_t row = pressure_system_row(system, a);
	const double *restrict lower = system->lower + row;
	const double *restrict diagonal = system->diagonal + row;
	const double *restrict upper = system->upper + row;
	double ratio = 0;

	for (size_t f = 0; f < (size_t)system->faces; f++) {
		double inverse = 1 / (diagonal[f] - lower[f] * ratio);

		ratio = upper[f] * inverse;
		factors->inverse[row + f] = inverse;
		factors->multiplier[row + f] = lower[f] * inverse;
		factors->ratio[row + f] = ratio;
	}
}

/* Along x for layer a. The solution replaces the right side. */
static void solve_layer(const struct pressure_system *system, int a, const struct factors *factors)
{
	size_t row = pressure_system_row(system, a);
	const double *restrict inverse = factors->inverse + row;
	const double *restrict multiplier = factors->multiplier + row;
	const double *restrict ratio = factors->ratio + row;
	double *restrict right = factors->right;
	double last = 0;

	for (int f = 0; f < system->faces; f++)
		last = right[f] = right[f] * inverse[f] - multiplier[f] * last;
	for (int f = system->faces - 2; f >= 0; f--)
		last = right[f] -= ratio[f] * last;
}

static double sweep(struct pressure_system *system, int norm, void *memory)
{
	const struct factors *factors = memory;
	double error = 0;

	for (int a = 0; a < system->layers; a++) {
		sweeps_gather(system, a, factors->right);
		solve_layer(system, a, factors);
		error = sweeps_accept(system, a, factors->right, norm, error);
	}
	return error;
}

static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	for (int a = 0; a < system->layers; a++)
		factor_layer(system, a, memory);
	return sweeps_iterate(system, rule, memory, sweep);
}

const struct pressure_solver block_gauss_seidel_factored = {
	.name = "block-gauss-seidel-factored",
	.method = METHOD_BLOCK_GAUSS_SEIDEL_FACTORED,
	.create = create,
	.solve = solve,
	.free = destroy,
};
