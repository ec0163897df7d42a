#include "linear/pressure_solver.h"

static const struct pressure_solver *const solvers[] = {
	[METHOD_BLOCK_GAUSS_SEIDEL] = &block_gauss_seidel,
};

const struct pressure_solver *pressure_solver_find(int method)
{
	return solvers[method];
}
