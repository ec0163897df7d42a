/* Red-black relaxation by lines along x: the layers of one parity do not see each other, so that their
 * tridiagonal systems are solved eight at a time, one in each lane of a vector; first the even layers,
 * then the odd ones, each over-relaxed.
 *
 * The true residual costs nothing but a product with the own line: where a colour takes over the other
 * one, its residual is at hand; and a line that was just solved and over-relaxed by omega has
 * (1 - omega) times the residual that it had before. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/kernel.h"
#include "linear/arrays.h"
#include "linear/pressure_solver.h"

/* What the forward pass reads of a face and eight lines, LANES each, in this order. Every row is divided
 * by its pivot. */
enum {
	BELOW_LOWER,
	BELOW_DIAGONAL,
	BELOW_UPPER,
	ABOVE_LOWER,
	ABOVE_DIAGONAL,
	ABOVE_UPPER,
	RIGHT,
	MULTIPLIER, /* lower */
	PIVOT,
	RECORD
};

/* A part of such a record. */
#define PART(record, part) ((record) + (size_t)(part)*LANES)

/* The lines of a colour in groups of eight; line k of colour c is layer 2 k + c. */
struct colour {
	int lines;
	double *records; /* [groups][faces][RECORD][LANES] */
	double *ratio;   /* [groups][faces][LANES], upper over pivot */
	double *x;       /* [-1 .. faces][stride], all lines of a face side by side, zeros around */
};

struct memory {
	int faces, groups; /* of the larger colour */
	size_t stride;     /* LANES groups */
	double omega;
	struct colour colours[2];
	double *y;     /* [groups][faces][LANES], between the two passes */
	double *zeros; /* [faces] */
	void *block;
};

/* Of the lines of a face there are zeros on either side, and a little more. */
static int allocate(struct memory *m, struct error *err)
{
	size_t vectors = (size_t)m->faces * m->stride, around = m->stride + LANES;
	struct colour *even = &m->colours[0], *odd = &m->colours[1];

	TRY(arrays_allocate((struct arrays_part[]){ARRAY(even->records, vectors * RECORD),
							ARRAY(odd->records, vectors * RECORD), ARRAY(even->ratio, vectors),
							ARRAY(odd->ratio, vectors), ARRAY(even->x, vectors + 2 * around),
							ARRAY(odd->x, vectors + 2 * around), ARRAY(m->y, vectors),
							ARRAY(m->zeros, (size_t)m->faces), {0}},
		&m->block, err));
	even->x += around;
	odd->x += around;
	return 0;
}

static void destroy(void *memory)
{
	if (memory)
		free(((struct memory *)memory)->block);
	free(memory);
}

/* The theory of over-relaxation gives this for waves much longer than the layers are high, with q = 0 at the
 * surface and no flux at the bed: sin of pi/2N is the rate of the slowest. Measured on the collapse of
 * Table 4, to a residual of 1e-8: among factors 0.6 to 1.4 of that sine, 1 takes the fewest iterations
 * for 2, 5, 10, 20 and 40 layers (13, 35, 67, 126, 259 on average; 0.8 takes 12 to 22 %, 1.2 50 to
 * 59 % more). */
static double best_omega(int layers)
{
	return 2 / (1 + (double)sinl(acosl(-1) / (2 * layers)));
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct memory *m = malloc(sizeof *m);

	if (!m)
		return error_memory(err, sizeof *m);
	*m = (struct memory){.faces = faces, .groups = ((layers + 1) / 2 + LANES - 1) / LANES};
	m->stride = (size_t)m->groups * LANES;
	m->omega = options->relaxation > 0 ? options->relaxation : best_omega(layers);
	for (int c = 0; c < 2; c++)
		m->colours[c].lines = (layers + 1 - c) / 2;
	if (allocate(m, err) != 0) {
		destroy(m);
		return -1;
	}
	*out = m;
	return 0;
}

/* The same row of eight lines, from line `first` on; zeros where there is none. */
struct rows {
	const double *of[LANES];
};

static struct rows rows_of(const struct memory *m, int c, int first, const double *band)
{
	struct rows rows;

	for (int k = 0; k < LANES; k++)
		rows.of[k] = first + k < m->colours[c].lines
						 ? band + (size_t)(2 * (first + k) + c) * (size_t)m->faces
						 : m->zeros;
	return rows;
}

KERNEL_PART v8 rows_at(const struct rows *rows, int f)
{
	v8 out;

	for (int k = 0; k < LANES; k++)
		out[k] = rows->of[k][f];
	return out;
}

/* Factor the lines of group g and divide their rows by the pivots. */
KERNEL static void take_matrix(
	const struct memory *m, const struct pressure_system *system, int c, int g)
{
	const double *const bands[] = {system->below_lower, system->below_diagonal, system->below_upper,
		system->above_lower, system->above_diagonal, system->above_upper, system->rhs,
		system->lower, system->diagonal, system->upper};
	enum { COUPLINGS = RIGHT + 1, LOWER = COUPLINGS, DIAGONAL, UPPER, BANDS };
	size_t group = (size_t)g * (size_t)m->faces * LANES;
	double *record = m->colours[c].records + group * RECORD, *ratio = m->colours[c].ratio + group;
	struct rows rows[BANDS];
	v8 last = {0}, missing = {0};

	for (int i = 0; i < BANDS; i++)
		rows[i] = rows_of(m, c, g * LANES, bands[i]);
	for (int k = 0; k < LANES; k++)
		missing[k] = rows[0].of[k] == m->zeros ? 1 : 0;
	for (int f = 0; f < m->faces; f++, record += (size_t)RECORD * LANES, ratio += LANES) {
		v8 lower = rows_at(&rows[LOWER], f);
		v8 pivot = rows_at(&rows[DIAGONAL], f) + missing - lower * last, inverse = 1 / pivot;

		last = rows_at(&rows[UPPER], f) * inverse;
		for (int i = 0; i < COUPLINGS; i++)
			v8_store(PART(record, i), rows_at(&rows[i], f) * inverse);
		v8_store(PART(record, MULTIPLIER), lower * inverse);
		v8_store(PART(record, PIVOT), pivot);
		v8_store(ratio, last);
	}
}

/* Take over the other colour and eliminate forward in group g. Returns the square of the true residual
 * of its lines. */
KERNEL static double forward(const struct memory *m, int c, int g)
{
	const struct colour *mine = &m->colours[c];
	size_t group = (size_t)g * (size_t)m->faces * LANES;
	const double *record = mine->records + group * RECORD, *ratio = mine->ratio + group;
	const double *below = m->colours[1 - c].x + (ptrdiff_t)g * LANES + c - 1, *above = below + 1;
	const double *x = mine->x + (size_t)g * LANES;
	ptrdiff_t stride = (ptrdiff_t)m->stride;
	double *y = m->y + group;
	v8 last = {0}, last_ratio = {0}, square = {0};

	for (int f = 0; f < m->faces; f++) {
		v8 multiplier = v8_load(PART(record, MULTIPLIER));
		v8 next_ratio = v8_load(ratio);
		v8 right = v8_load(PART(record, RIGHT)) -
				   (v8_load(PART(record, BELOW_LOWER)) * v8_load(below - stride) +
					   v8_load(PART(record, BELOW_DIAGONAL)) * v8_load(below) +
					   v8_load(PART(record, BELOW_UPPER)) * v8_load(below + stride)) -
				   (v8_load(PART(record, ABOVE_LOWER)) * v8_load(above - stride) +
					   v8_load(PART(record, ABOVE_DIAGONAL)) * v8_load(above) +
					   v8_load(PART(record, ABOVE_UPPER)) * v8_load(above + stride));
		v8 own = multiplier * (v8_load(x - stride) + last_ratio * v8_load(x)) + v8_load(x) +
				 next_ratio * v8_load(x + stride);
		v8 residual = (right - own) * v8_load(PART(record, PIVOT));

		square += residual * residual;
		last_ratio = next_ratio;
		last = right - multiplier * last;
		v8_store(y, last);
		record += (size_t)RECORD * LANES;
		ratio += LANES;
		y += LANES;
		below += stride;
		above += stride;
		x += stride;
	}
	return v8_sum(square);
}

/* The increment of a face in the norm, put to `sum`. */
KERNEL_PART v8 measure(v8 sum, v8 change, double weight, int norm)
{
	if (norm == NORM_L2)
		return sum + weight * (change * change);
	for (int k = 0; k < LANES; k++)
		change[k] = change[k] < 0 ? -change[k] : change[k];
	if (norm == NORM_L1)
		return sum + weight * change;
	for (int k = 0; k < LANES; k++)
		sum[k] = change[k] > sum[k] ? change[k] : sum[k];
	return sum;
}

/* Substitute backward and over-relax in group g. Returns the increment in the norm put to `error`; a NaN
 * stays. */
KERNEL static double backward(
	const struct memory *m, const double *weight, int norm, int c, int g, double error)
{
	const struct colour *mine = &m->colours[c];
	size_t end = (size_t)(g + 1) * (size_t)m->faces * LANES;
	const double *y = m->y + end, *ratio = mine->ratio + end;
	double *x = mine->x + (size_t)m->faces * m->stride + (size_t)g * LANES;
	v8 last = {0}, sum = {0}, trace = {0};

	for (int f = m->faces - 1; f >= 0; f--) {
		v8 change;

		y -= LANES;
		ratio -= LANES;
		x -= m->stride;
		last = v8_load(y) - v8_load(ratio) * last;
		change = m->omega * (last - v8_load(x));
		v8_store(x, v8_load(x) + change);
		sum = measure(sum, change, weight[f], norm);
		trace += change;
	}
	if (isnan(error + v8_sum(trace))) /* the largest of many passes over a NaN */
		return NAN;
	if (norm != NORM_LINF)
		return error + v8_sum(sum);
	for (int k = 0; k < LANES; k++)
		error = sum[k] > error ? sum[k] : error;
	return error;
}

/* Between the rows of the system and the lines of the colours. */
static void take_start(const struct memory *m, const struct pressure_system *system)
{
	size_t count = (size_t)m->faces * m->stride;

	for (int c = 0; c < 2; c++)
		memset(m->colours[c].x, 0, count * sizeof *m->colours[c].x); /* and where no line is */
	for (int a = 0; a < system->layers; a++) {
		const double *row = pressure_system_x(system, a);
		double *x = m->colours[a % 2].x + a / 2;

		for (int f = 0; f < m->faces; f++)
			x[(size_t)f * m->stride] = row[f];
	}
}

static void give_solution(const struct memory *m, const struct pressure_system *system)
{
	for (int a = 0; a < system->layers; a++) {
		double *row = pressure_system_x(system, a);
		const double *x = m->colours[a % 2].x + a / 2;

		for (int f = 0; f < m->faces; f++)
			row[f] = x[(size_t)f * m->stride];
	}
}

static double square_of_right_side(const struct pressure_system *system)
{
	double sum = 0;

	for (int a = 0; a < system->layers; a++) {
		const double *row = system->rhs + pressure_system_row(system, a);

		sum += kernel_dot(row, row, system->faces);
	}
	return sum;
}

static double forward_pass(const struct memory *m, int c)
{
	double square = 0;

	for (int g = 0; g < m->groups; g++)
		square += forward(m, c, g);
	return square;
}

static double backward_pass(
	const struct memory *m, const double *weight, int norm, int c, double error)
{
	for (int g = 0; g < m->groups; g++)
		error = backward(m, weight, norm, c, g, error);
	return error;
}

static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	const struct memory *m = memory;
	double limit = rule->residual * rule->residual * square_of_right_side(system);
	double left = (1 - m->omega) * (1 - m->omega), error = INFINITY, odd = INFINITY;
	int done = 0;

	for (int c = 0; c < 2; c++)
		for (int g = 0; g < m->groups; g++)
			take_matrix(m, system, c, g);
	take_start(m, system);
	for (;; done++) {
		double even = forward_pass(m, 0);

		if (rule->criterion == CRITERION_RESIDUAL ? even + left * odd <= limit
												  : error < rule->tolerance)
			break;
		if (done == rule->max_iterations || isnan(even) || isnan(error)) {
			give_solution(m, system); /* as far as it came */
			return done ? -done : -1;
		}
		error = backward_pass(m, system->weight, rule->norm, 0, 0);
		odd = forward_pass(m, 1);
		error = backward_pass(m, system->weight, rule->norm, 1, error);
		if (rule->norm == NORM_L2)
			error = sqrt(error);
	}
	give_solution(m, system);
	return done;
}

const struct pressure_solver red_black_line_relaxation = {
	.name = "red-black-line-relaxation",
	.method = METHOD_RED_BLACK_LINE_RELAXATION,
	.create = create,
	.solve = solve,
	.free = destroy,
};
