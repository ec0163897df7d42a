#include "linear/pressure_solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

int pressure_solver_too_large(const char *name, int layers, int faces, struct error *err)
{
	return error_context(err,
		"pressure_solver.method: %s keeps a matrix for %d layers of %d cells, conjugate-gradients "
		"none",
		name, layers, faces - 1);
}

/* A right side of zeros has no scale to stop by, and needs none. */
static bool is_at_rest(struct pressure_system *system)
{
	size_t count = (size_t)system->layers * (size_t)system->faces;

	for (size_t k = 0; k < count; k++)
		if (system->rhs[k] != 0)
			return false;
	for (int a = 0; a < system->layers; a++)
		memset(pressure_system_x(system, a), 0, (size_t)system->faces * sizeof(double));
	return true;
}

int pressure_solver_solve(const struct pressure_solver *solver, struct pressure_system *system,
	const struct stopping_rule *rule, void *memory, double *residual)
{
	enum { ROUNDS = 4 };
	struct stopping_rule held = *rule;
	int total = 0;

	*residual = 0;
	if (is_at_rest(system))
		return 0;
	for (int round = 0; round < ROUNDS; round++) {
		int done = solver->solve(system, &held, memory);

		*residual = pressure_system_residual(system);
		total += abs(done);
		if (done < 0 || !isfinite(*residual))
			return total ? -total : -1;
		if (rule->criterion != CRITERION_RESIDUAL || *residual <= rule->residual)
			return total;
		held.residual *= 0.5; /* the method's own count was too good */
		held.max_iterations = rule->max_iterations > total ? rule->max_iterations - total : 1;
	}
	return -total;
}
