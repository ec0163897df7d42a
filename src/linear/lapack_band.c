/* A direct solution by LAPACK's band routines, through LAPACKE: the reference for our own direct method.
 * The unknowns go by columns, so that the band reaches layers + 1 to either side; dpbtrf for the
 * symmetric operator, dgbtrf with pivots for another.
 *
 * The library is loaded when the method is chosen: linked, OpenBLAS would cost every process that
 * starts some milliseconds. Its kernels are those of the processor, so that here, and nowhere else,
 * the bits depend on the machine. It always works in one thread. */
#include <dlfcn.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/arrays.h"
#include "linear/pressure_solver.h"

struct memory {
	void *library;
	struct {
		__typeof__(LAPACKE_dpbtrf) *dpbtrf;
		__typeof__(LAPACKE_dpbtrs) *dpbtrs;
		__typeof__(LAPACKE_dgbtrf) *dgbtrf;
		__typeof__(LAPACKE_dgbtrs) *dgbtrs;
	} lapack;
	bool symmetric;
	lapack_int count, reach, height; /* unknowns, band on either side, stored diagonals */
	double *band;                    /* [count][height], LAPACK's column-major band storage */
	double *right;                   /* [faces][layers], right side, then solution */
	double *rows;                    /* [layers][faces], residual */
	lapack_int *pivots;              /* [count]; none when symmetric */
	void *block;
};

static int find(struct memory *m, const char *name, void **function, struct error *err)
{
	*function = dlsym(m->library, name);
	return *function ? 0
					 : error_set(err, EX_UNAVAILABLE, "pressure_solver.method: lapack-band: %s",
						   dlerror());
}

static int load(struct memory *m, struct error *err)
{
	struct {
		const char *name;
		void **function;
	} const wanted[] = {{"LAPACKE_dpbtrf", (void **)&m->lapack.dpbtrf},
		{"LAPACKE_dpbtrs", (void **)&m->lapack.dpbtrs},
		{"LAPACKE_dgbtrf", (void **)&m->lapack.dgbtrf},
		{"LAPACKE_dgbtrs", (void **)&m->lapack.dgbtrs}};

	(void)setenv("OPENBLAS_NUM_THREADS", "1", 1); /* read once, when it is loaded */
	m->library = dlopen("liblapacke.so.3", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
	if (!m->library)
		return error_set(err, EX_UNAVAILABLE,
			"pressure_solver.method: lapack-band needs Debian's liblapacke and "
			"libopenblas0-serial: %s",
			dlerror());
	for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
		TRY(find(m, wanted[i].name, wanted[i].function, err));
	return 0;
}

static void destroy(void *memory)
{
	struct memory *m = memory;

	if (!m)
		return;
	if (m->library)
		(void)dlclose(m->library);
	free(m->block);
	free(m);
}

static int allocate(struct memory *m, struct error *err)
{
	size_t count = (size_t)m->count, height = (size_t)m->height;

	return arrays_allocate(
		(struct arrays_part[]){ARRAY(m->band, count * height), ARRAY(m->right, count),
			ARRAY(m->rows, count), ARRAY(m->pivots, m->symmetric ? 0 : count), {0}},
		&m->block, err);
}

static int create(
	int layers, int faces, const struct pressure_options *options, void **out, struct error *err)
{
	struct memory *m = calloc(1, sizeof *m);

	if (!m)
		return error_memory(err, sizeof *m);
	m->symmetric = options->symmetric;
	m->count = layers * faces;
	m->reach = layers + 1;
	m->height = m->symmetric ? m->reach + 1 : 3 * m->reach + 1; /* room for what pivots fill in */
	if (load(m, err) != 0) {
		destroy(m);
		return -1;
	}
	if (allocate(m, err) != 0) {
		destroy(m);
		return pressure_solver_too_large(lapack_band.name, layers, faces, err);
	}
	*out = m;
	return 0;
}

/* Entry (i, j) of the matrix is in row `above` + i - j of column j; of a symmetric one i >= j. */
static void take_matrix(struct memory *m, const struct pressure_system *system)
{
	const double *const bands[3][3] = {
		{system->below_lower, system->below_diagonal, system->below_upper},
		{system->lower, system->diagonal, system->upper},
		{system->above_lower, system->above_diagonal, system->above_upper}};
	ptrdiff_t above = m->symmetric ? 0 : 2 * (ptrdiff_t)m->reach;

	memset(m->band, 0, (size_t)m->count * (size_t)m->height * sizeof *m->band);
	for (int a = 0; a < system->layers; a++)
		for (int f = 0; f < system->faces; f++)
			for (int i = 0; i < 9; i++) {
				int up = i / 3 - 1, right = i % 3 - 1;
				ptrdiff_t back = -((ptrdiff_t)right * system->layers + up);
				ptrdiff_t column = (ptrdiff_t)f * system->layers + a - back;

				if (a + up < 0 || a + up >= system->layers || f + right < 0 ||
					f + right >= system->faces || (m->symmetric && back < 0))
					continue;
				m->band[column * m->height + above + back] =
					bands[up + 1][right + 1][pressure_system_row(system, a) + (size_t)f];
			}
}

static lapack_int factor(struct memory *m)
{
	if (m->symmetric)
		return m->lapack.dpbtrf(LAPACK_COL_MAJOR, 'L', m->count, m->reach, m->band, m->height);
	return m->lapack.dgbtrf(
		LAPACK_COL_MAJOR, m->count, m->count, m->reach, m->reach, m->band, m->height, m->pivots);
}

/* The correction for the residual in `rows`, added to the solution. */
static lapack_int correct(struct memory *m, struct pressure_system *system)
{
	size_t layers = (size_t)system->layers, faces = (size_t)system->faces;
	lapack_int info;

	for (size_t a = 0; a < layers; a++)
		for (size_t f = 0; f < faces; f++)
			m->right[f * layers + a] = m->rows[a * faces + f];
	info = m->symmetric ? m->lapack.dpbtrs(LAPACK_COL_MAJOR, 'L', m->count, m->reach, 1, m->band,
							  m->height, m->right, m->count)
						: m->lapack.dgbtrs(LAPACK_COL_MAJOR, 'N', m->count, m->reach, m->reach, 1,
							  m->band, m->height, m->pivots, m->right, m->count);
	for (size_t a = 0; a < layers && info == 0; a++)
		for (size_t f = 0; f < faces; f++)
			pressure_system_x(system, (int)a)[f] += m->right[f * layers + a];
	return info;
}

/* A second iteration takes back the rounding of the first, where that is asked for. */
static int solve(struct pressure_system *system, const struct stopping_rule *rule, void *memory)
{
	struct memory *m = memory;
	double last = INFINITY, left;

	take_matrix(m, system);
	if (factor(m) != 0)
		return -1;
	for (int a = 0; a < system->layers; a++)
		memset(pressure_system_x(system, a), 0, (size_t)system->faces * sizeof(double));
	memcpy(m->rows, system->rhs, (size_t)m->count * sizeof *m->rows);
	for (int done = 1;; done++) {
		if (correct(m, system) != 0)
			return -done;
		left = pressure_system_residual_rows(system, m->rows);
		if (left <= rule->residual || (rule->criterion != CRITERION_RESIDUAL && !isnan(left)))
			return done;
		if (done == rule->max_iterations || !(left < 0.5 * last)) /* nor a NaN */
			return -done;
		last = left;
	}
}

const struct pressure_solver lapack_band = {
	.name = "lapack-band",
	.method = METHOD_LAPACK_BAND,
	.create = create,
	.solve = solve,
	.free = destroy,
};
