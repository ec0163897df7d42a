/* What parts of the methods cost, for choices that must be the same on every machine: nanoseconds per
 * unknown on a core of an AMD EPYC, fitted to 3 to 200 layers. */
#ifndef TALUS_COSTS_H
#define TALUS_COSTS_H

/* Of conjugate gradients: what goes before and after the iteration, and each iteration. */
double costs_gradients_start(int layers);
double costs_gradients_iteration(int layers);

/* Of elimination, per unknown of the columns that are eliminated. */
double costs_elimination_factor(int layers);
double costs_elimination_solve(int layers);

#endif
