#include "linear/elimination.h"

#include <stdlib.h>
#include <string.h>

#include "linear/arrays.h"

int elimination_init(struct elimination *e, int layers, int room, struct error *err)
{
	int blocks = elimination_blocks(layers);
	size_t row = (size_t)blocks * LANES, rows = (size_t)room * row;

	*e = (struct elimination){.columns = columns_make(layers, room), .blocks = blocks, .row = row};
	return arrays_allocate((struct arrays_part[]){ARRAY(e->x, rows * (size_t)layers),
							   ARRAY(e->lower, rows), ARRAY(e->same, rows), ARRAY(e->upper, rows),
							   ARRAY(e->diagonal, row), ARRAY(e->above, row), {0}},
		&e->memory, err);
}

void elimination_clean(struct elimination *e)
{
	free(e->memory);
	*e = (struct elimination){0};
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
		v8 inside = V8_WHERE(v8_numbers(k) < (double)layers);
		v8 s = lean * v8_load(cells->place + v8_at(k)) + tilt, twice = 2 * cells->cross * s;
		v8 thin = v8_load(cells->thin + v8_at(k)), along = pp * v8_load(cells->share + v8_at(k));
		v8 square = (s * s + cells->quarter_nn) * (thin * cells->inverse[i]);

		out->plus[k] = inside * (along + twice + square);
		out->minus[k] = inside * (along - twice + square);
		out->apart[k] = inside * (along - square);
	}
}

/* C_f, kept as column c, and of D_f the diagonal and the coupling to the layer above, from the cells on both sides. */
KERNEL_PART void fill_column(struct elimination *e, const bool *dry, int f, int c,
	const struct corners *left, const struct corners *right, int blocks)
{
	size_t at = (size_t)c * (size_t)blocks * LANES;
	double wet = !dry[f], coupled = f > 0 && !dry[f] && !dry[f - 1];
	int n = e->columns.layers;

	for (int k = 0; k < blocks; k++, at += LANES) {
		v8 a = v8_numbers(k), inside = coupled * V8_WHERE(a < (double)n);
		v8 below_top = coupled * V8_WHERE(a < (double)(n - 1)); /* q = 0 at the surface */
		v8 diagonal =
			left->plus[k] + v8_before(left->minus, k) + right->minus[k] + v8_before(right->plus, k);

		v8_store(e->diagonal + v8_at(k), wet * diagonal + (1 - wet));
		v8_store(e->above + v8_at(k), wet * (left->apart[k] + right->apart[k]));
		v8_store(e->same + at, -inside * (left->apart[k] + v8_before(left->apart, k)));
		v8_store(e->upper + at, -below_top * left->plus[k]);
		v8_store(e->lower + at, -inside * v8_before(left->minus, k));
	}
}

/* Add D_f to the matrix of column f. */
static void add_diagonal(const struct elimination *e, double *x)
{
	int n = e->columns.layers;

	for (int a = 0; a < n; a++, x += e->row) {
		x[a] += e->diagonal[a];
		if (a + 1 < n) {
			x[a + 1] += e->above[a];
			x[e->row + (size_t)a] += e->above[a];
		}
	}
}

/* x = -C y C^T, with y the X of the column before. */
KERNEL_PART void take_out(struct elimination *e, int c, const double *y, double *x, int blocks)
{
	size_t row = (size_t)blocks * LANES, at = (size_t)c * row;
	int n = e->columns.layers;

	for (int a = 0; a < n; a++) {
		const double *here = y + (size_t)a * row;
		const double *below = a > 0 ? here - row : here, *above = a + 1 < n ? here + row : here;
		double lower = e->lower[at + (size_t)a], same = e->same[at + (size_t)a];
		double upper = e->upper[at + (size_t)a], *to = x + (size_t)a * row;
		v8 product[COLUMNS_BLOCKS_MAX];

		for (int k = 0; k < blocks; k++)
			product[k] = lower * v8_load(below + v8_at(k)) + same * v8_load(here + v8_at(k)) +
						 upper * v8_load(above + v8_at(k));
		for (int k = 0; k < blocks; k++)
			v8_store(to + v8_at(k),
				(v8){0} - (v8_before(product, k) * v8_load(e->lower + at + v8_at(k)) +
							  product[k] * v8_load(e->same + at + v8_at(k)) +
							  v8_after(product, k, blocks) * v8_load(e->upper + at + v8_at(k))));
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

KERNEL_PART void factor_blocks(
	struct elimination *e, const struct pressure_system *system, int first, int count, int blocks)
{
	int n = e->columns.layers;
	size_t square = (size_t)n * e->row;
	struct corners left, right;

	fill_corners(&system->cells, first, n, &left, blocks);
	for (int c = 0; c < count; c++) {
		double *x = e->x + (size_t)c * square;

		fill_corners(&system->cells, first + c + 1, n, &right, blocks);
		fill_column(e, system->cells.dry, first + c, c, &left, &right, blocks);
		if (c > 0)
			take_out(e, c, x - square, x, blocks);
		else
			memset(x, 0, square * sizeof *x);
		add_diagonal(e, x);
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
KERNEL_PART void eliminate(
	const struct elimination *e, double *right, double *solution, int c, int blocks)
{
	size_t at = (size_t)c * e->row, square = (size_t)e->columns.layers * e->row;
	v8 before[COLUMNS_BLOCKS_MAX], product[COLUMNS_BLOCKS_MAX];

	right += (size_t)c * e->columns.stride;
	solution += (size_t)c * e->columns.stride;
	for (int k = 0; k < blocks; k++)
		before[k] = c > 0 ? v8_load(solution - e->columns.stride + v8_at(k)) : (v8){0};
	for (int k = 0; k < blocks; k++)
		v8_store(right + v8_at(k),
			v8_load(right + v8_at(k)) -
				(v8_before(before, k) * v8_load(e->lower + at + v8_at(k)) +
					before[k] * v8_load(e->same + at + v8_at(k)) +
					v8_after(before, k, blocks) * v8_load(e->upper + at + v8_at(k))));
	multiply(e->x + (size_t)c * square, right, product, e->columns.layers, blocks);
	for (int k = 0; k < blocks; k++)
		v8_store(solution + v8_at(k), product[k]);
}

/* From the solution of column c that of the one before, which loses X C^T times it. */
KERNEL_PART void substitute(
	const struct elimination *e, double *right, double *solution, int c, int blocks)
{
	size_t at = (size_t)c * e->row, square = (size_t)e->columns.layers * e->row;
	double *here = solution + (size_t)c * e->columns.stride, *before = here - e->columns.stride;
	v8 lower[COLUMNS_BLOCKS_MAX], upper[COLUMNS_BLOCKS_MAX], product[COLUMNS_BLOCKS_MAX];
	double *back = right + (size_t)c * e->columns.stride; /* not needed any more */

	for (int k = 0; k < blocks; k++) {
		lower[k] = v8_load(e->lower + at + v8_at(k)) * v8_load(here + v8_at(k));
		upper[k] = v8_load(e->upper + at + v8_at(k)) * v8_load(here + v8_at(k));
	}
	for (int k = 0; k < blocks; k++)
		v8_store(back + v8_at(k), v8_after(lower, k, blocks) + v8_before(upper, k) +
									  v8_load(e->same + at + v8_at(k)) * v8_load(here + v8_at(k)));
	multiply(e->x + (size_t)(c - 1) * square, back, product, e->columns.layers, blocks);
	for (int k = 0; k < blocks; k++)
		v8_store(before + v8_at(k), v8_load(before + v8_at(k)) - product[k]);
}

KERNEL_PART void solve_blocks(
	const struct elimination *e, double *right, double *solution, int count, int blocks)
{
	for (int c = 0; c < count; c++)
		eliminate(e, right, solution, c, blocks);
	for (int c = count - 1; c > 0; c--)
		substitute(e, right, solution, c, blocks);
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
	case 4:                                                                                        \
		call(4);                                                                                   \
		break;                                                                                     \
	case ELIMINATION_BLOCKS_KNOWN:                                                                 \
		call(ELIMINATION_BLOCKS_KNOWN);                                                            \
		break;                                                                                     \
	default:                                                                                       \
		call(count);                                                                               \
	}

KERNEL static void factor(
	struct elimination *e, const struct pressure_system *system, int first, int count){
#define FACTOR(blocks) factor_blocks(e, system, first, count, blocks)
	BY_BLOCKS(FACTOR, e->blocks)}

KERNEL static void solve(const struct elimination *e, double *right, double *solution, int count)
{
#define SOLVE(blocks) solve_blocks(e, right, solution, count, blocks)
	BY_BLOCKS(SOLVE, e->blocks)
}

/* The columns from `at` on. */
static struct elimination from(const struct elimination *e, int at)
{
	size_t rows = (size_t)at * e->row;
	struct elimination part = *e;

	part.x += rows * (size_t)e->columns.layers;
	part.lower += rows;
	part.same += rows;
	part.upper += rows;
	return part;
}

void elimination_factor(
	struct elimination *e, const struct pressure_system *system, int first, int count, int at)
{
	struct elimination part = from(e, at);

	factor(&part, system, first, count);
}

void elimination_solve(
	const struct elimination *e, double *right, double *solution, int count, int at)
{
	const struct elimination part = from(e, at);

	solve(&part, right, solution, count);
}
