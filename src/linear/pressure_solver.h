/* Methods that solve a pressure system: rows of a table, one file each, with one definition of the
 * residual (pressure_system_residual) and one stopping rule. */
#ifndef TALUS_PRESSURE_SOLVER_H
#define TALUS_PRESSURE_SOLVER_H

#include "linear/pressure_system.h"
#include "talus/config.h"

/* When to stop, the same for every method. */
struct stopping_rule {
	int criterion;      /* enum criterion_kind: what is asked to be small */
	int norm;           /* enum norm_kind, of the increment of one iteration */
	double tolerance;   /* of the increment, m2/s2 */
	double residual;    /* of the true relative residual, 1 */
	int max_iterations; /* after which the method is said not to converge */
};

/* How a system is to be solved: what a config says of it. */
struct pressure_options {
	double relaxation; /* over-relaxation factor, 1; 0: chosen by the method */
	int threads;
	bool symmetric;       /* the operator */
	bool periodic;        /* the ends */
	const double *shares; /* of the layers in mean layers, [layers]; NULL: equal */
};

struct pressure_solver {
	const char *name;
	int method;          /* enum method_kind */
	bool matrix_free;    /* reads the cells of the symmetric operator, not the bands */
	bool symmetric_only; /* cannot solve another operator */
	bool periodic;       /* solves systems with periodic ends, too */
	/* Private memory for systems of this size. EX_SOFTWARE out of memory. */
	int (*create)(int layers, int faces, const struct pressure_options *options, void **out,
		struct error *err);
	/* Improve system->x until the rule holds. Returns the iterations done; negative: that many were
	 * done and the rule still did not hold. A NaN in the system is returned as not converged.
	 * Allocates nothing. */
	int (*solve)(struct pressure_system *system, const struct stopping_rule *rule, void *memory);
	/* What one solve leaves for the next, as part of the exact state; NULL: nothing. */
	double *(*kept)(void *memory, size_t *count);
	/* The method that the last solve took, enum method_kind; NULL: this one. */
	int (*chosen)(const void *memory);
	void (*free)(void *memory); /* NULL-safe */
};

extern const struct pressure_solver automatic, block_gauss_seidel, block_gauss_seidel_factored,
	red_black_line_relaxation, conjugate_gradients, block_direct, lapack_band;

/* The method that a config names; `auto` on a system that is not symmetric is a method for any system. */
const struct pressure_solver *pressure_solver_find(int method, bool symmetric);

/* The method that the last solve took, enum method_kind. */
int pressure_solver_chosen(const struct pressure_solver *solver, const void *memory);

/* Say of a method that found no memory what it is for, and which one needs less. Returns -1. */
int pressure_solver_too_large(const char *name, int layers, int faces, struct error *err);

/* Solve, and hold the method to the rule: where the true residual is asked for and the method's own count
 * of it was too good, it goes on from where it is. Returns as `solve`, with the true relative residual
 * in *residual. */
int pressure_solver_solve(const struct pressure_solver *solver, struct pressure_system *system,
	const struct stopping_rule *rule, void *memory, double *residual);

#endif
