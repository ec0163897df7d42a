/* The dry model as a row of the table of models: memory, the time step, and the step. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "case/initial.h"
#include "case/topography.h"
#include "dry/chunk.h"
#include "dry/dry.h"

#define GRAVITY 9.81 /* m/s2 */

static const struct pressure_operator *const operators[] = {
	[OPERATOR_SYMMETRIC] = &operator_symmetric,
	[OPERATOR_POINTWISE] = &operator_pointwise,
};

static struct dry_parameters parameters(const struct config *config)
{
	return (struct dry_parameters){
		/* in long double: cos and tan in double are chosen by processor and differ in bits */
		.gc = config->coordinates == COORDINATES_CARTESIAN ? GRAVITY
														   : GRAVITY * (double)cosl(config->slope),
		.tan_slope = (double)tanl(config->slope),
		.rho = config->grains.solid_fraction * config->grains.density,
		.mu_s = config->rheology.mu_s,
		.mu_2 =
			config->rheology.law == LAW_CONSTANT ? config->rheology.mu_s : config->rheology.mu_2,
		.i_0 = config->rheology.i_0,
		.inertia = config->grains.diameter / sqrt(config->grains.solid_fraction),
		.delta_strain = config->regularisation.strain_rate,
		.delta_velocity = config->regularisation.velocity,
		.largest_viscosity = config->regularisation.largest_viscosity,
		.walls = 2 * config->walls.mu_w / config->walls.width,
		.bottom_gap = config->bottom == BOTTOM_NO_SLIP ? 0.5 : 1,
		.friction = {.no_slip = config->bottom == BOTTOM_NO_SLIP,
			.second_order = config->rheology.strain_rate == STRAIN_RATE_SECOND_ORDER,
			.bounded = config->regularisation.viscosity == VISCOSITY_BOUNDED,
			.walls = config->walls.mu_w > 0},
		.bed = config_bed_thickness(config),
		.cfl = config->time.cfl,
		.front_threshold = config->output.front_threshold,
		.static_speed = config->output.static_speed,
		.fastest = config->time.wave_speed == WAVE_SPEED_FASTEST,
		.reconstruction = config->scheme.friction_reconstruction,
		.upwind = config->scheme.exchange == EXCHANGE_UPWIND,
		.coulomb = config->scheme.friction == FRICTION_COULOMB,
		.plain_thickness = config->scheme.friction_thickness == THICKNESS_PLAIN,
		.viscosity_updates = config->scheme.viscosity_updates,
		.non_hydrostatic = config->pressure == PRESSURE_NON_HYDROSTATIC,
	};
}

/* One block for all fields; `place` hands out its parts. */
static double *place(double **next, size_t count)
{
	double *part = *next;

	if (*next)
		*next += count;
	return part;
}

static size_t layout(struct model_state *s, bool cartesian, double *memory)
{
	size_t stride = s->grid.stride, faces = (size_t)s->grid.faces, n = (size_t)s->layers;
	size_t coarse = (size_t)s->coarse.layers, before = s->par.viscosity_updates > 0 ? n : 0;
	double *next = memory;

	s->h = place(&next, stride);
	s->b = place(&next, stride);
	s->bed = cartesian ? place(&next, stride) : s->b;
	s->U = place(&next, n * stride);
	s->W = place(&next, n * stride);
	s->u = place(&next, n * stride);
	s->w = place(&next, n * stride);
	s->q = place(&next, n * faces);
	s->dq = place(&next, n * faces);
	s->mass = place(&next, 2);
	s->mean = place(&next, stride);
	s->fastest = place(&next, stride);
	s->squares = place(&next, stride);
	s->next = place(&next, stride);
	for (size_t i = 0; i < sizeof s->face / sizeof *s->face; i++)
		s->face[i] = place(&next, faces);
	s->work = place(&next, n * stride);
	s->before = before ? place(&next, before * stride) : NULL;
	s->level = place(&next, n + 1);
	s->x = place(&next, stride);
	s->layer_middle = place(&next, n);
	s->layer_interface = place(&next, n + 1);
	s->steady_u = place(&next, n);
	s->steady_strain = place(&next, n + 1);
	s->steady_mu = place(&next, n + 1);
	s->coarse.u = coarse ? place(&next, coarse * stride) : NULL;
	s->coarse.w = coarse ? place(&next, coarse * stride) : NULL;
	return (7 + cartesian + 5 * n + before + 2 * coarse) * stride + (6 + 2 * n) * faces + 6 * n + 6;
}

/* Each layer of a projection is as many of the model. */
static int projection_init(struct model_state *s, const struct config *config,
	struct projection *problem, struct error *err)
{
	size_t merged = (size_t)(s->layers / problem->layers);
	const struct pressure_options options = {.relaxation = config->pressure_solver.relaxation,
		.threads = s->threads,
		.symmetric = s->operator_->symmetric,
		.periodic = s->grid.periodic,
		.shares = config->layer_fractions.count ? s->work : NULL};

	for (size_t a = 0; a < (size_t)problem->layers; a++) /* `work` has no other use yet */
		s->work[a] = (s->level[(a + 1) * merged] - s->level[a * merged]) / (double)merged;

	TRY(pressure_system_init(
		&problem->system, problem->layers, s->grid.faces, !s->solver->matrix_free, err));
	problem->system.symmetric = s->operator_->symmetric;
	problem->system.periodic = s->grid.periodic;
	pressure_system_set_shares(&problem->system, options.shares);
	return s->solver->create(problem->layers, s->grid.faces, &options, &problem->memory, err);
}

static void destroy(struct model_state *s)
{
	if (!s)
		return;
	struct projection *const problems[] = {&s->full, &s->coarse};

	for (size_t i = 0; i < 2; i++) {
		pressure_system_clean(&problems[i]->system);
		s->solver->free(problems[i]->memory);
	}
	free(s->dry);
	free(s->memory);
	free(s);
}

/* The interfaces, from the fractions; exact where these are equal. */
static void fill_levels(struct model_state *s, const struct real_list *fractions)
{
	double sum = 0, below = 0;

	for (int a = 0; a < fractions->count; a++)
		sum += fractions->values[a];
	for (int a = 0; a <= s->layers; a++) {
		s->level[a] = fractions->count && a < s->layers ? below / sum * s->layers : a;
		below += a < fractions->count ? fractions->values[a] : 0;
		s->layer_interface[a] = s->level[a] / s->layers;
	}
	for (int a = 0; a < s->layers; a++)
		s->layer_middle[a] = 0.5 * (s->level[a] + s->level[a + 1]) / s->layers;
}

/* In Cartesian coordinates the plane is a part of the bed (P2 4.1); it goes on beyond the ends. */
static void add_plane(struct model_state *s, const struct config *config)
{
	for (int i = 0; i <= s->grid.cells + 1; i++)
		s->bed[i] = s->b[i] + topography_plane(config, grid_centre(&s->grid, i));
}

static void open_gate(struct model_state *s, const struct config *config)
{
	for (int a = 0; a < s->layers; a++)
		for (int i = 1; i <= s->grid.cells; i++)
			s->W[(size_t)a * s->grid.stride + (size_t)i] =
				s->h[i] * initial_velocity(config, grid_centre(&s->grid, i));
	dry_velocities(s);
}

static int fill(struct model_state *s, const struct config *config, struct error *err)
{
	double mass = 0;

	TRY(initial_fill(config, &s->grid, s->b, s->h, err));
	if (s->bed != s->b)
		add_plane(s, config);
	for (int i = 1; i <= s->grid.cells; i++) {
		s->x[i - 1] = grid_centre(&s->grid, i);
		mass += s->h[i];
	}
	s->mass[0] = s->par.rho * mass * s->grid.dx;
	dry_exact(s, config->initial.shape == SHAPE_UNIFORM ? s->h[1] : NAN, s->steady_u,
		s->steady_strain, s->steady_mu);
	if (config->gate.speed != 0)
		open_gate(s, config);
	dry_check_begin(s, config);
	return 0;
}

static int create(const struct config *config, struct model_state **out, struct error *err)
{
	struct model_state *s = calloc(1, sizeof *s);
	bool cartesian = config->coordinates == COORDINATES_CARTESIAN;
	size_t count;

	if (!s)
		return error_memory(err, sizeof *s);
	s->par = parameters(config);
	s->grid = grid_make(config);
	s->layers = s->full.layers = config->layers;
	dry_note_remedy(s, config);
	s->threads = config->threads;
	s->chunk_cells = chunk_cells(s->layers);
	s->operator_ = operators[config->pressure_solver.operator_];
	s->solver = pressure_solver_find(config->pressure_solver.method, s->operator_->symmetric);
	s->rule = (struct stopping_rule){.criterion = config->pressure_solver.criterion,
		.norm = config->pressure_solver.norm,
		.tolerance = config->pressure_solver.tolerance,
		.residual = config->pressure_solver.residual,
		.max_iterations = config->pressure_solver.max_iterations};
	s->start_previous = config->pressure_solver.start == START_PREVIOUS;
	s->coarse.layers = s->par.non_hydrostatic ? config->n_ini_guess : 0;
	count = layout(s, cartesian, NULL);
	s->memory = calloc(count, sizeof *s->memory);
	s->dry = calloc((size_t)s->grid.faces, sizeof *s->dry);
	if (!s->memory || !s->dry) {
		destroy(s);
		return error_memory(err, count * sizeof *s->memory);
	}
	(void)layout(s, cartesian, s->memory);
	fill_levels(s, &config->layer_fractions);
	if ((s->par.non_hydrostatic && projection_init(s, config, &s->full, err)) ||
		(s->coarse.layers && projection_init(s, config, &s->coarse, err)) || fill(s, config, err)) {
		destroy(s);
		return -1;
	}
	*out = s;
	return 0;
}

/* Velocities of a layer of thickness `layer` (in mean ones), and what they add to the sums over the
 * layers; w is 0 and stays so where the pressure is hydrostatic. */
KERNEL_PART void layer_velocities(int cells, bool hydrostatic, double layer,
	const double *restrict inverse, const double *restrict U, const double *restrict W,
	double *restrict u, double *restrict w, double *restrict sum, double *restrict fastest,
	double *restrict squares)
{
	for (int k = 0; k < cells; k++) {
		double along = U[k] * inverse[k], normal = hydrostatic ? 0 : W[k] * inverse[k];
		double speed = fabs(along);

		u[k] = along;
		if (!hydrostatic)
			w[k] = normal;
		sum[k] += layer * along;
		fastest[k] = speed > fastest[k] ? speed : fastest[k];
		squares[k] += layer * (along * along + normal * normal);
	}
}

KERNEL static void velocities(struct model_state *s, struct chunk chunk, double dt)
{
	size_t row = (size_t)chunk.first, bytes;
	const double *restrict h = s->h + row;
	double *restrict mean = s->mean + row;
	double *restrict fastest = s->fastest + row, *restrict squares = s->squares + row;
	double inverse[CHUNK_CELLS];
	int cells = chunk.last - chunk.first + 1;

	(void)dt;
	bytes = (size_t)cells * sizeof *mean;
	memset(mean, 0, bytes);
	memset(fastest, 0, bytes);
	memset(squares, 0, bytes);
	for (int k = 0; k < cells; k++)
		inverse[k] = h[k] > DRY_NO_MOMENTUM ? 1 / h[k] : 0;
	for (int a = 0; a < s->layers; a++, row += s->grid.stride) {
		double layer = dry_layer(s, a);

		if (s->par.non_hydrostatic)
			layer_velocities(cells, false, layer, inverse, s->U + row, s->W + row, s->u + row,
				s->w + row, mean, fastest, squares);
		else
			layer_velocities(cells, true, layer, inverse, s->U + row, s->W + row, s->u + row,
				s->w + row, mean, fastest, squares);
	}
	for (int k = 0; k < cells; k++)
		mean[k] /= s->layers;
}

void dry_velocities(struct model_state *s)
{
	chunk_each(s, velocities, 0);
	grid_fill_odd(&s->grid, s->mean);
	grid_fill_even(&s->grid, s->fastest);
	for (int a = 0; a < s->layers; a++) {
		grid_fill_odd(&s->grid, s->u + (size_t)a * s->grid.stride);
		grid_fill_even(&s->grid, s->w + (size_t)a * s->grid.stride);
	}
}

KERNEL_PART void scale(int cells, const double *restrict factor, double *restrict discharge)
{
	for (int k = 0; k < cells; k++)
		discharge[k] *= factor[k];
}

KERNEL static void damp(struct model_state *s, struct chunk chunk, double dt)
{
	const double *restrict h = s->h + chunk.first;
	int cells = chunk.last - chunk.first + 1, thin = 0;
	size_t row = (size_t)chunk.first, stride = s->grid.stride;
	double factor[CHUNK_CELLS];

	(void)dt;
	for (int k = 0; k < cells; k++)
		thin |= h[k] < DRY_NO_PRESSURE;
	if (!thin)
		return;
	for (int k = 0; k < cells; k++) {
		double h2 = h[k] * h[k], slow = sqrt(2) * h2 / __builtin_sqrt(h2 * h2 + 1e-20);

		factor[k] = h[k] >= DRY_NO_PRESSURE ? 1 : h[k] < DRY_NO_MOMENTUM ? 0 : slow;
	}
	for (int a = 0; a < s->layers; a++, row += stride) {
		scale(cells, factor, s->U + row);
		if (s->par.non_hydrostatic)
			scale(cells, factor, s->W + row);
	}
}

void dry_damp(struct model_state *s)
{
	chunk_each(s, damp, 0);
}

/* P1 (14), with either reading of the wave speed. */
static double time_step(const struct model_state *s)
{
	double fastest = 0;

	for (int i = 1; i <= s->grid.cells; i++) {
		double speed = s->par.fastest ? s->fastest[i] : fabs(s->mean[i]);
		double lambda = speed + sqrt(s->par.gc * s->h[i]);

		if (isnan(s->mean[i] + lambda)) /* the fastest layer passes over a NaN */
			return NAN;
		fastest = lambda > fastest ? lambda : fastest;
	}
	return s->par.cfl * s->grid.dx / fastest;
}

static int step(struct model_state *s, double dt, struct error *err)
{
	double at[4];

	at[0] = clock_cpu();
	dry_transport(s, dt);
	at[1] = clock_cpu();
	dry_friction(s, dt);
	dry_damp(s);
	at[2] = at[3] = clock_cpu();
	if (s->par.non_hydrostatic) {
		TRY(dry_pressure(s, dt, err));
		dry_damp(s);
		at[3] = clock_cpu();
	}
	for (int i = 0; i < 3; i++)
		s->cpu[i] = at[i + 1] - at[i];
	dry_velocities(s);
	return dry_check(s, err);
}

static void restored(struct model_state *s)
{
	dry_velocities(s);
	dry_check_again(s);
}

static const char *remedy(const struct model_state *s)
{
	return s->remedy;
}

static struct axes axes(const struct model_state *s)
{
	return (struct axes){s->grid.cells, s->layers, s->x, s->layer_middle, s->layer_interface};
}

/* What a pressure solver keeps between steps, if it does. */
static size_t solver_array(const struct model_state *s, const struct projection *problem,
	const char *name, struct array *out)
{
	size_t count;

	if (!problem->memory || !s->solver->kept)
		return 0;
	*out = (struct array){name, s->solver->kept(problem->memory, &count), {1, 0}};
	out->extent[1] = count;
	return 1;
}

static size_t arrays(struct model_state *s, struct array *list)
{
	size_t stride = s->grid.stride, faces = (size_t)s->grid.faces, n = (size_t)s->layers, i = 0;

	list[i++] = (struct array){"h", s->h, {1, stride}};
	list[i++] = (struct array){"hu", s->U, {n, stride}};
	list[i++] = (struct array){"hw", s->W, {n, stride}};
	list[i++] = (struct array){"q", s->q, {n, faces}};
	list[i++] = (struct array){"dq", s->dq, {n, faces}};
	list[i++] = (struct array){"mass", s->mass, {1, 2}};
	i += solver_array(s, &s->full, "solver", &list[i]);
	i += solver_array(s, &s->coarse, "coarse_solver", &list[i]);
	return i;
}

const struct model dry_model = {
	.name = "dry",
	.numerics_version = 4,
	.series = dry_series,
	.series_count = DRY_SERIES_COUNT,
	.profiles = dry_profiles,
	.profile_count = DRY_PROFILE_COUNT,
	.create = create,
	.time_step = time_step,
	.step = step,
	.remedy = remedy,
	.doubt = dry_doubt,
	.observe = dry_observe,
	.profile = dry_profile,
	.axes = axes,
	.arrays = arrays,
	.restored = restored,
	.free = destroy,
	.cost = dry_cost,
};
