/* Every method on every kind of system that a flow makes, against the exact answer. A system comes from
 * the operators of the dry model; its right side is made for a known solution, in long double by a
 * product of this file. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "config/config_table.h"
#include "dry/dry.h"
#include "linear/strips.h"

static double noise(unsigned *seed) /* -1 to 1 */
{
	*seed = *seed * 1664525u + 1013904223u;
	return (double)(*seed >> 8) / (1 << 23) - 1;
}

/* Thickness and bed of `cells` cells, m. */
static void flat(int cells, double *h, double *b)
{
	for (int i = 0; i < cells; i++) {
		h[i] = 0.1;
		b[i] = 0;
	}
}

static void rough(int cells, double *h, double *b)
{
	unsigned seed = 7;

	for (int i = 0; i < cells; i++) {
		h[i] = 0.05 + 0.04 * noise(&seed);
		b[i] = 0.02 * noise(&seed);
	}
}

static void wavy(int cells, double *h, double *b)
{
	for (int i = 0; i < cells; i++) {
		h[i] = 0.05 + 0.005 * sin(0.4 * i);
		b[i] = 0.005 * cos(0.3 * i);
	}
}

static void column_face(int cells, double *h, double *b)
{
	for (int i = 0; i < cells; i++) {
		h[i] = i < cells / 2 ? 0.14182 : 0.00182;
		b[i] = 0;
	}
}

/* Two faces, and a step at the right end. */
static void three_faces(int cells, double *h, double *b)
{
	for (int i = 0; i < cells; i++) {
		h[i] = i < cells / 4 ? 0.04 : i < cells / 2 ? 0.14 : 0.02;
		b[i] = i < cells - 2 ? 0 : 0.01;
	}
}

static void dry_middle(int cells, double *h, double *b)
{
	rough(cells, h, b);
	for (int i = cells / 3; i <= cells / 2; i++)
		h[i] = i % 2 ? 0 : 1e-12;
}

static void dry_ends(int cells, double *h, double *b)
{
	rough(cells, h, b);
	h[0] = h[cells - 1] = h[cells - 2] = 0;
}

static void nearly_dry(int cells, double *h, double *b)
{
	unsigned seed = 3;

	rough(cells, h, b);
	for (int i = 0; i < cells; i += 2)
		h[i] = 1e-5 * (1.2 + noise(&seed));
}

static void all_dry(int cells, double *h, double *b)
{
	flat(cells, h, b);
	memset(h, 0, (size_t)cells * sizeof *h);
}

enum {
	WILD = 1, /* an iteration need not converge, but has to say so */
	RING = 2,
	GRADED = 4 /* layers are the thinner the lower */
};

static const struct problem {
	const char *name;
	int layers, cells;
	bool left_wall, right_wall;
	void (*shape)(int cells, double *h, double *b);
	int operator_; /* enum operator_kind */
	int kind;      /* of the above, added up */
} problems[] = {
	{"one unknown", 1, 1, true, false, flat, OPERATOR_SYMMETRIC, 0},
	{"one cell between walls", 3, 1, true, true, flat, OPERATOR_SYMMETRIC, 0},
	{"one layer", 1, 33, true, true, rough, OPERATOR_SYMMETRIC, 0},
	{"two layers", 2, 8, true, false, rough, OPERATOR_SYMMETRIC, 0},
	{"flat, open ends", 5, 16, false, false, flat, OPERATOR_SYMMETRIC, 0},
	{"flat, walls", 5, 17, true, true, flat, OPERATOR_SYMMETRIC, 0},
	{"rough bed", 8, 15, true, false, rough, OPERATOR_SYMMETRIC, 0},
	{"rough bed, many layers", 17, 20, true, true, rough, OPERATOR_SYMMETRIC, 0},
	{"face of a column", 9, 24, true, false, column_face, OPERATOR_SYMMETRIC, 0},
	{"face of a column, layers over a vector", 16, 23, true, true, column_face, OPERATOR_SYMMETRIC,
		0},
	{"dry faces in the middle", 7, 22, true, true, dry_middle, OPERATOR_SYMMETRIC, 0},
	{"dry ends", 4, 25, true, true, dry_ends, OPERATOR_SYMMETRIC, 0},
	{"nearly dry cells", 3, 18, true, true, nearly_dry, OPERATOR_SYMMETRIC, 0},
	{"all dry", 3, 9, true, true, all_dry, OPERATOR_SYMMETRIC, 0},
	{"two graded layers", 2, 9, true, true, rough, OPERATOR_SYMMETRIC, GRADED},
	{"graded layers, rough bed", 7, 15, true, false, rough, OPERATOR_SYMMETRIC, GRADED},
	{"graded layers, face of a column", 16, 23, true, true, column_face, OPERATOR_SYMMETRIC,
		GRADED},
	{"graded layers, dry middle", 9, 22, true, true, dry_middle, OPERATOR_SYMMETRIC, GRADED},
	{"ring, graded layers", 8, 24, false, false, wavy, OPERATOR_SYMMETRIC, RING | GRADED},
	{"ring, flat", 5, 16, false, false, flat, OPERATOR_SYMMETRIC, RING},
	{"ring of two cells", 3, 2, false, false, rough, OPERATOR_SYMMETRIC, RING},
	{"ring, one layer", 1, 33, false, false, rough, OPERATOR_SYMMETRIC, RING},
	{"ring, rough bed", 8, 15, false, false, rough, OPERATOR_SYMMETRIC, RING},
	{"ring, many layers", 17, 24, false, false, wavy, OPERATOR_SYMMETRIC, RING},
	{"ring, face of a column and one at the seam", 9, 40, false, false, column_face,
		OPERATOR_SYMMETRIC, RING},
	{"ring, dry seam", 4, 25, false, false, dry_ends, OPERATOR_SYMMETRIC, RING},
	{"ring, dry faces in the middle", 7, 22, false, false, dry_middle, OPERATOR_SYMMETRIC, RING},
	{"pointwise, flat", 5, 16, true, false, flat, OPERATOR_POINTWISE, 0},
	{"pointwise, slopes", 8, 24, true, true, wavy, OPERATOR_POINTWISE, 0},
	{"pointwise, rough bed", 8, 24, true, true, rough, OPERATOR_POINTWISE, WILD},
	{"pointwise, face of a column", 10, 23, true, false, column_face, OPERATOR_POINTWISE, 0},
	{"pointwise, dry ends", 3, 12, true, true, dry_ends, OPERATOR_POINTWISE, 0},
};

enum { PROBLEMS = sizeof problems / sizeof *problems, CELLS_MAX = 200, LAYERS_MAX = 20 };

/* Thicknesses in mean layers, from 1 : 3 of two to 1 : 20 of many; NULL: equal. */
static const double *shares_of(const struct problem *problem)
{
	static double shares[LAYERS_MAX];
	int n = problem->layers;

	if (!(problem->kind & GRADED))
		return NULL;
	for (int a = 0; a < n; a++)
		shares[a] = (2 * a + 1.0) / n;
	return shares;
}

static const struct pressure_operator *operator_of(const struct problem *problem)
{
	return problem->operator_ == OPERATOR_SYMMETRIC ? &operator_symmetric : &operator_pointwise;
}

/* A problem as a system. */
struct setup {
	struct grid grid;
	double h[CELLS_MAX + 2], b[CELLS_MAX + 2];
	bool dry[CELLS_MAX + 1];
	double *velocity; /* zeros */
	struct pressure_system system;
};

static void assemble(struct setup *setup, const struct problem *problem, bool bands)
{
	static double rows[6][CELLS_MAX + 2];
	double *const scratch[] = {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]};
	struct grid *grid = &setup->grid;
	struct error err = {0};

	assert_int_equal(
		pressure_system_init(&setup->system, problem->layers, grid->faces, bands, &err), 0);
	setup->system.symmetric = problem->operator_ == OPERATOR_SYMMETRIC;
	setup->system.periodic = (problem->kind & RING) != 0;
	pressure_system_set_shares(&setup->system, shares_of(problem));
	setup->system.cells.dry = setup->dry;
	setup->velocity = calloc((size_t)problem->layers * grid->stride, sizeof(double));
	assert_non_null(setup->velocity);
	operator_of(problem)->assemble(
		&(struct pressure_input){grid, problem->layers, 1, setup->h, setup->b, setup->velocity,
			setup->velocity, setup->dry, scratch},
		&setup->system);
	for (int f = 0; f < grid->faces; f++)
		setup->system.weight[f] =
			0.5 * (setup->h[f] + setup->h[f + 1]) * grid->dx / problem->layers;
	if (grid->periodic) {
		setup->system.weight[0] *= 0.5;
		setup->system.weight[grid->cells] *= 0.5;
	}
}

static void setup_init(struct setup *setup, const struct problem *problem, bool bands)
{
	struct grid *grid = &setup->grid;

	*setup = (struct setup){.grid = {.cells = problem->cells,
								.faces = problem->cells + 1,
								.stride = (size_t)problem->cells + 2,
								.dx = 0.005,
								.left_wall = problem->left_wall,
								.right_wall = problem->right_wall,
								.periodic = (problem->kind & RING) != 0}};
	problem->shape(grid->cells, setup->h + 1, setup->b + 1);
	grid_fill_even(grid, setup->h);
	grid_fill_even(grid, setup->b);
	for (int f = 0; f < grid->faces; f++)
		setup->dry[f] = setup->h[f] < DRY_NO_PRESSURE || setup->h[f + 1] < DRY_NO_PRESSURE;
	if (problem->operator_ == OPERATOR_SYMMETRIC && !(problem->kind & RING)) {
		setup->dry[0] |= !grid->left_wall;
		setup->dry[grid->cells] |= !grid->right_wall;
	}
	assemble(setup, problem, bands);
}

static void setup_clean(struct setup *setup)
{
	pressure_system_clean(&setup->system);
	free(setup->velocity);
}

/* Unknowns per layer: on a ring the last face is the first. */
static int width_of(const struct pressure_system *system)
{
	return system->periodic ? system->faces - 1 : system->faces;
}

static int count_of(const struct pressure_system *system)
{
	return system->layers * width_of(system);
}

/* Entry (i, j) of the matrix of the bands, faces by layers. */
static double entry_of_bands(const struct pressure_system *system, int i, int j)
{
	const double *const bands[3][3] = {
		{system->below_lower, system->below_diagonal, system->below_upper},
		{system->lower, system->diagonal, system->upper},
		{system->above_lower, system->above_diagonal, system->above_upper}};
	int up = j / system->faces - i / system->faces, right = j % system->faces - i % system->faces;

	return abs(up) > 1 || abs(right) > 1 ? 0 : bands[up + 1][right + 1][i];
}

/* Entry (i, j) of the matrix of the unknowns: that of the bands, and on a ring with the last row and column
 * of every layer added to its first. */
static double entry(const struct pressure_system *system, int i, int j)
{
	int width = width_of(system), last = system->faces - 1;
	int rows = system->periodic && i % width == 0 ? 2 : 1;
	int columns = system->periodic && j % width == 0 ? 2 : 1;
	double sum = 0;

	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			sum += entry_of_bands(system, i / width * system->faces + (r ? last : i % width),
				j / width * system->faces + (c ? last : j % width));
	return sum;
}

static void multiply(const struct pressure_system *system, const double *x, long double *out)
{
	int count = count_of(system);

	for (int i = 0; i < count; i++) {
		out[i] = 0;
		for (int j = 0; j < count; j++)
			out[i] += (long double)entry(system, i, j) * x[j];
	}
}

static void take(const struct pressure_system *system, double *x)
{
	int width = width_of(system);

	for (int i = 0; i < count_of(system); i++)
		x[i] = pressure_system_x(system, i / width)[i % width];
}

static void put(struct pressure_system *system, const double *x)
{
	int width = width_of(system);

	for (int i = 0; i < count_of(system); i++)
		pressure_system_x(system, i / width)[i % width] = x[i];
	for (int a = 0; a < system->layers && system->periodic; a++)
		pressure_system_x(system, a)[width] = pressure_system_x(system, a)[0];
}

/* The right side of every unknown; at a seam both of its faces have one half. */
static void take_right_side(const struct pressure_system *system, double *out)
{
	int width = width_of(system);

	for (int i = 0; i < count_of(system); i++) {
		const double *rhs = system->rhs + pressure_system_row(system, i / width);

		out[i] = rhs[i % width] + (system->periodic && i % width == 0 ? rhs[width] : 0);
	}
}

static void put_right_side(struct pressure_system *system, const long double *values)
{
	int width = width_of(system);

	for (int i = 0; i < count_of(system); i++) {
		double *rhs = system->rhs + pressure_system_row(system, i / width);

		rhs[i % width] = (double)values[i];
		if (system->periodic && i % width == 0)
			rhs[0] = rhs[width] = 0.5 * (double)values[i];
	}
}

static double norm(int count, const double *v)
{
	double sum = 0;

	for (int i = 0; i < count; i++)
		sum += v[i] * v[i];
	return sqrt(sum);
}

/* A known solution, zero on dry faces, and its right side into `system`, whose bands `banded` has. */
static void know(const struct pressure_system *banded, struct pressure_system *system, double *x)
{
	int count = count_of(banded);
	long double *product = calloc((size_t)count, sizeof *product);
	unsigned seed = 11;

	assert_non_null(product);
	for (int i = 0; i < count; i++)
		x[i] = banded->cells.dry[i % width_of(banded)] ? 0 : noise(&seed);
	multiply(banded, x, product);
	put_right_side(system, product);
	free(product);
}

/* |A^-1| in the maximum norm, by Gauss-Jordan elimination with pivots. */
static double norm_of_inverse(const struct pressure_system *system)
{
	size_t n = (size_t)count_of(system), wide = 2 * n;
	double *m = calloc(n * wide, sizeof *m), largest = 0;

	assert_non_null(m);
	for (size_t i = 0; i < n; i++) {
		for (size_t j = 0; j < n; j++)
			m[i * wide + j] = entry(system, (int)i, (int)j);
		m[i * wide + n + i] = 1;
	}
	for (size_t k = 0; k < n; k++) {
		size_t pivot = k;

		for (size_t i = k + 1; i < n; i++)
			if (fabs(m[i * wide + k]) > fabs(m[pivot * wide + k]))
				pivot = i;
		for (size_t j = 0; j < wide; j++) {
			double swap = m[k * wide + j];

			m[k * wide + j] = m[pivot * wide + j];
			m[pivot * wide + j] = swap;
		}
		assert_true(m[k * wide + k] != 0);
		for (size_t i = 0; i < n; i++) {
			double factor = m[i * wide + k] / m[k * wide + k];

			for (size_t j = k; j < wide && i != k && factor != 0; j++)
				m[i * wide + j] -= factor * m[k * wide + j];
		}
	}
	for (size_t i = 0; i < n; i++) {
		double sum = 0;

		for (size_t j = 0; j < n; j++)
			sum += fabs(m[i * wide + n + j] / m[i * wide + i]);
		largest = fmax(largest, sum);
	}
	free(m);
	return largest;
}

/* A method at work on a problem. */
struct work {
	const struct problem *problem;
	struct setup banded, own; /* the one that answers are checked with, the one that is solved */
	const struct pressure_solver *solver;
	void *memory;
	double *exact, *found;
};

static bool fits(int method, const struct problem *problem)
{
	return (problem->operator_ == OPERATOR_SYMMETRIC || !config_symmetric_only(method)) &&
		   (!(problem->kind & RING) || config_periodic_too(method));
}

static void work_init(struct work *work, int method, const struct problem *problem)
{
	bool symmetric = problem->operator_ == OPERATOR_SYMMETRIC;
	struct pressure_options options = {.threads = 1,
		.symmetric = symmetric,
		.periodic = (problem->kind & RING) != 0,
		.shares = shares_of(problem)};
	struct error err = {0};
	size_t count;

	*work = (struct work){.problem = problem, .solver = pressure_solver_find(method, symmetric)};
	setup_init(&work->banded, problem, true);
	setup_init(&work->own, problem, !work->solver->matrix_free);
	count = (size_t)count_of(&work->own.system);
	work->exact = calloc(count, sizeof *work->exact);
	work->found = calloc(count, sizeof *work->found);
	assert_true(work->exact && work->found);
	assert_int_equal(
		work->solver->create(problem->layers, work->own.grid.faces, &options, &work->memory, &err),
		0);
	know(&work->banded.system, &work->own.system, work->exact);
	know(&work->banded.system, &work->banded.system, work->exact);
}

static void work_clean(struct work *work)
{
	work->solver->free(work->memory);
	setup_clean(&work->own);
	setup_clean(&work->banded);
	free(work->exact);
	free(work->found);
}

/* |rhs - A x|/|rhs| of what was found, with the product of this file. */
static double residual_of(const struct work *work)
{
	int count = count_of(&work->own.system);
	long double *product = calloc((size_t)count, sizeof *product), sum = 0;
	double *rhs = calloc((size_t)count, sizeof *rhs), scale;

	assert_true(product && rhs);
	take_right_side(&work->own.system, rhs);
	scale = norm(count, rhs);
	multiply(&work->banded.system, work->found, product);
	for (int i = 0; i < count; i++)
		sum += (rhs[i] - product[i]) * (rhs[i] - product[i]);
	free(product);
	free(rhs);
	return scale > 0 ? (double)sqrtl(sum) / scale : (double)sqrtl(sum);
}

static double error_of(const struct work *work)
{
	double worst = 0;

	for (int i = 0; i < count_of(&work->own.system); i++)
		worst = fmax(worst, fabs(work->found[i] - work->exact[i]));
	return worst;
}

static void the_border_is_zero_and_the_seam_one(const struct pressure_system *system)
{
	for (int a = 0; a < system->layers && system->periodic; a++)
		assert_true(
			pressure_system_x(system, a)[0] == pressure_system_x(system, a)[system->faces - 1]);
	for (int a = -1; a <= system->layers; a++)
		for (int f = -1; f <= system->faces; f++)
			if (a == -1 || a == system->layers || f == -1 || f == system->faces)
				assert_true(pressure_system_x(system, a)[f] == 0);
}

/* Every method of the config's list on every problem that it is for. */
static void each(void (*check)(struct work *work))
{
	const char *const *names = field_find(&config_table, "pressure_solver.method")->choices;

	for (int method = 0; names[method]; method++)
		for (int p = 0; p < PROBLEMS; p++) {
			struct work work;

			if (!fits(method, &problems[p]))
				continue;
			print_message("# %s: %s\n", names[method], problems[p].name);
			work_init(&work, method, &problems[p]);
			check(&work);
			work_clean(&work);
		}
}

static void check_residual(struct work *work)
{
	const double wanted = 1e-9;
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, wanted, 100000};
	struct pressure_system *system = &work->own.system;
	double told;
	double rhs[LAYERS_MAX * (CELLS_MAX + 1)];
	int done = pressure_solver_solve(work->solver, system, &rule, work->memory, &told);

	if ((work->problem->kind & WILD) && done < 0) {
		assert_true(!(told <= wanted));
		return;
	}
	assert_true(done >= 0);
	take(system, work->found);
	the_border_is_zero_and_the_seam_one(system);
	/* double against long double: the sum of nine products of numbers up to the largest of A and x */
	assert_true(fabs(told - residual_of(work)) <= 1e-3 * wanted);
	assert_true(told <= wanted);
	/* e = A^-1 r, and no component of r is larger than its length */
	take_right_side(system, rhs);
	assert_true(error_of(work) <= 1.01 * wanted * norm_of_inverse(&work->banded.system) *
										  norm(count_of(system), rhs) +
									  1e-12);
}

static void the_residual_is_what_was_asked_for_and_the_error_follows(void **state)
{
	(void)state;
	each(check_residual);
}

static void check_increment(struct work *work)
{
	struct pressure_system *system = &work->own.system;
	int count = count_of(system);
	double *zeros = calloc((size_t)count, sizeof *zeros);

	assert_non_null(zeros);
	for (int kind = NORM_L1; kind <= NORM_LINF; kind++) {
		struct stopping_rule rule = {CRITERION_INCREMENT, kind, 1e-12, 0, 100000};
		double told;
		int done;

		put(system, zeros);
		done = pressure_solver_solve(work->solver, system, &rule, work->memory, &told);
		if ((work->problem->kind & WILD) && done < 0)
			continue;
		assert_true(done >= 0);
		take(system, work->found);
		/* the slowest of these iterations takes less than 1e-4 off its error at a time, so that what
		 * is left is some 1e4 increments; weights of nearly dry cells go down to 1e-8 */
		assert_true(error_of(work) < 1e-3);
		assert_true(fabs(told - residual_of(work)) <= 1e-3 * told + 1e-12);
	}
	free(zeros);
}

static void a_small_increment_means_a_small_error_in_every_norm(void **state)
{
	(void)state;
	each(check_increment);
}

static void check_start(struct work *work)
{
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, 1e-9, 100000};
	struct pressure_system *system = &work->own.system;
	double told;

	put(system, work->exact);
	assert_in_range(pressure_solver_solve(work->solver, system, &rule, work->memory, &told), 0, 1);
	take(system, work->found);
	assert_true(told <= 1e-9);
	assert_true(residual_of(work) <= 1e-9);
}

static void a_start_at_the_solution_takes_one_iteration_at_most(void **state)
{
	(void)state;
	each(check_start);
}

static void check_too_few(struct work *work)
{
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, 1e-9, 100000};
	struct pressure_system *system = &work->own.system;
	double told, *zeros = calloc((size_t)count_of(system), sizeof *zeros);
	int needed;

	assert_non_null(zeros);
	if (work->solver->kept) /* chooses anew at every solve */
		goto done;
	needed = work->solver->solve(system, &rule, work->memory);
	put(system, zeros);
	rule.max_iterations = needed - 1;
	if (needed > 1)
		assert_int_equal(
			pressure_solver_solve(work->solver, system, &rule, work->memory, &told), 1 - needed);
done:
	free(zeros);
}

static void one_iteration_too_few_is_told_as_a_negative_count(void **state)
{
	(void)state;
	each(check_too_few);
}

/* A face that is not dry, -1 if there is none. */
static int wet_face(const struct pressure_system *system)
{
	int f = system->faces - 1;

	while (f >= 0 && system->cells.dry[f])
		f--;
	return f;
}

static void refuses(struct work *work, int criterion, int kind)
{
	struct stopping_rule rule = {criterion, kind, 1e-6, 1e-8, 50};
	double told;

	put(&work->own.system, work->found); /* zeros */
	assert_true(
		pressure_solver_solve(work->solver, &work->own.system, &rule, work->memory, &told) < 0);
	assert_true(!(told <= 1e-8));
}

static void check_nan(struct work *work)
{
	struct pressure_system *system = &work->own.system;
	int wet = wet_face(system);

	if (wet < 0)
		return;
	system->rhs[pressure_system_row(system, system->layers - 1) + (size_t)wet] = NAN;
	for (int kind = NORM_L1; kind <= NORM_LINF; kind++) {
		refuses(work, CRITERION_RESIDUAL, kind);
		refuses(work, CRITERION_INCREMENT, kind);
	}
}

static void a_nan_in_the_right_side_is_not_convergence(void **state)
{
	(void)state;
	each(check_nan);
}

static void check_nan_matrix(struct work *work)
{
	struct pressure_system *system = &work->own.system;
	int wet = wet_face(system);

	if (wet < 0)
		return;
	if (system->diagonal)
		system->diagonal[wet] = NAN;
	if (system->symmetric) /* the cell to the left of the face, or to the right of the first */
		system->cells.inverse[wet > 0 ? wet : 1] = NAN;
	for (int kind = NORM_L1; kind <= NORM_LINF; kind++) {
		refuses(work, CRITERION_RESIDUAL, kind);
		refuses(work, CRITERION_INCREMENT, kind);
	}
}

static void a_nan_in_the_matrix_is_not_convergence(void **state)
{
	(void)state;
	each(check_nan_matrix);
}

static void check_zero(struct work *work)
{
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, 1e-8, 50};
	struct pressure_system *system = &work->own.system;
	double told;

	put(system, work->exact);
	memset(system->rhs, 0, (size_t)system->layers * (size_t)system->faces * sizeof *system->rhs);
	assert_int_equal(pressure_solver_solve(work->solver, system, &rule, work->memory, &told), 0);
	take(system, work->found);
	assert_true(told == 0);
	assert_true(norm(count_of(system), work->found) == 0);
}

static void a_zero_right_side_is_solved_by_zeros(void **state)
{
	(void)state;
	each(check_zero);
}

static void check_repeat(struct work *work)
{
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, 1e-9, 100000};
	struct pressure_system *system = &work->own.system;
	int count = count_of(system), done[2];
	double *first = calloc((size_t)count, sizeof *first), told;

	assert_non_null(first);
	for (int time = 0; time < 2 && !work->solver->kept; time++) {
		memset(work->found, 0, (size_t)count * sizeof *work->found);
		put(system, work->found);
		done[time] = pressure_solver_solve(work->solver, system, &rule, work->memory, &told);
		take(system, time ? work->found : first);
		assert_int_equal(done[time], done[0]);
	}
	if (!work->solver->kept)
		assert_memory_equal(first, work->found, (size_t)count * sizeof *first);
	free(first);
}

static void a_solve_leaves_nothing_behind_for_the_next(void **state)
{
	(void)state;
	each(check_repeat);
}

/* The two forms of a symmetric matrix, and the product by columns. */
static void the_cells_and_the_bands_are_one_matrix(void **state)
{
	static double rows[2][LAYERS_MAX * (CELLS_MAX + 1)];

	(void)state;
	for (int p = 0; p < PROBLEMS; p++) {
		struct setup setup;
		struct pressure_system *system = &setup.system;

		if (problems[p].operator_ != OPERATOR_SYMMETRIC || (problems[p].kind & RING))
			continue;
		setup_init(&setup, &problems[p], true);
		int count = count_of(system);
		struct column_layout columns = columns_make(system->layers, system->faces);
		size_t all = columns_count(&columns);
		double *x = calloc((size_t)count, sizeof *x), *in, *out, *sums;
		double relative[2], dot = 0, largest = 0;

		in = calloc(all, sizeof *in);
		out = calloc(all, sizeof *out);
		sums = calloc((size_t)columns.groups, sizeof *sums);
		assert_true(x && in && out && sums);
		know(system, system, x);
		for (int i = 0; i < count; i++)
			x[i] *= 0.5;
		put(system, x);
		for (int form = 0; form < 2; form++) {
			system->symmetric = form;
			relative[form] = pressure_system_residual_rows(system, rows[form]);
		}
		for (int i = 0; i < count; i++)
			largest = fmax(largest, fabs(system->rhs[i]));
		/* half of the right side is left; both are sums of at most nine products each */
		assert_true(largest == 0 || fabs(relative[0] - 0.5) < 1e-12);
		assert_true(fabs(relative[0] - relative[1]) < 1e-13);
		columns_from_rows(
			&columns, pressure_system_x(system, 0), system->x_stride, in, 0, columns.groups);
		columns_apply(&columns, system, in, out, sums, 0, columns.groups);
		for (int g = 0; g < columns.groups; g++)
			dot += sums[g];
		for (int i = 0; i < count; i++) {
			int a = i / system->faces, f = i % system->faces;
			double product = out[(size_t)f * columns.stride + (size_t)a];

			assert_true(fabs(rows[0][i] - rows[1][i]) <= 1e-13 * largest);
			assert_true(fabs(product - (system->rhs[i] - rows[0][i])) <= 1e-13 * largest);
			dot -= x[i] * (system->rhs[i] - rows[0][i]);
		}
		/* rounding of a sum of `count` terms up to the largest */
		assert_true(fabs(dot) <= 1e-14 * count * largest);
		free(x);
		free(in);
		free(out);
		free(sums);
		setup_clean(&setup);
	}
}

static void the_config_knows_what_each_method_is_for(void **state)
{
	const char *const *names = field_find(&config_table, "pressure_solver.method")->choices;

	(void)state;
	for (int method = 0; names[method]; method++) {
		assert_string_equal(pressure_solver_find(method, true)->name, names[method]);
		assert_int_equal(pressure_solver_find(method, true)->method, method);
		assert_int_equal(
			config_symmetric_only(method), pressure_solver_find(method, false)->symmetric_only);
		assert_int_equal(config_periodic_too(method), pressure_solver_find(method, true)->periodic);
	}
}

/* The two forms of the paper's iteration differ by rounding alone. */
static void factored_blocks_make_the_same_iterates(void **state)
{
	(void)state;
	for (int p = 0; p < PROBLEMS; p++) {
		struct work plain, factored;
		double largest = 1;
		struct stopping_rule rule = {CRITERION_INCREMENT, NORM_L2, 0, 0, 7};

		if (!fits(METHOD_BLOCK_GAUSS_SEIDEL, &problems[p]))
			continue;
		work_init(&plain, METHOD_BLOCK_GAUSS_SEIDEL, &problems[p]);
		work_init(&factored, METHOD_BLOCK_GAUSS_SEIDEL_FACTORED, &problems[p]);
		(void)plain.solver->solve(&plain.own.system, &rule, plain.memory);
		(void)factored.solver->solve(&factored.own.system, &rule, factored.memory);
		take(&plain.own.system, plain.found);
		take(&factored.own.system, factored.found);
		for (int i = 0; i < count_of(&plain.own.system); i++)
			largest = fmax(largest, fabs(plain.found[i]));
		for (int i = 0; i < count_of(&plain.own.system); i++)
			assert_true(fabs(plain.found[i] - factored.found[i]) <= 1e-11 * largest);
		work_clean(&plain);
		work_clean(&factored);
	}
}

/* A sweep solves a line exactly, so that the second has nothing to add. */
static void one_layer_is_solved_by_the_first_sweep(void **state)
{
	static const int methods[] = {METHOD_BLOCK_GAUSS_SEIDEL, METHOD_BLOCK_GAUSS_SEIDEL_FACTORED,
		METHOD_RED_BLACK_LINE_RELAXATION};
	struct stopping_rule rule = {CRITERION_INCREMENT, NORM_L2, 1e-12, 0, 10};

	(void)state;
	for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
		const struct problem line = {"", 1, 33, true, true, rough, OPERATOR_SYMMETRIC, 0};
		struct work work;

		work_init(&work, methods[i], &line);
		assert_int_equal(work.solver->solve(&work.own.system, &rule, work.memory), 2);
		work_clean(&work);
	}
}

static void the_norms_ask_for_different_numbers_of_sweeps(void **state)
{
	const struct problem thin = {"", 8, 40, true, true, wavy, OPERATOR_SYMMETRIC, 0};
	int sweeps[NORM_LINF + 1];

	(void)state;
	for (int kind = NORM_L1; kind <= NORM_LINF; kind++) {
		struct stopping_rule rule = {CRITERION_INCREMENT, kind, 1e-6, 0, 10000};
		struct work work;

		work_init(&work, METHOD_BLOCK_GAUSS_SEIDEL, &thin);
		sweeps[kind] = work.solver->solve(&work.own.system, &rule, work.memory);
		work_clean(&work);
	}
	/* the area of the layers is 0.01 m2: a mean over it is less than the largest increment, and a mean
	 * of squares that is less than 1 has a root above it */
	assert_true(sweeps[NORM_L1] > 0);
	assert_true(sweeps[NORM_L1] < sweeps[NORM_L2]);
	assert_true(sweeps[NORM_L2] < sweeps[NORM_LINF]);
}

/* Columns of a system, random but for dry ones. */
static double *random_columns(
	const struct column_layout *columns, const struct pressure_system *system)
{
	double *x = calloc(columns_count(columns), sizeof *x);
	unsigned seed = 19;

	assert_non_null(x);
	for (int f = 0; f < columns->faces; f++)
		for (int a = 0; a < columns->layers; a++)
			x[(size_t)f * columns->stride + (size_t)a] = system->cells.dry[f] ? 0 : noise(&seed);
	return x;
}

static double largest_of(const double *v, size_t count)
{
	double largest = 0;

	for (size_t i = 0; i < count; i++)
		largest = fmax(largest, fabs(v[i]));
	return largest;
}

/* At every strip: zero inside, beside it the product of the new x, and nothing else touched. */
static void strips_take_the_product_out_of_the_steep_columns_alone(void **state)
{
	const struct problem problem = {"", 10, 190, true, false, three_faces, OPERATOR_SYMMETRIC, 0};
	struct column_layout columns = columns_make(problem.layers, problem.cells + 1);
	size_t group = LANES * columns.stride, all = columns_count(&columns);
	double *x, *old, product[25000], again[25000], sums[32], sums_again[32], largest;
	struct strips strips;
	struct setup setup;
	struct error err = {0};

	(void)state;
	assert_true(all <= sizeof product / sizeof *product && columns.groups <= 32);
	setup_init(&setup, &problem, false);
	assert_int_equal(strips_init(&strips, problem.layers, columns.faces, &err), 0);
	strips_factor(&strips, &setup.system);
	assert_int_equal(strips.count, 3);
	assert_int_equal(strips.strips[2].last, columns.groups);
	x = random_columns(&columns, &setup.system);
	old = random_columns(&columns, &setup.system);
	columns_apply(&columns, &setup.system, x, product, sums, 0, columns.groups);
	largest = largest_of(product, (size_t)columns.groups * group);
	strips_correct(&strips, &setup.system, x, product, sums);
	columns_apply(&columns, &setup.system, x, again, sums_again, 0, columns.groups);
	for (int g = 0; g < columns.groups; g++) {
		bool inside = false;

		for (int i = 0; i < strips.count; i++)
			inside |= strips.strips[i].first <= g && g < strips.strips[i].last;
		for (size_t k = (size_t)g * group;
			 k < (size_t)(g + 1) * group && k < (size_t)columns.faces * columns.stride; k++)
			if (inside)
				assert_true(product[k] == 0 && fabs(again[k]) <= 1e-11 * largest);
			else
				assert_true(product[k] == again[k] && x[k] == old[k]);
		assert_true(sums[g] == (inside ? 0 : sums_again[g]));
	}
	free(x);
	free(old);
	strips_clean(&strips);
	setup_clean(&setup);
}

/* Without strips it takes 78 iterations with 20 layers and 184 cells. */
static void a_steep_face_takes_conjugate_gradients_few_iterations(void **state)
{
	static const struct {
		int layers, cells;
		void (*shape)(int cells, double *h, double *b);
	} cases[] = {{20, 184, column_face}, {20, 60, column_face}, {5, 184, column_face},
		{10, 190, three_faces}};
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, 1e-8, 1000};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		const struct problem face = {"", cases[i].layers, cases[i].cells, true, false,
			cases[i].shape, OPERATOR_SYMMETRIC, 0};
		struct setup setup;
		struct pressure_options options = {.threads = 1, .symmetric = true};
		struct error err = {0};
		void *memory;
		unsigned seed = 5;
		int done;

		setup_init(&setup, &face, false);
		for (int k = 0; k < count_of(&setup.system); k++)
			setup.system.rhs[k] = setup.dry[k % setup.grid.faces] ? 0 : noise(&seed);
		assert_int_equal(
			conjugate_gradients.create(face.layers, setup.grid.faces, &options, &memory, &err), 0);
		done = conjugate_gradients.solve(&setup.system, &rule, memory);
		print_message("# %d layers, %d cells: %d\n", face.layers, face.cells, done);
		assert_in_range(done, 1, 12);
		assert_true(pressure_system_residual(&setup.system) <= 1e-8);
		conjugate_gradients.free(memory);
		setup_clean(&setup);
	}
}

/* Iterations of conjugate gradients on waves, between walls or on a ring. */
static int iterations_of(int kind)
{
	const struct problem problem = {
		"", 17, 60, !(kind & RING), !(kind & RING), wavy, OPERATOR_SYMMETRIC, kind};
	struct stopping_rule rule = {CRITERION_RESIDUAL, NORM_L2, 0, 1e-8, 1000};
	struct work work;
	int done;

	work_init(&work, METHOD_CONJUGATE_GRADIENTS, &problem);
	done = work.solver->solve(&work.own.system, &rule, work.memory);
	print_message("# %d\n", done);
	work_clean(&work);
	return done;
}

/* With the two sides of the seam put together as they come from between walls a ring takes 27 instead of 13,
 * and graded layers with the modes of equal ones 117. */
static void rings_and_graded_layers_take_conjugate_gradients_few_iterations_too(void **state)
{
	int plain = iterations_of(0);

	(void)state;
	assert_in_range(iterations_of(RING), 1, plain + 2);
	assert_in_range(iterations_of(GRADED), 1, plain + 2);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_config_knows_what_each_method_is_for),
		cmocka_unit_test(the_cells_and_the_bands_are_one_matrix),
		cmocka_unit_test(the_residual_is_what_was_asked_for_and_the_error_follows),
		cmocka_unit_test(a_small_increment_means_a_small_error_in_every_norm),
		cmocka_unit_test(a_start_at_the_solution_takes_one_iteration_at_most),
		cmocka_unit_test(one_iteration_too_few_is_told_as_a_negative_count),
		cmocka_unit_test(a_nan_in_the_right_side_is_not_convergence),
		cmocka_unit_test(a_nan_in_the_matrix_is_not_convergence),
		cmocka_unit_test(a_zero_right_side_is_solved_by_zeros),
		cmocka_unit_test(a_solve_leaves_nothing_behind_for_the_next),
		cmocka_unit_test(factored_blocks_make_the_same_iterates),
		cmocka_unit_test(one_layer_is_solved_by_the_first_sweep),
		cmocka_unit_test(the_norms_ask_for_different_numbers_of_sweeps),
		cmocka_unit_test(strips_take_the_product_out_of_the_steep_columns_alone),
		cmocka_unit_test(a_steep_face_takes_conjugate_gradients_few_iterations),
		cmocka_unit_test(rings_and_graded_layers_take_conjugate_gradients_few_iterations_too),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
