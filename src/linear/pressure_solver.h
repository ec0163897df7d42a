/* Methods that solve a pressure system: rows of a table, one file each. */
#ifndef TALUS_PRESSURE_SOLVER_H
#define TALUS_PRESSURE_SOLVER_H

#include "linear/pressure_system.h"
#include "talus/config.h"

/* When to stop, the same for every method. */
struct stopping_rule {
	int norm;           /* enum norm_kind, of the increment of one iteration */
	double tolerance;   /* m2/s2 */
	int max_iterations; /* after which the method is said not to converge */
};

struct pressure_solver {
	const char *name;
	/* Scratch for systems of this size, owned by the caller. EX_SOFTWARE out of memory. */
	int (*create)(int layers, int faces, void **scratch, struct error *err);
	/* Improve system->x until the rule holds. Returns the iterations done; negative: that many were
	 * done and the rule still did not hold. A NaN in the system is returned as not converged.
	 * Allocates nothing. */
	int (*solve)(struct pressure_system *system, const struct stopping_rule *rule, void *scratch);
	void (*free)(void *scratch); /* NULL-safe */
};

extern const struct pressure_solver block_gauss_seidel;

/* The method that a config names. */
const struct pressure_solver *pressure_solver_find(int method);

#endif
