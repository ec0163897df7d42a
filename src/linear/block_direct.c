/* A direct solution of the symmetric operator: every column eliminated. */
#include <stdlib.h>

#include "linear/arrays.h"
#include "linear/elimination.h"
#include "linear/pressure_solver.h"

struct memory {
	struct elimination elimination;
	double *start, *right; /* columns: x before, and its residual, which elimination spoils */
	double *given;         /* columns: A x, then the correction of x */
	double *sums;          /* [groups] */
	void *block;
};

static void destroy(void *memory)
{
	struct memory *m = memory;

	if (!m)
		return;
	elimination_clean(&m->elimination);
	free(m->block);
	free(m);
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct column_layout columns = columns_make(layers, faces);
	size_t all = columns_count(&columns);
	struct memory *m = calloc(1, sizeof *m);

	(void)options;
	if (!m)
		return error_memory(err, sizeof *m);
	if (elimination_init(&m->elimination, layers, faces, err) != 0 ||
		arrays_allocate((struct arrays_part[]){ARRAY(m->start, all), ARRAY(m->right, all),
							ARRAY(m->given, all), ARRAY(m->sums, (size_t)columns.groups), {0}},
			&m->block, err) != 0) {
		destroy(m);
		return pressure_solver_too_large(block_direct.name, layers, faces, err);
	}
	*out = m;
	return 0;
}

/* x += A^-1 (b - A x): rounding is taken back where a solve begins from the last one. */
static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	struct memory *m = memory;
	const struct column_layout *columns = &m->elimination.columns;
	size_t all = columns_count(columns);
	int groups = columns->groups;

	(void)rule;
	elimination_factor(&m->elimination, system, 0, columns->faces, 0);
	columns_from_rows(columns, pressure_system_x(system, 0), system->x_stride, m->start, 0, groups);
	columns_apply(columns, system, m->start, m->given, m->sums, 0, groups);
	columns_from_rows(columns, system->rhs, (size_t)system->faces, m->right, 0, groups);
	for (size_t i = 0; i < all; i++)
		m->right[i] -= m->given[i];
	elimination_solve(&m->elimination, m->right, m->given, columns->faces, 0);
	for (size_t i = 0; i < all; i++)
		m->given[i] += m->start[i];
	columns_to_rows(columns, m->given, pressure_system_x(system, 0), system->x_stride, 0, groups);
	return 1;
}

const struct pressure_solver block_direct = {
	.name = "block-direct",
	.method = METHOD_BLOCK_DIRECT,
	.matrix_free = true,
	.symmetric_only = true,
	.create = create,
	.solve = solve,
	.free = destroy,
};
