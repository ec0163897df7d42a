/* What methods share that go over the layers one after the other (P1 4, algorithm after eq. 33). */
#ifndef TALUS_SWEEPS_H
#define TALUS_SWEEPS_H

#include "linear/pressure_solver.h"

/* Right side of layer a with the layers below and above taken over as they are. */
void sweeps_gather(const struct pressure_system *system, int a, double *restrict right);

/* Put the solution of a layer in place. Returns `error`, the measure of the sweep so far, with the increment
 * of this layer in the norm. */
double sweeps_accept(const struct pressure_system *system, int a, const double *restrict solution,
	int norm, double error);

/* Sweep until the rule holds. `sweep` goes over all layers once and returns the error measure that
 * sweeps_accept has added up. Returns as the solve of a method. */
int sweeps_iterate(struct pressure_system *system, const struct stopping_rule *rule, void *memory,
	double (*sweep)(struct pressure_system *system, int norm, void *memory));

#endif
