#include "linear/sweeps.h"

#include <math.h>

void sweeps_gather(const struct pressure_system *system, int a, double *restrict right)
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

/* Four partial sums in a fixed order, so that the additions do not wait for each other. */
double sweeps_accept(const struct pressure_system *system, int a, const double *restrict solution,
	int norm, double error)
{
	double *restrict x = pressure_system_x(system, a);
	const double *restrict weight = system->weight;
	int faces = system->faces;
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

int sweeps_iterate(struct pressure_system *system, const struct stopping_rule *rule, void *memory,
	double (*sweep)(struct pressure_system *system, int norm, void *memory))
{
	for (int done = 1; done <= rule->max_iterations; done++) {
		double error = sweep(system, rule->norm, memory);

		if (rule->norm == NORM_L2)
			error = sqrt(error);
		if (rule->criterion == CRITERION_RESIDUAL
				? pressure_system_residual(system) <= rule->residual
				: error < rule->tolerance)
			return done;
		if (isnan(error))
			return -done;
	}
	return -rule->max_iterations;
}
