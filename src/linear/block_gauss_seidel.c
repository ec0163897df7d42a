/* The block Gauss-Seidel iteration of P1 4 (algorithm after eq. 33): one tridiagonal solve along x per
 * layer and sweep, by the Thomas algorithm, from the bottom layer to the top. */
#include <math.h>
#include <stdlib.h>

#include "linear/pressure_solver.h"

struct scratch {
	double *right; /* [faces], right side of a layer, then its forward-eliminated form */
	double *ratio; /* [faces], eliminated upper diagonal */
};

static int create(int layers, int faces, void **out, struct error *err)
{
	struct scratch *scratch = malloc(sizeof *scratch);
	size_t bytes = 2 * (size_t)faces * sizeof(double);

	(void)layers;
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

/* Thomas elimination from both ends at once towards the middle row: the same work as from one end, in
 * two independent chains that the processor overlaps. The solution replaces `right`. */
static void solve_layer(
    const struct pressure_system *system, int a, double *restrict right, double *restrict ratio)
{
	size_t row = pressure_system_row(system, a);
	const double *restrict lower = system->lower + row, *restrict diagonal = system->diagonal + row,
	                       *restrict upper = system->upper + row;
	int n = system->faces, middle = n / 2, i = 0, j = n - 1;
	double left_ratio = 0, left_value = 0, right_ratio = 0, right_value = 0, pivot;

	/* rows 0..middle-1 from the left, rows n-1..middle+1 from the right */
	for (; i < middle && j > middle; i++, j--) {
		double left_pivot = 1 / (diagonal[i] - lower[i] * left_ratio);
		double right_pivot = 1 / (diagonal[j] - upper[j] * right_ratio);

		left_value = (right[i] - lower[i] * left_value) * left_pivot;
		left_ratio = upper[i] * left_pivot;
		right_value = (right[j] - upper[j] * right_value) * right_pivot;
		right_ratio = lower[j] * right_pivot;
		right[i] = left_value;
		ratio[i] = left_ratio;
		right[j] = right_value;
		ratio[j] = right_ratio;
	}
	for (; i < middle; i++) {
		pivot = 1 / (diagonal[i] - lower[i] * left_ratio);
		left_value = right[i] = (right[i] - lower[i] * left_value) * pivot;
		left_ratio = ratio[i] = upper[i] * pivot;
	}
	for (; j > middle; j--) {
		pivot = 1 / (diagonal[j] - upper[j] * right_ratio);
		right_value = right[j] = (right[j] - upper[j] * right_value) * pivot;
		right_ratio = ratio[j] = lower[j] * pivot;
	}
	right[middle] = (right[middle] - lower[middle] * left_value - upper[middle] * right_value) /
	                (diagonal[middle] - lower[middle] * left_ratio - upper[middle] * right_ratio);
	left_value = right_value = right[middle];
	for (i = middle - 1, j = middle + 1; i >= 0 && j < n; i--, j++) {
		left_value = right[i] -= ratio[i] * left_value;
		right_value = right[j] -= ratio[j] * right_value;
	}
	for (; i >= 0; i--)
		left_value = right[i] -= ratio[i] * left_value;
	for (; j < n; j++)
		right_value = right[j] -= ratio[j] * right_value;
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
		if (error < rule->tolerance)
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
