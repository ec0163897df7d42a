#include "linear/fast_diagonal.h"

#include <math.h>
#include <stdlib.h>

static size_t layout(struct fast_diagonal *fast, double *memory)
{
	size_t stride = fast->columns.stride, square = (size_t)fast->columns.layers * stride;
	size_t all = columns_count(&fast->columns), row = (size_t)fast->columns.faces + 1;
	struct {
		double **part;
		size_t count;
	} const parts[] = {{&fast->to_modes, square}, {&fast->to_layers, square},
		{&fast->of_stretch, stride}, {&fast->of_mean, stride}, {&fast->multiplier, all},
		{&fast->inverse, all}, {&fast->bands[0], row}, {&fast->bands[1], row},
		{&fast->bands[2], row}, {&fast->bands[3], row}};
	size_t at = 0;

	for (size_t i = 0; i < sizeof parts / sizeof *parts; at += parts[i++].count)
		*parts[i].part = memory ? memory + at : NULL;
	return at;
}

/* In long double: cos in double is chosen by processor and differs in bits. */
static void fill_modes(struct fast_diagonal *fast)
{
	int n = fast->columns.layers;
	size_t stride = fast->columns.stride;
	long double step = acosl(-1) / n, scale = sqrtl(2 / (long double)n);

	for (int m = 0; m < n; m++) {
		long double t = (m + 0.5L) * step;

		fast->of_stretch[m] = (double)(2 + 2 * cosl(t));
		fast->of_mean[m] = (double)(2 - 2 * cosl(t));
		for (int a = 0; a < n; a++) {
			double value = (double)(scale * cosl(t * a));

			fast->to_modes[(size_t)a * stride + (size_t)m] = value;
			fast->to_layers[(size_t)m * stride + (size_t)a] = value;
		}
	}
	for (size_t m = (size_t)n; m < stride; m++)
		fast->of_stretch[m] = fast->of_mean[m] = 1;
}

int fast_diagonal_init(struct fast_diagonal *fast, int layers, int faces, struct error *err)
{
	size_t count;

	*fast = (struct fast_diagonal){.columns = columns_make(layers, faces)};
	count = layout(fast, NULL);
	fast->memory = calloc(count, sizeof *fast->memory);
	if (!fast->memory)
		return error_memory(err, count * sizeof *fast->memory);
	(void)layout(fast, fast->memory);
	fill_modes(fast);
	return 0;
}

void fast_diagonal_clean(struct fast_diagonal *fast)
{
	free(fast->memory);
	fast->memory = NULL;
}

/* Cell i adds h/(4 dx^2) (q_{i-1} - q_i)^2 to K and N^2/(4 h) (q_{i-1} + q_i)^2 to M, to the latter also
 * the mean over the layers of s^2/h, which is most of what xi does. */
void fast_diagonal_prepare(struct fast_diagonal *fast, const struct pressure_system *system)
{
	const struct pressure_cells *cells = &system->cells;
	double *kd = fast->bands[0], *md = fast->bands[1], *ko = fast->bands[2], *mo = fast->bands[3];
	double n = system->layers, mean = (n - 1) / 2, spread = (n * n - 1) / 12;
	double k_before = 0, m_before = 0; /* of the cell before the face */

	for (int f = 0; f < system->faces; f++) {
		double lean = cells->lean[f + 1], middle = cells->tilt[f + 1] + lean * mean;
		double k = cells->stretch[f + 1];
		double m =
			(cells->quarter_nn + middle * middle + lean * lean * spread) * cells->inverse[f + 1];
		bool dry = cells->dry[f], apart = dry || (f > 0 && cells->dry[f - 1]);

		kd[f] = dry ? 1 : k_before + k;
		md[f] = dry ? 1 : m_before + m;
		ko[f] = apart ? 0 : -k_before;
		mo[f] = apart ? 0 : m_before;
		k_before = k;
		m_before = m;
	}
}

/* L D L^T of a tridiagonal matrix per lane; `blocks` of them at a time, since each waits for its own
 * divisions. */
KERNEL_PART void factor(const struct fast_diagonal *fast, int first, int blocks)
{
	size_t stride = fast->columns.stride, at = (size_t)first * LANES;
	v8 of_k[4], of_m[4], last[4];

	for (int k = 0; k < blocks; k++) {
		of_k[k] = v8_load(fast->of_stretch + at + k * LANES);
		of_m[k] = v8_load(fast->of_mean + at + k * LANES);
		last[k] = (v8){0};
	}
	for (int f = 0; f < fast->columns.faces; f++, at += stride)
		for (int k = 0; k < blocks; k++) {
			v8 coupling = of_k[k] * fast->bands[2][f] + of_m[k] * fast->bands[3][f];
			v8 diagonal = of_k[k] * fast->bands[0][f] + of_m[k] * fast->bands[1][f];
			v8 l = coupling * last[k];

			last[k] = 1 / (diagonal - l * coupling);
			v8_store(fast->multiplier + at + k * LANES, l);
			v8_store(fast->inverse + at + k * LANES, last[k]);
		}
}

KERNEL_PART void solve(
	const struct fast_diagonal *fast, double *modes, double *sums, int first, int blocks)
{
	size_t stride = fast->columns.stride, at = (size_t)first * LANES;
	v8 last[4], sum[4];

	for (int k = 0; k < blocks; k++)
		last[k] = sum[k] = (v8){0};
	for (int f = 0; f < fast->columns.faces; f++, at += stride)
		for (int k = 0; k < blocks; k++) {
			double *y = modes + at + k * LANES;
			v8 scaled;

			last[k] = v8_load(y) - v8_load(fast->multiplier + at + k * LANES) * last[k];
			scaled = last[k] * v8_load(fast->inverse + at + k * LANES);
			sum[k] += last[k] * scaled;
			v8_store(y, scaled);
		}
	for (int k = 0; k < blocks; k++) {
		last[k] = (v8){0};
		sums[first + k] = v8_sum(sum[k]);
	}
	for (int f = fast->columns.faces - 1; f >= 0; f--) {
		at -= stride;
		for (int k = 0; k < blocks; k++) {
			double *y = modes + at + k * LANES;

			/* the multiplier of the next face; behind the last one it is zero */
			last[k] = v8_load(y) - v8_load(fast->multiplier + at + stride + k * LANES) * last[k];
			v8_store(y, last[k]);
		}
	}
}

/* At most four blocks at a time, with their number known when compiled. */
#define BY_BLOCKS(call_with)                                                                       \
	for (int b = first; b < last; b += 4)                                                          \
		switch (last - b) {                                                                        \
		case 1:                                                                                    \
			call_with(1);                                                                          \
			break;                                                                                 \
		case 2:                                                                                    \
			call_with(2);                                                                          \
			break;                                                                                 \
		case 3:                                                                                    \
			call_with(3);                                                                          \
			break;                                                                                 \
		default:                                                                                   \
			call_with(4);                                                                          \
		}

KERNEL void fast_diagonal_factor(struct fast_diagonal *fast, int first, int last){
#define FACTOR(count) factor(fast, b, count)
	BY_BLOCKS(FACTOR)}

KERNEL void fast_diagonal_solve(
	const struct fast_diagonal *fast, double *modes, double *sums, int first, int last){
#define SOLVE(count) solve(fast, modes, sums, b, count)
	BY_BLOCKS(SOLVE)}

/* A product of small matrices, eight columns by eight results in registers at a time. */
KERNEL void fast_diagonal_transform(const struct fast_diagonal *fast, const double *matrix,
	const double *from, double *to, int first, int last)
{
	size_t stride = fast->columns.stride;
	int layers = fast->columns.layers;

	for (int g = first; g < last; g++) {
		const double *in = from + (size_t)g * LANES * stride;
		double *out = to + (size_t)g * LANES * stride;

		for (int k = 0; k < fast->columns.blocks; k++) {
			v8 sum[LANES] = {0};

			for (int a = 0; a < layers; a++) {
				v8 row = v8_load(matrix + (size_t)a * stride + k * LANES);

				for (size_t c = 0; c < LANES; c++)
					sum[c] += in[c * stride + (size_t)a] * row;
			}
			for (size_t c = 0; c < LANES; c++)
				v8_store(out + c * stride + k * LANES, sum[c]);
		}
	}
}
