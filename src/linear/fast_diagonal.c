#include "linear/fast_diagonal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/arrays.h"
#include "linear/modes.h"

size_t fast_diagonal_count(const struct fast_diagonal *fast)
{
	return ((size_t)fast->columns.groups * LANES + 1) * 2 * fast->half;
}

int fast_diagonal_blocks(const struct fast_diagonal *fast)
{
	return (int)(2 * fast->half / MODES);
}

/* In long double: cos in double is chosen by processor and differs in bits. */
static void fill_modes(struct fast_diagonal *fast)
{
	size_t n = (size_t)fast->columns.layers, half = fast->half;
	long double step = acosl(-1) / (long double)n, scale = sqrtl(2 / (long double)n);

	for (size_t m = 0; m < 2 * half; m++)
		fast->of_stretch[m] = fast->of_mean[m] = 1;
	for (size_t m = 0; m < (n + 1) / 2; m++) {
		long double t = ((long double)m + 0.5L) * step, twice = 2 * cosl(t);
		bool paired = n - 1 - m != m;

		fast->of_stretch[m] = fast->of_mean[half + m] = (double)(2 + twice);
		fast->of_mean[m] = fast->of_stretch[half + m] = (double)(2 - twice);
		fast->kept[m] = 1;
		fast->kept[half + m] = paired;
		for (size_t a = 0; a < n; a++) {
			float value = paired || a % 2 == 0 ? (float)(scale * cosl(t * (long double)a)) : 0;

			fast->to_modes[a % 2][a / 2 * half + m] = value;
			fast->to_layers[a % 2][m * half + a / 2] = value;
		}
	}
}

/* Those of unequal layers. */
static int find_modes(struct fast_diagonal *fast, const double *shares, struct error *err)
{
	size_t n = (size_t)fast->columns.layers, half = fast->half, lower = (n + 1) / 2;
	double *modes, *stretch;
	void *block;
	int failed;

	TRY(arrays_allocate(
		(struct arrays_part[]){ARRAY(modes, n * n), ARRAY(stretch, n), {0}}, &block, err));
	failed = modes_find(shares, (int)n, modes, stretch, err);
	for (size_t m = 0; m < 2 * half; m++)
		fast->of_stretch[m] = fast->of_mean[m] = 1;
	for (size_t m = 0; m < n; m++) {
		size_t at = m < lower ? m : half + m - lower;

		fast->of_stretch[at] = stretch[m];
		fast->of_mean[at] = 1 - stretch[m];
		fast->kept[at] = 1;
		for (size_t a = 0; a < n; a++) {
			float value = (float)modes[m * n + a];

			fast->any_to_modes[a * 2 * half + at] = value;
			fast->any_to_layers[at * fast->columns.stride + a] = value;
		}
	}
	free(block);
	return failed;
}

int fast_diagonal_init(struct fast_diagonal *fast, int layers, int faces, bool periodic,
	const double *shares, struct error *err)
{
	size_t half = fast_diagonal_half(layers);
	size_t square = shares ? 0 : half * half, any = shares ? 2 * half : 0;
	size_t row = (size_t)faces + 1, all, seam = periodic ? 2 * half : 0;

	*fast = (struct fast_diagonal){
		.columns = columns_make(layers, faces), .half = half, .unequal = shares != NULL};
	all = fast_diagonal_count(fast);
	TRY(arrays_allocate(
		(struct arrays_part[]){ARRAY(fast->to_modes[0], square), ARRAY(fast->to_modes[1], square),
			ARRAY(fast->to_layers[0], square), ARRAY(fast->to_layers[1], square),
			ARRAY(fast->any_to_modes, any * (size_t)layers),
			ARRAY(fast->any_to_layers, any * fast->columns.stride),
			ARRAY(fast->of_stretch, 2 * half), ARRAY(fast->of_mean, 2 * half),
			ARRAY(fast->kept, 2 * half), ARRAY(fast->multiplier, all), ARRAY(fast->inverse, all),
			ARRAY(fast->bands[0], row), ARRAY(fast->bands[1], row), ARRAY(fast->bands[2], row),
			ARRAY(fast->bands[3], row), ARRAY(fast->seam, periodic ? all : 0),
			ARRAY(fast->seam_scale, seam), ARRAY(fast->seam_jump, seam), {0}},
		&fast->memory, err));
	if (shares)
		return find_modes(fast, shares, err);
	fill_modes(fast);
	return 0;
}

void fast_diagonal_clean(struct fast_diagonal *fast)
{
	free(fast->memory);
	*fast = (struct fast_diagonal){0};
}

/* Cell i adds h/(4 dx^2) (q_{i-1} - q_i)^2 to K and N^2/(4 h) (q_{i-1} + q_i)^2 to M, to the latter also
 * the mean over the layers of s^2/h, which is most of what xi does. */
void fast_diagonal_prepare(struct fast_diagonal *fast, const struct pressure_system *system)
{
	const struct pressure_cells *cells = &system->cells;
	double *kd = fast->bands[0], *md = fast->bands[1], *ko = fast->bands[2], *mo = fast->bands[3];
	double k_before = 0, m_before = 0; /* of the cell before the face */
	double mean = 0,
		   spread = 0; /* of the places of the layers; sums that are exact of equal ones */

	for (int a = 0; a < system->layers; a++)
		mean += cells->place[a];
	mean /= system->layers;
	for (int a = 0; a < system->layers; a++)
		spread += (cells->place[a] - mean) * (cells->place[a] - mean);
	spread /= system->layers;

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

KERNEL_PART v16f modes_load(const float *from)
{
	return *(const v16f *)from;
}

KERNEL_PART void modes_store(float *to, v16f value)
{
	*(v16f *)to = value;
}

/* L D L^T of a tridiagonal matrix per lane, in double precision, eight modes at a time. */
KERNEL void fast_diagonal_factor(struct fast_diagonal *fast, int first, int last)
{
	size_t stride = 2 * fast->half;

	for (size_t m = (size_t)first * MODES; m < (size_t)last * MODES; m += LANES) {
		v8 of_k = v8_load(fast->of_stretch + m), of_m = v8_load(fast->of_mean + m);
		v8 kept = v8_load(fast->kept + m), inverse = {0};
		size_t at = m;

		for (int f = 0; f < fast->columns.faces; f++, at += stride) {
			v8 coupling = of_k * fast->bands[2][f] + of_m * fast->bands[3][f];
			v8 diagonal = of_k * fast->bands[0][f] + of_m * fast->bands[1][f];
			v8 l = coupling * inverse;

			inverse = kept / (diagonal - l * coupling);
			*(v8f *)(fast->multiplier + at) = __builtin_convertvector(l, v8f);
			*(v8f *)(fast->inverse + at) = __builtin_convertvector(inverse, v8f);
		}
	}
}

/* `blocks` vectors of systems side by side, since each waits for its own last value. */
KERNEL_PART void solve(
	const struct fast_diagonal *fast, float *modes, double *sums, int first, int blocks)
{
	size_t stride = 2 * fast->half, at = (size_t)first * MODES;
	v16f last[4], sum[4];

	for (int k = 0; k < blocks; k++)
		last[k] = sum[k] = (v16f){0};
	for (int f = 0; f < fast->columns.faces; f++, at += stride)
		for (int k = 0; k < blocks; k++) {
			size_t here = at + (size_t)k * MODES;
			v16f scaled;

			last[k] = modes_load(modes + here) - modes_load(fast->multiplier + here) * last[k];
			scaled = last[k] * modes_load(fast->inverse + here);
			sum[k] += last[k] * scaled;
			modes_store(modes + here, scaled);
		}
	for (int k = 0; k < blocks; k++) {
		v8 low = __builtin_convertvector(
			__builtin_shufflevector(sum[k], sum[k], 0, 1, 2, 3, 4, 5, 6, 7), v8);
		v8 high = __builtin_convertvector(
			__builtin_shufflevector(sum[k], sum[k], 8, 9, 10, 11, 12, 13, 14, 15), v8);

		sums[first + k] = v8_sum(low + high);
		last[k] = (v16f){0};
	}
	for (int f = fast->columns.faces - 1; f >= 0; f--) {
		at -= stride;
		for (int k = 0; k < blocks; k++) {
			size_t here = at + (size_t)k * MODES;

			/* the multiplier of the next face; behind the last one it is zero */
			last[k] =
				modes_load(modes + here) - modes_load(fast->multiplier + here + stride) * last[k];
			modes_store(modes + here, last[k]);
		}
	}
}

/* At most four blocks at a time, with their number known when compiled. */
KERNEL void fast_diagonal_solve(
	const struct fast_diagonal *fast, float *modes, double *sums, int first, int last)
{
	for (; last - first >= 4; first += 4)
		solve(fast, modes, sums, first, 4);
	switch (last - first) {
	case 3:
		solve(fast, modes, sums, first, 3);
		break;
	case 2:
		solve(fast, modes, sums, first, 2);
		break;
	case 1:
		solve(fast, modes, sums, first, 1);
		break;
	default:;
	}
}

/* Where the modes of the last face begin. */
static size_t last_face(const struct fast_diagonal *fast)
{
	return (size_t)(fast->columns.faces - 1) * 2 * fast->half;
}

void fast_diagonal_seam_side(const struct fast_diagonal *fast, float *modes)
{
	size_t last = last_face(fast);

	memset(modes, 0, fast_diagonal_count(fast) * sizeof *modes);
	for (size_t m = 0; m < 2 * fast->half; m++) {
		modes[m] = (float)fast->kept[m];
		modes[last + m] = -(float)fast->kept[m];
	}
}

void fast_diagonal_seam_keep(struct fast_diagonal *fast, const float *modes)
{
	size_t last = last_face(fast);

	memcpy(fast->seam, modes, fast_diagonal_count(fast) * sizeof *modes);
	for (size_t m = 0; m < 2 * fast->half; m++)
		fast->seam_scale[m] = fast->kept[m] > 0 ? 1 / (modes[m] - modes[last + m]) : 0;
}

double fast_diagonal_seam_jump(struct fast_diagonal *fast, const float *modes)
{
	size_t last = last_face(fast);
	double sum = 0;

	for (size_t m = 0; m < 2 * fast->half; m++) {
		float jump = modes[m] - modes[last + m];

		fast->seam_jump[m] = jump * fast->seam_scale[m];
		sum += (double)jump * fast->seam_jump[m];
	}
	return sum;
}

KERNEL void fast_diagonal_seam_close(
	const struct fast_diagonal *fast, float *modes, int first, int last)
{
	size_t stride = 2 * fast->half, end = (size_t)last * LANES * stride;

	for (size_t at = (size_t)first * LANES * stride; at < end; at += stride)
		for (size_t m = 0; m < stride; m += MODES)
			modes_store(
				modes + at + m, modes_load(modes + at + m) - modes_load(fast->seam_jump + m) *
																 modes_load(fast->seam + at + m));
}

void fast_diagonal_seam_join(const struct fast_diagonal *fast, float *modes)
{
	size_t last = last_face(fast);

	for (size_t m = 0; m < 2 * fast->half; m++)
		modes[m] = modes[last + m] = 0.5F * (modes[m] + modes[last + m]);
}

/* Eight columns by sixteen modes in registers at a time. */
KERNEL_PART void any_to_modes(const struct fast_diagonal *fast, const float *in, float *out)
{
	size_t stride = fast->columns.stride, row = 2 * fast->half;
	size_t layers = (size_t)fast->columns.layers;

	for (size_t k = 0; k < row; k += MODES) {
		v16f sum[LANES] = {0};

		for (size_t a = 0; a < layers; a++) {
			v16f modes = modes_load(fast->any_to_modes + a * row + k);

			for (size_t c = 0; c < LANES; c++)
				sum[c] += in[c * stride + a] * modes;
		}
		for (size_t c = 0; c < LANES; c++)
			modes_store(out + c * row + k, sum[c]);
	}
}

/* Sums over the even and the odd layers, eight columns by sixteen modes in registers at a time; a mode
 * is their sum, and its partner their difference. */
KERNEL void fast_diagonal_to_modes(
	const struct fast_diagonal *fast, const double *from, float *modes, int first, int last)
{
	size_t stride = fast->columns.stride, half = fast->half;
	size_t pairs = ((size_t)fast->columns.layers + 1) / 2; /* above the surface is a zero */
	float in[LANES * LANES * COLUMNS_BLOCKS_MAX];

	for (int g = first; g < last; g++) {
		float *out = modes + (size_t)g * LANES * 2 * half;

		for (size_t i = 0; i < LANES * stride; i++)
			in[i] = (float)from[(size_t)g * LANES * stride + i];
		if (fast->unequal) {
			any_to_modes(fast, in, out);
			continue;
		}
		for (size_t k = 0; k < half; k += MODES) {
			v16f even[LANES] = {0}, odd[LANES] = {0};

			for (size_t j = 0; j < pairs; j++) {
				v16f row_even = modes_load(fast->to_modes[0] + j * half + k);
				v16f row_odd = modes_load(fast->to_modes[1] + j * half + k);

				for (size_t c = 0; c < LANES; c++) {
					even[c] += in[c * stride + 2 * j] * row_even;
					odd[c] += in[c * stride + 2 * j + 1] * row_odd;
				}
			}
			for (size_t c = 0; c < LANES; c++) {
				modes_store(out + c * 2 * half + k, even[c] + odd[c]);
				modes_store(out + c * 2 * half + half + k, even[c] - odd[c]);
			}
		}
	}
}

/* Sums and differences of the modes and their partners, in place. */
KERNEL_PART void pair_modes(float *column, size_t half)
{
	for (size_t k = 0; k < half; k += MODES) {
		v16f a = modes_load(column + k), b = modes_load(column + half + k);

		modes_store(column + k, a + b);
		modes_store(column + half + k, a - b);
	}
}

/* Layers 2 first .. 2 first + 7 of a column, of which the even and odd ones are at `first`. */
#define INTERLEAVED(even, odd, first)                                                              \
	__builtin_convertvector(                                                                       \
		__builtin_shufflevector(even, odd, first, 16 + (first), (first) + 1, 17 + (first),         \
			(first) + 2, 18 + (first), (first) + 3, 19 + (first)),                                 \
		v8)

KERNEL_PART void store_layers(double *to, v16f even, v16f odd, size_t room)
{
	v8_store(to, INTERLEAVED(even, odd, 0));
	if (room > LANES)
		v8_store(to + v8_at(1), INTERLEAVED(even, odd, 4));
	if (room > v8_at(2))
		v8_store(to + v8_at(2), INTERLEAVED(even, odd, 8));
	if (room > v8_at(3))
		v8_store(to + v8_at(3), INTERLEAVED(even, odd, 12));
}

/* Beyond the last mode of either half there are zeros. */
KERNEL_PART void any_to_layers(const struct fast_diagonal *fast, const float *in, double *out)
{
	size_t stride = fast->columns.stride, row = 2 * fast->half;

	for (size_t k = 0; k < stride; k += LANES) {
		v8f sum[LANES] = {0};

		for (size_t m = 0; m < row; m++) {
			v8f layers = *(const v8f *)(fast->any_to_layers + m * stride + k);

			for (size_t c = 0; c < LANES; c++)
				sum[c] += in[c * row + m] * layers;
		}
		for (size_t c = 0; c < LANES; c++)
			v8_store(out + c * stride + k, __builtin_convertvector(sum[c], v8));
	}
}

/* The even layers are made of the sums and the odd ones of the differences. */
KERNEL void fast_diagonal_to_layers(
	const struct fast_diagonal *fast, float *modes, double *to, int first, int last)
{
	size_t stride = fast->columns.stride, half = fast->half;
	size_t lower = ((size_t)fast->columns.layers + 1) / 2;

	for (int g = first; g < last; g++) {
		float *in = modes + (size_t)g * LANES * 2 * half;
		double *out = to + (size_t)g * LANES * stride;

		if (fast->unequal) {
			any_to_layers(fast, in, out);
			continue;
		}
		for (size_t c = 0; c < LANES; c++)
			pair_modes(in + c * 2 * half, half);
		for (size_t k = 0; k < half && 2 * k < stride; k += MODES) {
			v16f even[LANES] = {0}, odd[LANES] = {0};

			for (size_t m = 0; m < lower; m++) {
				v16f row_even = modes_load(fast->to_layers[0] + m * half + k);
				v16f row_odd = modes_load(fast->to_layers[1] + m * half + k);

				for (size_t c = 0; c < LANES; c++) {
					even[c] += in[c * 2 * half + m] * row_even;
					odd[c] += in[c * 2 * half + half + m] * row_odd;
				}
			}
			for (size_t c = 0; c < LANES; c++)
				store_layers(out + c * stride + 2 * k, even[c], odd[c], stride - 2 * k);
		}
	}
}
