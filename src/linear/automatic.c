/* The choice among the methods, step by step, by what the last steps cost: conjugate gradients as long
 * as they take few iterations, the direct method where they would take too many (on beds rough all over, and
 * with few layers). Cost is counted in iterations and sizes, never by a clock, so that the choice is the
 * same on every machine, and what one step leaves for the next is part of the exact state. With periodic
 * ends there are conjugate gradients alone. */
#include <stdlib.h>

#include "linear/costs.h"
#include "linear/elimination.h"
#include "linear/pressure_solver.h"

/* The direct method keeps a dense matrix per column: not beyond this much memory, and not for more layers
 * than it has rows in registers for, where it would seldom be the cheaper one. */
#define DIRECT_BYTES (256.0 * 1024 * 1024)
#define DIRECT_LAYERS (ELIMINATION_BLOCKS_KNOWN * LANES)

enum {
	SHORTEST_HOLD = 4,
	LONGEST_HOLD = 64
}; /* steps of the direct method before the next trial */

enum { HOLD, LEFT, KEPT }; /* what is kept: the length of a hold, and how much of it is left */

struct memory {
	void *gradients, *direct; /* `direct` is NULL where it would be too large */
	int limit;                /* iterations that cost as much as the direct method */
	int method;               /* chosen last, enum method_kind */
	double kept[KEPT];
};

/* Iterations of conjugate gradients that take the time of one direct solution, or a little less: what the
 * direct one takes beside elimination is not counted, since a trial that is given up is lost. */
static int affordable(int layers)
{
	double direct = costs_elimination_factor(layers) + costs_elimination_solve(layers);

	return (int)((direct - costs_gradients_start(layers)) / costs_gradients_iteration(layers));
}

static void destroy(void *memory)
{
	struct memory *m = memory;

	if (!m)
		return;
	conjugate_gradients.free(m->gradients);
	block_direct.free(m->direct);
	free(m);
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct column_layout columns = columns_make(layers, faces);
	struct memory *m = calloc(1, sizeof *m);

	if (!m)
		return error_memory(err, sizeof *m);
	m->limit = affordable(layers);
	m->method = METHOD_CONJUGATE_GRADIENTS;
	m->kept[HOLD] = SHORTEST_HOLD;
	if (conjugate_gradients.create(layers, faces, options, &m->gradients, err) != 0 ||
		(!options->periodic && layers <= DIRECT_LAYERS &&
			8.0 * layers * (double)columns.stride * faces <= DIRECT_BYTES &&
			block_direct.create(layers, faces, options, &m->direct, err) != 0)) {
		destroy(m);
		return -1;
	}
	*out = m;
	return 0;
}

/* Conjugate gradients, given up where the direct method costs less. */
static int try_gradients(
	struct memory *m, struct pressure_system *system, const struct stopping_rule *rule)
{
	struct stopping_rule trial = *rule;
	int done;

	m->method = METHOD_CONJUGATE_GRADIENTS;
	if (m->direct && trial.max_iterations > m->limit)
		trial.max_iterations = m->limit;
	done = conjugate_gradients.solve(system, &trial, m->gradients);
	if (done >= 0)
		m->kept[HOLD] = SHORTEST_HOLD;
	else if (m->direct)
		m->kept[LEFT] = m->kept[HOLD];
	return done;
}

static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	struct memory *m = memory;
	int tried = 0; /* iterations of a trial, negative */

	if (m->kept[LEFT] == 0) {
		tried = try_gradients(m, system, rule);
		if (tried >= 0 || m->kept[LEFT] == 0)
			return tried;
		m->kept[HOLD] = m->kept[HOLD] < LONGEST_HOLD ? 2 * m->kept[HOLD] : LONGEST_HOLD;
	} else {
		m->kept[LEFT]--;
	}
	m->method = METHOD_BLOCK_DIRECT;
	return block_direct.solve(system, rule, m->direct) - tried;
}

static double *kept(void *memory, size_t *count)
{
	*count = KEPT;
	return ((struct memory *)memory)->kept;
}

static int chosen(const void *memory)
{
	return ((const struct memory *)memory)->method;
}

const struct pressure_solver automatic = {
	.name = "auto",
	.method = METHOD_AUTO,
	.matrix_free = true,
	.symmetric_only = true,
	.periodic = true,
	.create = create,
	.solve = solve,
	.kept = kept,
	.chosen = chosen,
	.free = destroy,
};
