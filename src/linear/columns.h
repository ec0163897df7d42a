/* The unknowns of a pressure system by columns: all layers of a face side by side, which is how methods
 * that sweep along x or factor whole columns read them.
 *
 * A column is `stride` values, the layers bottom first and then zeros (at least one: q = 0 at the
 * surface). Columns go in groups of eight, which a kernel takes in hand at once; a sum over the
 * unknowns is kept per group and added up in their order, so that it does not depend on who did which
 * group. There are zeros up to a whole group and a little more than one column
 * beyond. */
#ifndef TALUS_COLUMNS_H
#define TALUS_COLUMNS_H

#include "base/kernel.h"
#include "linear/pressure_system.h"

struct column_layout {
	int layers, faces;
	int blocks;    /* vectors in a column */
	int groups;    /* of LANES columns */
	size_t stride; /* of a column: LANES blocks */
};

enum { COLUMNS_BLOCKS_MAX = 512 / LANES + 1 }; /* of the most layers that a config takes */

struct column_layout columns_make(int layers, int faces);

/* How many doubles an array of columns takes. */
static inline size_t columns_count(const struct column_layout *columns)
{
	return ((size_t)columns->groups * LANES + 1) * columns->stride + LANES;
}

/* Between rows of layers ([layers], `row_stride` apart) and columns, in groups [first, last). */
void columns_from_rows(const struct column_layout *columns, const double *rows, size_t row_stride,
	double *out, int first, int last);
void columns_to_rows(const struct column_layout *columns, const double *from, double *rows,
	size_t row_stride, int first, int last);

/* out = A x for a symmetric system in groups [first, last), with the sum of x out of each group in
 * `sums` [groups]. */
void columns_apply(const struct column_layout *columns, const struct pressure_system *system,
	const double *x, double *out, double *sums, int first, int last);

#endif
