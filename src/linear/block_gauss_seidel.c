/* The block Gauss-Seidel iteration of P1 4 (algorithm after eq. 33): one tridiagonal solve along x per
 * layer and sweep, by the Thomas algorithm, from the bottom layer to the top. */
#include <math.h>
#include <stdlib.h>

#include "linear/pressure_solver.h"

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

/* Right side of layer a with the layers below (new) and above (old) taken over. */
static void gather(const struct pressure_system *system, int a, double *restrict right)
{
	size_t row = pressure_system_row(system, a);
	const double *restrict down = pressure_system_x(system, a - 1);
	const double *restrict up = pressure_system_x(system, a + 1);
	const double *restrict rhs = system->rhs + row;
	const double *restrict bl = system->below_lower + row,
						   *restrict bd = system->below_diagonal + row,
						   *restrict bu = system->below_upper + row;
	const double *restrict al = system->above_lower + row,
						   *restrict ad = system->above_diagonal + row,
						   *restrict au = system->above_upper + row;

	for (int f = 0; f < system->faces; f++)
		right[f] = rhs[f] - (bl[f] * down[f - 1] + bd[f] * down[f] + bu[f] * down[f + 1]) -
				   (al[f] * up[f - 1] + ad[f] * up[f] + au[f] * up[f + 1]);
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

/* Put the solution of a layer in place and add its increment to the error measure of the sweep. Four
 * partial sums in a fixed order, so that the additions do not wait for each other. */
static double accept(double *restrict x, const double *restrict solution,
	const double *restrict weight, int faces, int norm, double error)
{
	double sum[4] = {0};
	int f = 0;

	if (norm == NORM_LINF) {
		for (; f < faces; f++) {
			double change = fabs(solution[f] - x[f]);

			x[f] = solution[f];
			error = change > error || isnan(change) ? change : error; /* a NaN stays */
		}
		return error;
	}
	for (; f < faces; f++) {
		double change = solution[f] - x[f];

		x[f] = solution[f];
		sum[f & 3] += weight[f] * (norm == NORM_L2 ? change * change : fabs(change));
	}
	return error + ((sum[0] + sum[1]) + (sum[2] + sum[3]));
}

static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	const struct scratch *scratch = memory;

	for (int sweep = 1; sweep <= rule->max_iterations; sweep++) {
		double error = 0;

		for (int a = 0; a < system->layers; a++) {
			gather(system, a, scratch->right);
			solve_layer(system, a, scratch->right, scratch->ratio);
			error = accept(pressure_system_x(system, a), scratch->right, system->weight,
				system->faces, rule->norm, error);
		}
		if (rule->norm == NORM_L2)
			error = sqrt(error);
		if (rule->criterion == CRITERION_RESIDUAL
				? pressure_system_residual(system) <= rule->residual
				: error < rule->tolerance)
			return sweep;
		if (isnan(error))
			return -sweep;
	}
	return -rule->max_iterations;
}

const struct pressure_solver block_gauss_seidel = {
	.name = "block-gauss-seidel",
	.create = create,
	.solve = solve,
	.free = destroy,
};
