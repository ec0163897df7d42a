#include "linear/columns.h"

#include <string.h>

struct columns columns_make(int layers, int faces)
{
	int blocks = layers / LANES + 1; /* room for at least one zero */

	return (struct columns){.layers = layers,
		.faces = faces,
		.blocks = blocks,
		.groups = (faces + LANES - 1) / LANES,
		.stride = (size_t)blocks * LANES};
}

/* The columns of a group that exist. */
static int group_width(const struct columns *columns, int group)
{
	int left = columns->faces - group * LANES;

	return left < LANES ? left : LANES;
}

KERNEL void columns_from_rows(const struct columns *columns, const double *rows, size_t row_stride,
	double *out, int first, int last)
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

KERNEL void columns_to_rows(const struct columns *columns, const double *from, double *rows,
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

/* The terms g - e (low) and g + e (high) of cell i, between columns `l` and `r`, for all layers. */
KERNEL_PART void cell_terms(const struct columns *columns, const struct pressure_cells *cells,
	int i, const double *l, const double *r, double *low, double *high)
{
	static const v8 count = {0, 1, 2, 3, 4, 5, 6, 7};
	double stretch = cells->stretch[i], lean = cells->lean[i], inverse = cells->inverse[i];

	for (int k = 0; k < columns->blocks; k++) {
		v8 s = lean * (count + (double)(k * LANES)) + cells->tilt[i];
		v8 l0 = v8_load(l + k * LANES), l1 = v8_load(l + k * LANES + 1);
		v8 r0 = v8_load(r + k * LANES), r1 = v8_load(r + k * LANES + 1);
		v8 jump = (l0 + l1) - (r0 + r1), difference = (l1 + r1) - (l0 + r0);
		v8 cs = cells->cross * s;
		v8 g = stretch * jump + cs * difference;
		v8 e = cs * jump + (s * s + cells->quarter_nn) * inverse * difference;

		v8_store(low + k * LANES, g - e);
		v8_store(high + k * LANES, g + e);
	}
}

/* Value a - 1 of a row of terms in lane a of block k. */
KERNEL_PART v8 shifted(const double *terms, int k)
{
	v8 here = v8_load(terms + k * LANES), before = {0};

	if (k > 0)
		before = v8_load(terms + (k - 1) * LANES);
	return __builtin_shufflevector(before, here, 7, 8, 9, 10, 11, 12, 13, 14);
}

/* What the cells to the left and to the right give to a column. */
KERNEL_PART v8 gather(const struct columns *columns, const double *const left[2],
	const double *const right[2], const double *x, double *out)
{
	int rest = columns->layers % LANES;
	v8 sum = {0};

	for (int k = 0; k < columns->blocks; k++) {
		v8 from_right = v8_load(right[0] + k * LANES) + shifted(right[1], k);
		v8 from_left = v8_load(left[1] + k * LANES) + shifted(left[0], k);
		v8 value = from_right - from_left;

		if (k + 1 == columns->blocks) /* nothing above the surface */
			for (int lane = 0; lane < LANES; lane++)
				value[lane] = lane < rest ? value[lane] : 0;
		sum += value * v8_load(x + k * LANES);
		v8_store(out + k * LANES, value);
	}
	return sum;
}

KERNEL void columns_apply(const struct columns *columns, const struct pressure_system *system,
	const double *x, double *out, double *sums, double *terms, int first, int last)
{
	const struct pressure_cells *cells = &system->cells;
	size_t stride = columns->stride;
	double *left[2] = {terms, terms + stride}, *right[2] = {terms + 2 * stride, terms + 3 * stride};
	int f = first * LANES;

	memset(left[0], 0, 2 * stride * sizeof *terms);
	if (f > 0)
		cell_terms(columns, cells, f, x + (size_t)(f - 1) * stride, x + (size_t)f * stride, left[0],
			left[1]);
	for (int g = first; g < last; g++) {
		int end = g * LANES + group_width(columns, g);
		v8 sum = {0};

		for (; f < end; f++) {
			const double *here = x + (size_t)f * stride;

			/* the ghost cell behind the last column has zeros for its five numbers */
			cell_terms(columns, cells, f + 1, here, here + stride, right[0], right[1]);
			if (cells->dry[f])
				memset(out + (size_t)f * stride, 0, stride * sizeof *out);
			else
				sum += gather(columns, (const double *const *)left, (const double *const *)right,
					here, out + (size_t)f * stride);
			for (int side = 0; side < 2; side++) {
				double *const spare = left[side];

				left[side] = right[side];
				right[side] = spare;
			}
		}
		sums[g] = v8_sum(sum);
	}
}
