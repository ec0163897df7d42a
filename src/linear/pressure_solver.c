#include "linear/pressure_solver.h"

#include <math.h>
#include <stdlib.h>

static const struct pressure_solver *const solvers[] = {
	[METHOD_AUTO] = &automatic,
	[METHOD_BLOCK_GAUSS_SEIDEL] = &block_gauss_seidel,
	[METHOD_BLOCK_GAUSS_SEIDEL_FACTORED] = &block_gauss_seidel_factored,
	[METHOD_RED_BLACK_LINE_RELAXATION] = &red_black_line_relaxation,
	[METHOD_CONJUGATE_GRADIENTS] = &conjugate_gradients,
	[METHOD_BLOCK_DIRECT] = &block_direct,
	[METHOD_LAPACK_BAND] = &lapack_band,
};

const struct pressure_solver *pressure_solver_find(int method, bool symmetric)
{
	if (method == METHOD_AUTO && !symmetric)
		method = METHOD_BLOCK_GAUSS_SEIDEL_FACTORED;
	return solvers[method];
}

int pressure_solver_chosen(const struct pressure_solver *solver, const void *memory)
{
	return solver->chosen ? solver->chosen(memory) : solver->method;
}

int pressure_solver_solve(const struct pressure_solver *solver, struct pressure_system *system,
	const struct stopping_rule *rule, void *memory, double *residual)
{
	enum { ROUNDS = 4 };
	int total = 0;

	for (int round = 0; round < ROUNDS; round++) {
		int done = solver->solve(system, rule, memory);

		*residual = pressure_system_residual(system);
		total += abs(done);
		if (done < 0 || !isfinite(*residual))
			return -total;
		if (rule->criterion != CRITERION_RESIDUAL || *residual <= rule->residual)
			return total;
	}
	return -total;
}
