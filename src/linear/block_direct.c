/* A direct solution of the symmetric operator by columns. Eliminating the columns of layers from the left
 * leaves for column f the dense matrix S_f = D_f - C_f X_{f-1} C_f^T, with X = S^-1, D_f what the column
 * does to itself and C_f what it does with the column before (both tridiagonal over the layers). X is
 * formed by Gauss-Jordan elimination, which needs no pivoting as S is positive definite, so that a solve
 * is two products with X per column. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/columns.h"
#include "linear/pressure_solver.h"

struct memory {
	struct columns columns;
	int blocks;    /* vectors in a row of X */
	size_t row;    /* LANES blocks */
	double *x;     /* [faces][layers][row]: X of each column */
	double *lower; /* [faces][row]: C_f from layer a to a - 1 of the column before */
	double *same;  /* [faces][row]: to a */
	double *upper; /* [faces][row]: to a + 1 */
	double *diagonal,
		*above;            /* [row], of D of the column at hand: itself, and with the layer above */
	double *start, *right; /* columns: x before, and its residual, which elimination turns over */
	double *given;         /* columns: X times the eliminated residual, then the correction of x */
	double *sums;          /* [groups] */
	double *block;
};

static size_t layout(struct memory *m, double *block)
{
	size_t faces = (size_t)m->columns.faces, layers = (size_t)m->columns.layers;
	size_t all = columns_count(&m->columns);
	struct {
		double **part;
		size_t count;
	} const parts[] = {{&m->x, faces * layers * m->row}, {&m->lower, faces * m->row},
		{&m->same, faces * m->row}, {&m->upper, faces * m->row}, {&m->diagonal, m->row},
		{&m->above, m->row}, {&m->start, all}, {&m->right, all}, {&m->given, all},
		{&m->sums, (size_t)m->columns.groups}};
	size_t at = 0;

	for (size_t i = 0; i < sizeof parts / sizeof *parts; at += parts[i++].count)
		*parts[i].part = block ? block + at : NULL;
	return at;
}

static void destroy(void *memory)
{
	if (memory)
		free(((struct memory *)memory)->block);
	free(memory);
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct memory *m = calloc(1, sizeof *m);
	size_t count;

	(void)options;
	if (!m)
		return error_memory(err, sizeof *m);
	m->columns = columns_make(layers, faces);
	m->blocks = (layers + LANES - 1) / LANES;
	m->row = (size_t)m->blocks * LANES;
	count = layout(m, NULL);
	m->block = calloc(count, sizeof *m->block);
	if (!m->block) {
		destroy(m);
		return error_memory(err, count * sizeof *m->block);
	}
	(void)layout(m, m->block);
	*out = m;
	return 0;
}

/* What layer a of a cell has of each product of two of its corners. With P, S, C the factors of J and D in
 * T/sqrt(h) it is P^2 + 2 P S + S^2 + C^2 (of its right lower and left upper corner with itself, and minus
 * that of the two), P^2 - 2 P S + S^2 + C^2 (of the others likewise), and P^2 - S^2 - C^2 of a lower with
 * the upper one of the same side, and minus that along x. */
struct corners {
	v8 plus[COLUMNS_BLOCKS_MAX], minus[COLUMNS_BLOCKS_MAX], apart[COLUMNS_BLOCKS_MAX];
};

KERNEL_PART void fill_corners(
	const struct pressure_cells *cells, int i, int layers, struct corners *out, int blocks)
{
	double pp = cells->stretch[i], lean = cells->lean[i], tilt = cells->tilt[i];

	for (int k = 0; k < blocks; k++) {
		v8 a = v8_numbers(k), s = lean * a + tilt, inside = V8_WHERE(a < (double)layers);
		v8 twice = 2 * cells->cross * s;
		v8 square = (s * s + cells->quarter_nn) * cells->inverse[i];

		out->plus[k] = inside * (pp + twice + square);
		out->minus[k] = inside * (pp - twice + square);
		out->apart[k] = inside * (pp - square);
	}
}

/* C_f, and of D_f the diagonal and the coupling to the layer above, from the cells on both sides. */
KERNEL_PART void fill_column(struct memory *m, const bool *dry, int f, const struct corners *left,
	const struct corners *right, int blocks)
{
	size_t at = (size_t)f * (size_t)blocks * LANES;
	double wet = !dry[f], coupled = f > 0 && !dry[f] && !dry[f - 1];
	int n = m->columns.layers;

	for (int k = 0; k < blocks; k++, at += LANES) {
		v8 a = v8_numbers(k), inside = coupled * V8_WHERE(a < (double)n);
		v8 below_top = coupled * V8_WHERE(a < (double)(n - 1)); /* q = 0 at the surface */
		v8 diagonal =
			left->plus[k] + v8_before(left->minus, k) + right->minus[k] + v8_before(right->plus, k);

		v8_store(m->diagonal + v8_at(k), wet * diagonal + (1 - wet));
		v8_store(m->above + v8_at(k), wet * (left->apart[k] + right->apart[k]));
		v8_store(m->same + at, -inside * (left->apart[k] + v8_before(left->apart, k)));
		v8_store(m->upper + at, -below_top * left->plus[k]);
		v8_store(m->lower + at, -inside * v8_before(left->minus, k));
	}
}

/* Add D_f to the matrix of column f. */
static void add_diagonal(const struct memory *m, double *x)
{
	int n = m->columns.layers;

	for (int a = 0; a < n; a++, x += m->row) {
		x[a] += m->diagonal[a];
		if (a + 1 < n) {
			x[a + 1] += m->above[a];
			x[m->row + (size_t)a] += m->above[a];
		}
	}
}

/* x = -C y C^T, with y the X of the column before. */
KERNEL_PART void take_out(struct memory *m, int f, const double *y, double *x, int blocks)
{
	size_t row = (size_t)blocks * LANES, at = (size_t)f * row;
	int n = m->columns.layers;

	for (int a = 0; a < n; a++) {
		const double *here = y + (size_t)a * row;
		const double *below = a > 0 ? here - row : here, *above = a + 1 < n ? here + row : here;
		double lower = m->lower[at + (size_t)a], same = m->same[at + (size_t)a];
		double upper = m->upper[at + (size_t)a], *to = x + (size_t)a * row;
		v8 product[COLUMNS_BLOCKS_MAX];

		for (int k = 0; k < blocks; k++)
			product[k] = lower * v8_load(below + v8_at(k)) + same * v8_load(here + v8_at(k)) +
						 upper * v8_load(above + v8_at(k));
		for (int k = 0; k < blocks; k++)
			v8_store(to + v8_at(k),
				(v8){0} - (v8_before(product, k) * v8_load(m->lower + at + v8_at(k)) +
							  product[k] * v8_load(m->same + at + v8_at(k)) +
							  v8_after(product, k, blocks) * v8_load(m->upper + at + v8_at(k))));
	}
}

/* What one elimination needs of its one or two pivots. */
struct pivots {
	v8 first[COLUMNS_BLOCKS_MAX], second[COLUMNS_BLOCKS_MAX]; /* their rows of the inverse */
	v8 kept[COLUMNS_BLOCKS_MAX];                              /* 0 in their columns, else 1 */
};

/* Rows p and p + 1 of the matrix into those of the inverse. */
KERNEL_PART void take_pivots(struct pivots *pivots, double *x, int p, int blocks)
{
	double *one = x + (size_t)p * (size_t)blocks * LANES, *two = one + (size_t)blocks * LANES;
	double a = one[p], b = one[p + 1], c = two[p + 1], scale = 1 / (a * c - b * b);
	double aa = c * scale, ab = -b * scale, bb = a * scale;

	for (int k = 0; k < blocks; k++) {
		v8 is_first = V8_WHERE(v8_numbers(k) == p), is_second = V8_WHERE(v8_numbers(k) == p + 1);
		v8 kept = 1 - (is_first + is_second);
		v8 r = v8_load(one + v8_at(k)) * kept + is_first;
		v8 q = v8_load(two + v8_at(k)) * kept + is_second;

		pivots->kept[k] = kept;
		pivots->first[k] = aa * r + ab * q;
		pivots->second[k] = ab * r + bb * q;
	}
}

/* One pivot, the last of an odd number. */
KERNEL_PART void take_pivot(struct pivots *pivots, double *x, int p, int blocks)
{
	double *one = x + (size_t)p * (size_t)blocks * LANES, scale = 1 / one[p];

	for (int k = 0; k < blocks; k++) {
		v8 is_first = V8_WHERE(v8_numbers(k) == p);

		pivots->kept[k] = 1 - is_first;
		pivots->first[k] = scale * (v8_load(one + v8_at(k)) * pivots->kept[k] + is_first);
	}
}

/* The inverse of a positive definite matrix in place, two rows at a time. */
KERNEL_PART void invert(double *x, int n, int blocks)
{
	size_t row = (size_t)blocks * LANES;
	struct pivots pivots;

	for (int p = 0; p + 1 < n; p += 2) {
		take_pivots(&pivots, x, p, blocks);
		for (int i = 2; i < n; i++) { /* the next pivots first: they are waited for */
			double *to = x + (size_t)(p + i < n ? p + i : p + i - n) * row;
			double f = to[p], g = to[p + 1];

			for (int k = 0; k < blocks; k++)
				v8_store(to + v8_at(k), v8_load(to + v8_at(k)) * pivots.kept[k] -
											f * pivots.first[k] - g * pivots.second[k]);
		}
		for (int k = 0; k < blocks; k++) {
			v8_store(x + (size_t)p * row + v8_at(k), pivots.first[k]);
			v8_store(x + (size_t)(p + 1) * row + v8_at(k), pivots.second[k]);
		}
	}
	if (n % 2 == 0)
		return;
	take_pivot(&pivots, x, n - 1, blocks);
	for (int a = 0; a + 1 < n; a++) {
		double *to = x + (size_t)a * row, f = to[n - 1];

		for (int k = 0; k < blocks; k++)
			v8_store(to + v8_at(k), v8_load(to + v8_at(k)) * pivots.kept[k] - f * pivots.first[k]);
	}
	for (int k = 0; k < blocks; k++)
		v8_store(x + (size_t)(n - 1) * row + v8_at(k), pivots.first[k]);
}

KERNEL_PART void factor_blocks(struct memory *m, const struct pressure_system *system, int blocks)
{
	int n = m->columns.layers;
	size_t square = (size_t)n * m->row;
	struct corners left, right;

	fill_corners(&system->cells, 0, n, &left, blocks);
	for (int f = 0; f < m->columns.faces; f++) {
		double *x = m->x + (size_t)f * square;

		fill_corners(&system->cells, f + 1, n, &right, blocks);
		fill_column(m, system->cells.dry, f, &left, &right, blocks);
		if (f > 0)
			take_out(m, f, x - square, x, blocks);
		else
			memset(x, 0, square * sizeof *x);
		add_diagonal(m, x);
		invert(x, n, blocks);
		for (int k = 0; k < blocks; k++) {
			left.plus[k] = right.plus[k];
			left.minus[k] = right.minus[k];
			left.apart[k] = right.apart[k];
		}
	}
}

/* X v, with v of which the vectors are in memory. */
KERNEL_PART void multiply(const double *x, const double *v, v8 *out, int n, int blocks)
{
	size_t row = (size_t)blocks * LANES;

	for (int k = 0; k < blocks; k++)
		out[k] = (v8){0};
	for (int a = 0; a < n; a++)
		for (int k = 0; k < blocks; k++)
			out[k] += v[a] * v8_load(x + (size_t)a * row + v8_at(k));
}

/* Right side less C times the column before, and X times that. */
KERNEL_PART void eliminate(struct memory *m, int f, int blocks)
{
	size_t at = (size_t)f * m->row, square = (size_t)m->columns.layers * m->row;
	double *right = m->right + (size_t)f * m->columns.stride;
	double *given = m->given + (size_t)f * m->columns.stride;
	v8 before[COLUMNS_BLOCKS_MAX], product[COLUMNS_BLOCKS_MAX];

	for (int k = 0; k < blocks; k++)
		before[k] = f > 0 ? v8_load(given - m->columns.stride + v8_at(k)) : (v8){0};
	for (int k = 0; k < blocks; k++)
		v8_store(right + v8_at(k),
			v8_load(right + v8_at(k)) -
				(v8_before(before, k) * v8_load(m->lower + at + v8_at(k)) +
					before[k] * v8_load(m->same + at + v8_at(k)) +
					v8_after(before, k, blocks) * v8_load(m->upper + at + v8_at(k))));
	multiply(m->x + (size_t)f * square, right, product, m->columns.layers, blocks);
	for (int k = 0; k < blocks; k++)
		v8_store(given + v8_at(k), product[k]);
}

/* From the solution of column f that of the one before, which loses X C^T times it. */
KERNEL_PART void substitute(struct memory *m, int f, int blocks)
{
	size_t at = (size_t)f * m->row, square = (size_t)m->columns.layers * m->row;
	double *here = m->given + (size_t)f * m->columns.stride, *before = here - m->columns.stride;
	v8 lower[COLUMNS_BLOCKS_MAX], upper[COLUMNS_BLOCKS_MAX], product[COLUMNS_BLOCKS_MAX];
	double *back = m->right + (size_t)f * m->columns.stride; /* not needed any more */

	for (int k = 0; k < blocks; k++) {
		lower[k] = v8_load(m->lower + at + v8_at(k)) * v8_load(here + v8_at(k));
		upper[k] = v8_load(m->upper + at + v8_at(k)) * v8_load(here + v8_at(k));
	}
	for (int k = 0; k < blocks; k++)
		v8_store(back + v8_at(k), v8_after(lower, k, blocks) + v8_before(upper, k) +
									  v8_load(m->same + at + v8_at(k)) * v8_load(here + v8_at(k)));
	multiply(m->x + (size_t)(f - 1) * square, back, product, m->columns.layers, blocks);
	for (int k = 0; k < blocks; k++)
		v8_store(before + v8_at(k), v8_load(before + v8_at(k)) - product[k]);
}

KERNEL_PART void solve_blocks(struct memory *m, int blocks)
{
	int last = m->columns.faces - 1;

	for (int f = 0; f <= last; f++)
		eliminate(m, f, blocks);
	for (int f = last; f > 0; f--)
		substitute(m, f, blocks);
}

/* The usual numbers of blocks are known when compiled, so that a row stays in registers. */
#define BY_BLOCKS(call, count)                                                                     \
	switch (count) {                                                                               \
	case 1:                                                                                        \
		call(1);                                                                                   \
		break;                                                                                     \
	case 2:                                                                                        \
		call(2);                                                                                   \
		break;                                                                                     \
	case 3:                                                                                        \
		call(3);                                                                                   \
		break;                                                                                     \
	case 5:                                                                                        \
		call(5);                                                                                   \
		break;                                                                                     \
	default:                                                                                       \
		call(count);                                                                               \
	}

KERNEL static void factor(struct memory *m, const struct pressure_system *system){
#define FACTOR(count) factor_blocks(m, system, count)
	BY_BLOCKS(FACTOR, m->blocks)}

KERNEL static void sweep(struct memory *m)
{
#define SOLVE(count) solve_blocks(m, count)
	BY_BLOCKS(SOLVE, m->blocks)
}

/* x += A^-1 (b - A x): rounding is taken back where a solve begins from the last one. */
static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	struct memory *m = memory;
	size_t all = columns_count(&m->columns);
	int groups = m->columns.groups;

	(void)rule;
	factor(m, system);
	columns_from_rows(
		&m->columns, pressure_system_x(system, 0), system->x_stride, m->start, 0, groups);
	columns_apply(&m->columns, system, m->start, m->given, m->sums, 0, groups);
	columns_from_rows(&m->columns, system->rhs, (size_t)system->faces, m->right, 0, groups);
	for (size_t i = 0; i < all; i++)
		m->right[i] -= m->given[i];
	sweep(m);
	for (size_t i = 0; i < all; i++)
		m->given[i] += m->start[i];
	columns_to_rows(
		&m->columns, m->given, pressure_system_x(system, 0), system->x_stride, 0, groups);
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
