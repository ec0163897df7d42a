#include "linear/columns.h"

#include <string.h>

struct column_layout columns_make(int layers, int faces)
{
	int blocks = layers / LANES + 1; /* room for at least one zero */

	return (struct column_layout){.layers = layers,
		.faces = faces,
		.blocks = blocks,
		.groups = (faces + LANES - 1) / LANES,
		.stride = (size_t)blocks * LANES};
}

/* The columns of a group that exist. */
static int group_width(const struct column_layout *columns, int group)
{
	int left = columns->faces - group * LANES;

	return left < LANES ? left : LANES;
}

KERNEL void columns_from_rows(const struct column_layout *columns, const double *rows,
	size_t row_stride, double *out, int first, int last)
{
	for (int g = first; g < last; g++) {
		int width = group_width(columns, g);
		double *to = out + (size_t)g * LANES * columns->stride;
		const double *from = rows + (size_t)g * LANES;

		for (int c = 0; c < width; c++)
			for (int a = 0; a < columns->layers; a++)
				to[(size_t)c * columns->stride + (size_t)a] =
					from[(size_t)a * row_stride + (size_t)c];
	}
}

KERNEL void columns_to_rows(const struct column_layout *columns, const double *from, double *rows,
	size_t row_stride, int first, int last)
{
	for (int g = first; g < last; g++) {
		int width = group_width(columns, g);
		const double *in = from + (size_t)g * LANES * columns->stride;
		double *to = rows + (size_t)g * LANES;

		for (int a = 0; a < columns->layers; a++)
			for (int c = 0; c < width; c++)
				to[(size_t)a * row_stride + (size_t)c] =
					in[(size_t)c * columns->stride + (size_t)a];
	}
}

/* What a cell gives to the columns on both sides, per layer: g - e and g + e. */
struct terms {
	v8 low[COLUMNS_BLOCKS_MAX], high[COLUMNS_BLOCKS_MAX];
};

/* The terms of cell i, between columns `l` and `r`. */
KERNEL_PART void cell_terms(const struct pressure_cells *cells, int i, const double *l,
	const double *r, struct terms *out, int blocks)
{
	double stretch = cells->stretch[i], lean = cells->lean[i], inverse = cells->inverse[i];
	double tilt = cells->tilt[i];

	for (int k = 0; k < blocks; k++, l += LANES, r += LANES) {
		v8 s = lean * v8_load(cells->place + v8_at(k)) + tilt, cs = cells->cross * s;
		v8 share = v8_load(cells->share + v8_at(k)), thin = v8_load(cells->thin + v8_at(k));
		v8 l0 = v8_load(l), l1 = v8_load(l + 1), r0 = v8_load(r), r1 = v8_load(r + 1);
		v8 jump = (l0 + l1) - (r0 + r1), difference = (l1 + r1) - (l0 + r0);
		v8 g = share * stretch * jump + cs * difference;
		v8 e = cs * jump + (s * s + cells->quarter_nn) * (thin * inverse) * difference;

		out->low[k] = g - e;
		out->high[k] = g + e;
	}
}

/* What the cells to the left and to the right give to a column; returns its product with x, by lanes. */
KERNEL_PART v8 gather(const struct terms *left, const struct terms *right, const double *x,
	double *out, int blocks, v8 surface)
{
	v8 sum = {0};

	for (int k = 0; k < blocks; k++) {
		v8 from_right = right->low[k] + v8_before(right->high, k);
		v8 value = from_right - (left->high[k] + v8_before(left->low, k));

		if (k + 1 == blocks)
			value *= surface; /* nothing above it */
		sum += value * v8_load(x + v8_at(k));
		v8_store(out + v8_at(k), value);
	}
	return sum;
}

KERNEL_PART void apply(const struct column_layout *columns, const struct pressure_system *system,
	const double *x, double *out, double *sums, int first, int last, int blocks)
{
	const struct pressure_cells *cells = &system->cells;
	size_t stride = (size_t)blocks * LANES;
	struct terms terms[2], *left = &terms[0], *right = &terms[1];
	int f = first * LANES, rest = columns->layers % LANES;
	v8 surface;

	for (int lane = 0; lane < LANES; lane++)
		surface[lane] = lane < rest;
	for (int k = 0; k < blocks; k++)
		left->low[k] = left->high[k] = (v8){0};
	if (f > 0)
		cell_terms(cells, f, x + (size_t)(f - 1) * stride, x + (size_t)f * stride, left, blocks);
	for (int g = first; g < last; g++) {
		int end = g * LANES + group_width(columns, g);
		v8 sum = {0};

		for (; f < end; f++) {
			const double *here = x + (size_t)f * stride;
			struct terms *const done = left;

			/* the ghost cell behind the last column has zeros for its five numbers */
			cell_terms(cells, f + 1, here, here + stride, right, blocks);
			if (cells->dry[f])
				memset(out + (size_t)f * stride, 0, stride * sizeof *out);
			else
				sum += gather(left, right, here, out + (size_t)f * stride, blocks, surface);
			left = right;
			right = done;
		}
		sums[g] = v8_sum(sum);
	}
}

/* The usual numbers of blocks are known when compiled, so that a column stays in registers. */
KERNEL void columns_apply(const struct column_layout *columns, const struct pressure_system *system,
	const double *x, double *out, double *sums, int first, int last)
{
	switch (columns->blocks) {
	case 1:
		apply(columns, system, x, out, sums, first, last, 1);
		break;
	case 2:
		apply(columns, system, x, out, sums, first, last, 2);
		break;
	case 3:
		apply(columns, system, x, out, sums, first, last, 3);
		break;
	default:
		apply(columns, system, x, out, sums, first, last, columns->blocks);
	}
}
