/* Conjugate gradients on the symmetric operator, preconditioned by the operator without its xi terms,
 * which fast diagonalisation solves exactly; where these terms are large, strips of columns are eliminated.
 * An iteration is three passes over the columns: new residual and its modes; tridiagonal systems of
 * the modes; new direction and its product with the matrix.
 *
 * On a periodic system (S A S, pressure_system.h) the iteration is the same with S after the product, and the
 * preconditioner closes the seam. Vectors are the same on both sides of it, so that p A p needs no S. */
#include <math.h>
#include <stdlib.h>

#include "linear/arrays.h"
#include "linear/fast_diagonal.h"
#include "linear/pressure_solver.h"
#include "linear/strips.h"

enum { BATCH = 4 }; /* groups whose columns are in hand at once */

struct memory {
	struct fast_diagonal fast;
	struct strips strips;
	struct column_layout columns;
	int threads;
	double *x, *residual, *direction; /* columns, in units of |b| */
	double *product; /* columns: A times the direction; in between the preconditioned residual */
	double *sums;    /* [groups or blocks, whichever is more] */
	float *modes;    /* columns of modes */
	void *block;
	bool periodic;      /* the systems */
	double scale;       /* |b| */
	double alpha, beta; /* of the pass at hand */
};

/* What one thread does in a pass. */
struct part {
	struct memory *m;
	const struct pressure_system *system;
	int first, last;
};

static void destroy(void *memory)
{
	struct memory *m = memory;

	if (!m)
		return;
	fast_diagonal_clean(&m->fast);
	strips_clean(&m->strips);
	free(m->block);
	free(m);
}

static int allocate(struct memory *m, const double *shares, struct error *err)
{
	int layers = m->columns.layers, faces = m->columns.faces, groups = m->columns.groups, blocks;
	size_t all = columns_count(&m->columns);

	TRY(fast_diagonal_init(&m->fast, layers, faces, m->periodic, shares, err));
	TRY(strips_init(&m->strips, layers, faces, err));
	blocks = fast_diagonal_blocks(&m->fast);
	return arrays_allocate(
		(struct arrays_part[]){ARRAY(m->x, all), ARRAY(m->residual, all), ARRAY(m->direction, all),
			ARRAY(m->product, all), ARRAY(m->sums, (size_t)(groups > blocks ? groups : blocks)),
			ARRAY(m->modes, fast_diagonal_count(&m->fast)), {0}},
		&m->block, err);
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct memory *m = calloc(1, sizeof *m);

	if (!m)
		return error_memory(err, sizeof *m);
	m->columns = columns_make(layers, faces);
	m->threads = options->threads;
	m->periodic = options->periodic;
	if (allocate(m, options->shares, err) != 0) {
		destroy(m);
		return -1;
	}
	*out = m;
	return 0;
}

/* Do a pass over `count` groups or blocks, shared among the threads. */
static void pass(struct memory *m, const struct pressure_system *system, int count,
	void (*work)(struct part *part))
{
	int threads = m->threads < count ? m->threads : count;

#pragma omp parallel for num_threads(threads) schedule(static, 1) if (threads > 1)
	for (int t = 0; t < threads; t++) {
		struct part part = {
			m, system, (int)((long)count * t / threads), (int)((long)count * (t + 1) / threads)};

		work(&part);
	}
}

static double total(const double *sums, int count)
{
	double sum = 0;

	for (int i = 0; i < count; i++)
		sum += sums[i];
	return sum;
}

/* Where the columns of a group begin, and how many values they are. */
static size_t group_at(const struct memory *m, int group)
{
	return (size_t)group * LANES * m->columns.stride;
}

/* S of some columns. */
static void join(const struct memory *m, double *columns)
{
	size_t stride = m->columns.stride;
	double *last = columns + (size_t)(m->columns.faces - 1) * stride;

	for (size_t a = 0; a < stride; a++)
		pressure_system_join(&columns[a], &last[a]);
}

/* r r, from the sums by groups; the seam has half of its residual on either side. */
KERNEL static double residual_square(const struct memory *m)
{
	double sum = total(m->sums, m->columns.groups);

	if (m->periodic)
		sum += 2 * kernel_dot(m->residual, m->residual, (int)m->columns.stride);
	return sum;
}

/* Right side into the residual; sums: its square. */
KERNEL static void take_right_side(struct part *part)
{
	struct memory *m = part->m;

	columns_from_rows(&m->columns, part->system->rhs, (size_t)part->system->faces, m->residual,
		part->first, part->last);
	for (int g = part->first; g < part->last; g++) {
		const double *r = m->residual + group_at(m, g);

		m->sums[g] = kernel_dot(r, r, LANES * (int)m->columns.stride);
	}
}

static void take_start(struct part *part)
{
	columns_from_rows(&part->m->columns, pressure_system_x(part->system, 0), part->system->x_stride,
		part->m->x, part->first, part->last);
}

static void multiply_start(struct part *part)
{
	columns_apply(&part->m->columns, part->system, part->m->x, part->m->product, part->m->sums,
		part->first, part->last);
}

/* r -= alpha A p; sums: r r. Then the modes of r. */
KERNEL static void take_step(struct part *part)
{
	struct memory *m = part->m;
	double alpha = m->alpha;

	for (int g = part->first; g < part->last; g++) {
		size_t at = group_at(m, g);
		v8 sum = {0};

		for (size_t i = at; i < at + LANES * m->columns.stride; i += LANES) {
			v8 r = v8_load(m->residual + i) - alpha * v8_load(m->product + i);

			v8_store(m->residual + i, r);
			sum += r * r;
		}
		m->sums[g] = v8_sum(sum);
		fast_diagonal_to_modes(&m->fast, m->residual, m->modes, g, g + 1);
	}
}

static void factor_modes(struct part *part)
{
	fast_diagonal_factor(&part->m->fast, part->first, part->last);
}

static void solve_modes(struct part *part)
{
	fast_diagonal_solve(&part->m->fast, part->m->modes, part->m->sums, part->first, part->last);
}

static void prepare_seam(struct memory *m, const struct pressure_system *system)
{
	fast_diagonal_seam_side(&m->fast, m->modes);
	pass(m, system, fast_diagonal_blocks(&m->fast), solve_modes);
	fast_diagonal_seam_keep(&m->fast, m->modes);
}

static void close_modes(struct part *part)
{
	fast_diagonal_seam_close(&part->m->fast, part->m->modes, part->first, part->last);
}

/* The modes are those of a ring then. Returns how much less their product with the residual is. */
static double close_seam(struct memory *m, const struct pressure_system *system)
{
	double less = fast_diagonal_seam_jump(&m->fast, m->modes);

	pass(m, system, m->columns.groups, close_modes);
	fast_diagonal_seam_join(&m->fast, m->modes);
	return less;
}

static void multiply(struct part *part, int first, int last)
{
	columns_apply(&part->m->columns, part->system, part->m->direction, part->m->product,
		part->m->sums, first, last);
}

/* x += alpha p, with the alpha of the last step, and p = z + beta p in groups [first, last). */
KERNEL static void turn(struct memory *m, int first, int last)
{
	double alpha = m->alpha, beta = m->beta;

	fast_diagonal_to_layers(&m->fast, m->modes, m->product, first, last);
	for (size_t i = group_at(m, first); i < group_at(m, last); i += LANES) {
		v8 p = v8_load(m->direction + i);

		v8_store(m->x + i, v8_load(m->x + i) + alpha * p);
		v8_store(m->direction + i, v8_load(m->product + i) + beta * p);
	}
}

static int least(int a, int b)
{
	return a < b ? a : b;
}

/* The new direction batch by batch, and its product with the matrix one batch behind, while both are in
 * the first-level cache. The product of the first and the last batch waits for the neighbours of the
 * part, where there are any. */
static void turn_and_multiply(struct part *part)
{
	int groups = part->m->columns.groups, done = part->first > 0 ? part->first + BATCH : 0;

	for (int g = part->first; g < part->last; g += BATCH) {
		int end = least(g + BATCH, part->last), known = end == groups ? end : g;

		turn(part->m, g, end);
		if (known > done) {
			multiply(part, done, known);
			done = known;
		}
	}
}

/* What turn_and_multiply left out. */
static void multiply_edges(struct part *part)
{
	int head = least(part->first + BATCH, part->last);
	int tail = part->first + (part->last - part->first - 1) / BATCH * BATCH; /* the last batch */

	if (part->first > 0)
		multiply(part, part->first, head);
	if (part->last < part->m->columns.groups && (part->first == 0 || tail > part->first))
		multiply(part, tail, part->last);
}

/* The last step of x, and back to units of the system. */
KERNEL static void finish(struct part *part)
{
	struct memory *m = part->m;
	double scale = m->scale > 0 ? m->scale : 1, alpha = m->alpha;

	for (size_t i = group_at(m, part->first); i < group_at(m, part->last); i += LANES)
		v8_store(m->x + i, scale * (v8_load(m->x + i) + alpha * v8_load(m->direction + i)));
	columns_to_rows(&m->columns, m->x, pressure_system_x(part->system, 0), part->system->x_stride,
		part->first, part->last);
}

static bool starts_at_zero(const struct pressure_system *system)
{
	for (int a = 0; a < system->layers; a++)
		for (int f = 0; f < system->faces; f++)
			if (pressure_system_x(system, a)[f] != 0)
				return false;
	return true;
}

/* x and r in units of |b|, so that single precision has them in its range. */
static void rescale(struct memory *m, double factor)
{
	size_t all = columns_count(&m->columns);

	for (size_t i = 0; i < all; i++) {
		m->residual[i] *= factor;
		m->x[i] *= factor;
	}
}

/* A first direction that takes the residual out of the strips; its step is 1. */
static void eliminate(struct memory *m, const struct pressure_system *system)
{
	size_t all = columns_count(&m->columns);

	for (size_t i = 0; i < all; i++)
		m->direction[i] = m->product[i] = 0;
	for (int i = 0; i < m->strips.count; i++) {
		const struct strip *strip = &m->strips.strips[i];

		for (size_t k = group_at(m, strip->first); k < group_at(m, strip->last); k++) {
			m->product[k] = -m->residual[k];
			m->residual[k] = 0;
		}
	}
	strips_correct(&m->strips, system, m->direction, m->product, m->sums);
	if (m->periodic)
		join(m, m->product);
	m->alpha = 1;
}

/* Residual and direction for the start at hand. */
static void begin(struct memory *m, const struct pressure_system *system)
{
	int groups = m->columns.groups;
	size_t all = columns_count(&m->columns);

	fast_diagonal_prepare(&m->fast, system);
	pass(m, system, fast_diagonal_blocks(&m->fast), factor_modes);
	if (m->periodic)
		prepare_seam(m, system);
	pass(m, system, groups, take_right_side);
	m->scale = sqrt(residual_square(m));
	for (size_t i = 0; i < all; i++)
		m->x[i] = 0;
	if (!starts_at_zero(system)) {
		pass(m, system, groups, take_start);
		pass(m, system, groups, multiply_start);
		if (m->periodic)
			join(m, m->product);
		for (size_t i = 0; i < all; i++)
			m->residual[i] -= m->product[i];
	}
	if (m->scale > 0)
		rescale(m, 1 / m->scale);
	strips_factor(&m->strips, system);
	eliminate(m, system);
}

/* alpha p in the norm of the rule. */
static double increment(const struct memory *m, const struct pressure_system *system, int norm)
{
	double sum = 0;

	for (int f = 0; f < system->faces; f++)
		for (int a = 0; a < system->layers; a++) {
			double change =
				fabs(m->alpha * m->scale * m->direction[(size_t)f * m->columns.stride + (size_t)a]);

			if (norm == NORM_LINF)
				sum = change > sum || isnan(change) ? change : sum;
			else
				sum += system->weight[f] * (norm == NORM_L2 ? change * change : change);
		}
	return norm == NORM_L2 ? sqrt(sum) : sum;
}

static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	struct memory *m = memory;
	int groups = m->columns.groups, blocks = fast_diagonal_blocks(&m->fast), done = 0;
	double limit = rule->residual * rule->residual, last = 0;
	bool stop = false;

	begin(m, system);
	for (;; done++) {
		double square, energy;

		pass(m, system, groups, take_step);
		square = residual_square(m);
		stop = stop || (rule->criterion == CRITERION_RESIDUAL && square <= limit);
		if (stop || square == 0)
			break;
		if (isnan(square))
			return done ? -done : -1;
		if (done == rule->max_iterations) {
			pass(m, system, groups, finish); /* as far as it came */
			return done ? -done : -1;
		}
		pass(m, system, blocks, solve_modes);
		energy = total(m->sums, blocks);
		if (m->periodic)
			energy -= close_seam(m, system);
		m->beta = last > 0 ? energy / last : 0;
		last = energy;
		pass(m, system, groups, turn_and_multiply);
		pass(m, system, groups, multiply_edges);
		strips_correct(&m->strips, system, m->direction, m->product, m->sums);
		m->alpha = energy / total(m->sums, groups);
		if (m->periodic)
			join(m, m->product);
		stop = rule->criterion == CRITERION_INCREMENT &&
			   increment(m, system, rule->norm) < rule->tolerance;
	}
	pass(m, system, groups, finish);
	return done;
}

const struct pressure_solver conjugate_gradients = {
	.name = "conjugate-gradients",
	.method = METHOD_CONJUGATE_GRADIENTS,
	.matrix_free = true,
	.symmetric_only = true,
	.periodic = true,
	.create = create,
	.solve = solve,
	.free = destroy,
};
