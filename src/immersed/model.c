/* The immersed model as a row of the table of models: memory, schemes, and the exact state. */
#include "talus/model.h"

#include <math.h>
#include <stdlib.h>

#include "immersed/immersed.h"

#define GRAVITY 9.81 /* m/s2 */

static const struct immersed_scheme *const schemes[] = {
	[TIME_SCHEME_TR_BDF2] = &scheme_tr_bdf2,
	[TIME_SCHEME_SEMI_IMPLICIT] = &scheme_semi_implicit,
};

static struct immersed_parameters parameters(const struct config *config)
{
	double lighter = (config->grains.density - config->fluid.density) * GRAVITY;
	double seepage =
		150 * config->fluid.viscosity / (config->grains.diameter * config->grains.diameter);

	return (struct immersed_parameters){
		/* in long double: sin, cos and tan in double are chosen by processor and differ in bits */
		.pull = lighter * (double)sinl(config->slope),
		.weight = lighter * (double)cosl(config->slope),
		.tan_slope = (double)tanl(config->slope),
		.rho_s = config->grains.density,
		.rho_f = config->fluid.density,
		.eta = config->fluid.viscosity,
		.drag = config->drag == SWITCH_ON ? seepage : 0,
		.seepage = seepage,
		.linear = config->rheology.law == LAW_LINEAR,
		.mu_s = config->rheology.mu_s,
		.k_1 = config->rheology.k_1,
		.mu_2 = config->rheology.mu_2,
		.i_0 = config->rheology.i_0,
		.k = config->dilatancy.k,
		.k_2 = config->dilatancy.k_2,
		.phi_c = config->dilatancy.critical_fraction,
		.wall = 2 * config->walls.mu_w / config->walls.width,
		.lambda = config->bottom == BOTTOM_NO_SLIP ? 2 : 1,
		.backward = config->dilatancy.interface_fraction == INTERFACE_BACKWARD,
		.keeps_mass = config->preserves == PRESERVED_GRANULAR_MASS,
		.delta_strain = config->regularisation.strain_rate,
		.delta_velocity = config->regularisation.velocity,
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

static struct immersed_column place_column(double **next, size_t n)
{
	struct immersed_column c;

	c.phi = place(next, n);
	c.v = place(next, n);
	c.u = place(next, n);
	c.p = place(next, n);
	c.S = place(next, n);
	return c;
}

static size_t layout(struct model_state *s, double *memory)
{
	size_t n = (size_t)s->layers, works = sizeof s->work / sizeof *s->work;
	double *next = memory;

	s->l = place(&next, n);
	s->now = place_column(&next, n);
	s->trial = place_column(&next, n);
	s->known = place_column(&next, n);
	s->rates = place(&next, 3 * n);
	for (size_t i = 0; i < works; i++)
		s->work[i] = place(&next, n + 1);
	s->right = place(&next, IMMERSED_UNKNOWNS * n);
	s->layer_middle = place(&next, n);
	s->layer_interface = place(&next, n + 1);
	return (6 + 4 * IMMERSED_UNKNOWNS) * n + works * (n + 1) + 1;
}

static void destroy(struct model_state *s)
{
	if (!s)
		return;
	block_tridiagonal_clean(&s->blocks);
	free(s->memory);
	free(s);
}

/* The layers and the mixture at rest, with the pressure of its weight. */
static int fill(struct model_state *s, const struct config *config, struct error *err)
{
	const struct real_list *fractions = &config->layer_fractions;
	double above = 0, phi = config->initial.solid_fraction;

	s->depth = config->initial.height;
	for (int a = 0; a < s->layers; a++) {
		s->l[a] = fractions->count ? fractions->values[a] : 1.0 / s->layers;
		s->layer_middle[a] = s->layer_interface[a] + 0.5 * s->l[a];
		s->layer_interface[a + 1] = s->layer_interface[a] + s->l[a];
		s->now.phi[a] = phi;
		s->mass += s->l[a] * phi;
	}
	s->layer_interface[s->layers] = 1;
	s->mass *= s->depth;
	for (int a = s->layers; a-- > 0;)
		s->now.p[a] = above += s->par.weight * s->l[a] * s->depth * phi;
	if (!(s->now.p[s->layers - 1] > 0))
		return error_set(err, EX_DATAERR, "the grains have no weight");
	s->scheme->begin(s);
	return 0;
}

static int create(const struct config *config, struct model_state **out, struct error *err)
{
	struct model_state *s = calloc(1, sizeof *s);
	size_t count;

	if (!s)
		return error_memory(err, sizeof *s);
	s->par = parameters(config);
	s->layers = config->layers;
	s->scheme = schemes[config->time.scheme];
	s->tolerance = config->time.tolerance;
	s->fixed_step = config->time.step;
	s->steady_surface = config->output.steady_surface;
	count = layout(s, NULL);
	s->memory = calloc(count, sizeof *s->memory);
	if (!s->memory) {
		destroy(s);
		return error_memory(err, count * sizeof *s->memory);
	}
	(void)layout(s, s->memory);
	if (block_tridiagonal_init(&s->blocks, s->layers, err) || fill(s, config, err)) {
		destroy(s);
		return -1;
	}
	*out = s;
	return 0;
}

static double time_step(const struct model_state *s)
{
	return s->scheme->time_step(s);
}

static int step(struct model_state *s, double dt, struct error *err)
{
	return s->scheme->step(s, dt, err);
}

static double taken(const struct model_state *s)
{
	return s->taken;
}

static struct axes axes(const struct model_state *s)
{
	return (struct axes){
		.layers = s->layers, .layer = s->layer_middle, .interface = s->layer_interface};
}

static size_t arrays(struct model_state *s, struct array *list)
{
	size_t n = (size_t)s->layers, i = 0;

	list[i++] = (struct array){"phi", s->now.phi, {1, n}};
	list[i++] = (struct array){"v", s->now.v, {1, n}};
	list[i++] = (struct array){"u", s->now.u, {1, n}};
	list[i++] = (struct array){"p", s->now.p, {1, n}};
	list[i++] = (struct array){"s", s->now.S, {1, n}};
	list[i++] = (struct array){"rates", s->rates, {3, n}};
	list[i++] =
		(struct array){"record", (double *)&s->record, {1, sizeof s->record / sizeof(double)}};
	return i;
}

static void restored(struct model_state *s)
{
	(void)s;
}

const struct model immersed_model = {
	.name = "immersed",
	.numerics_version = 1,
	.series = immersed_series,
	.series_count = IMMERSED_SERIES_COUNT,
	.profiles = immersed_profiles,
	.profile_count = IMMERSED_PROFILE_COUNT,
	.keeps_state = true,
	.create = create,
	.time_step = time_step,
	.step = step,
	.taken = taken,
	.observe = immersed_observe,
	.profile = immersed_profile,
	.axes = axes,
	.arrays = arrays,
	.restored = restored,
	.free = destroy,
};
