/* The block Gauss-Seidel iteration of P1 4 (algorithm after eq. 33): one tridiagonal solve along x per
 * layer and sweep, by the Thomas algorithm, from the bottom layer to the top. */
#include <stdlib.h>

#include "linear/sweeps.h"

struct scratch {
	double *right; /* [faces], right side of a layer, then its forward-eliminated form */
	double *ratio; /* [faces], eliminated upper diagonal */
};

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct scratch *scratch = malloc(sizeof *scratch);
	size_t bytes = 2 * (size_t)faces * sizeof(double);

	(void)layers;
	(void)options;
	if (!scratch)
		return error_memory(err, sizeof *scratch);
	scratch->right = malloc(bytes);
	if (!scratch->right) {
		free(scratch);
		return error_memory(err, bytes);
	}
	scratch->ratio = scratch->right + faces;
	*out = scratch;
	return 0;
}

static void destroy(void *scratch)
{
	if (scratch)
		free(((struct scratch *)scratch)->right);
	free(scratch);
}

/* The Thomas algorithm along x for layer a. The solution replaces `right`. */
static void solve_layer(
	const struct pressure_system *system, int a, double *restrict right, double *restrict ratio)
{
	size_t row = pressure_system_row(system, a);
	const double *restrict lower = system->lower + row;
	const double *restrict diagonal = system->diagonal + row;
	const double *restrict upper = system->upper + row;
	double last_ratio = 0, last = 0;

	for (int f = 0; f < system->faces; f++) {
		double pivot = diagonal[f] - lower[f] * last_ratio;

		last = right[f] = (right[f] - lower[f] * last) / pivot;
		last_ratio = ratio[f] = upper[f] / pivot;
	}
	for (int f = system->faces - 2; f >= 0; f--)
		last = right[f] -= ratio[f] * last;
}

static double sweep(struct pressure_system *system, int norm, void *memory)
{
	const struct scratch *scratch = memory;
	double error = 0;

	for (int a = 0; a < system->layers; a++) {
		sweeps_gather(system, a, scratch->right);
		solve_layer(system, a, scratch->right, scratch->ratio);
		error = sweeps_accept(system, a, scratch->right, norm, error);
	}
	return error;
}

static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	return sweeps_iterate(system, rule, memory, sweep);
}

const struct pressure_solver block_gauss_seidel = {
	.name = "block-gauss-seidel",
	.method = METHOD_BLOCK_GAUSS_SEIDEL,
	.create = create,
	.solve = solve,
	.free = destroy,
};
