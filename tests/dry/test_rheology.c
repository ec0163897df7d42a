/* Choices of the dry model beside P1's: laws of friction, layers of their own thickness, periodic ends. */
#include "dry_cases.h"

static struct model_state *run(const char *const *settings, int count)
{
	struct config config = read_config(settings, count);
	struct model_state *s = create(&config);

	advance(s, config.time.end);
	return s;
}

/* The largest difference of a field over its largest value. */
static double distance(const double *a, const double *b, size_t count)
{
	double apart = 0, largest = 0;

	for (size_t k = 0; k < count; k++) {
		apart = fmax(apart, fabs(a[k] - b[k]));
		largest = fmax(largest, fabs(a[k]));
	}
	return apart / largest;
}

static void a_constant_law_ignores_what_mu_i_needs(void **state)
{
	static const char *const constant[] = {"rheology={law: constant, mu_2: 0.2, i_0: 1}"};
	static const char *const equal[] = {"rheology.mu_2=tan(25.5 deg)"};
	struct model_state *s = run(constant, 1), *r = run(equal, 1);

	(void)state;
	assert_memory_equal(s->h, r->h, s->grid.stride * sizeof *s->h);
	assert_memory_equal(s->U, r->U, 4 * s->grid.stride * sizeof *s->U);
	dry_model.free(s);
	dry_model.free(r);
}

static void equal_fractions_are_equal_layers(void **state)
{
	static const char *const implied[] = {
		"pressure=hydrostatic", "layers=3", "walls.mu_w=0.1", "bottom=no-slip"};
	static const char *const given[] = {"pressure=hydrostatic", "layers=3", "walls.mu_w=0.1",
		"bottom=no-slip", "layer_fractions=[0.3333333333, 0.3333333333, 0.3333333334]"};
	struct model_state *s = run(implied, 4), *r = run(given, 5);

	(void)state;
	/* the fractions are off by 1e-10, which a collapse does not make much of */
	assert_true(distance(s->h, r->h, s->grid.stride) < 1e-8);
	assert_true(distance(s->U, r->U, 3 * s->grid.stride) < 1e-7);
	dry_model.free(s);
	dry_model.free(r);
}

static void fractions_move_the_interfaces(void **state)
{
	static const char *const settings[] = {
		"pressure=hydrostatic", "layer_fractions=[0.1, 0.2, 0.3, 0.4]"};
	struct model_state *s = run(settings, 2);
	struct axes axes = dry_model.axes(s);
	static const double middle[] = {0.05, 0.2, 0.45, 0.8}, interface[] = {0, 0.1, 0.3, 0.6, 1};
	double *p = calloc(5 * 160, sizeof *p), mean = 0;

	(void)state;
	assert_non_null(p);
	dry_model.profile(s, 5, p);
	for (int a = 0; a < 4; a++)
		assert_true(fabs(axes.layer[a] - middle[a]) < 1e-15);
	for (int a = 0; a <= 4; a++) {
		double weight = s->par.rho * s->par.gc * s->h[10];

		assert_true(fabs(axes.interface[a] - interface[a]) < 1e-15);
		assert_true(fabs(p[160 * a + 9] - (1 - interface[a]) * weight) <= 1e-12 * weight);
	}
	for (int a = 0; a < 4; a++)
		mean += (interface[a + 1] - interface[a]) * s->u[(size_t)a * s->grid.stride + 10];
	assert_true(fabs(s->mean[10] - mean) <= 1e-13 * fabs(mean) && mean != 0);
	free(p);
	dry_model.free(s);
}

/* Where the seam lies must not be seen in any bit: grains flow over it onto a dry bed. */
static void a_periodic_flow_may_begin_anywhere(void **state)
{
	static const char *const ring[] = {"pressure=hydrostatic", "domain.left=periodic",
		"domain.right=periodic", "erodible_bed_thickness=0", "slope=30 deg", "time.end=0.6"};
	struct config config = read_config(ring, 6);
	struct model_state *s = create(&config), *r = create(&config);
	int cells = s->grid.cells, shift = 130;
	double before = observed(s, "mass");

	(void)state;
	for (int i = 1; i <= cells; i++)
		r->h[(i - 1 + shift) % cells + 1] = s->h[i];
	grid_fill_even(&r->grid, r->h);
	dry_model.restored(r);
	for (double t = 0; t < config.time.end;) {
		struct error err = {0};
		double dt = dry_model.time_step(s);

		assert_true(dt == dry_model.time_step(r));
		assert_int_equal(dry_model.step(s, dt, &err), 0);
		assert_int_equal(dry_model.step(r, dt, &err), 0);
		t += dt;
	}
	for (int i = 1; i <= cells; i++) {
		int j = (i - 1 + shift) % cells + 1;

		assert_true(s->h[i] == r->h[j]);
		for (size_t a = 0; a < 4; a++)
			assert_true(
				s->U[a * s->grid.stride + (size_t)i] == r->U[a * s->grid.stride + (size_t)j]);
	}
	assert_true(s->h[1] > 1e-3 && s->h[cells] > 1e-3); /* the seam lies in the flow */
	assert_true(observed(s, "mass_outflow") == 0);
	assert_true(fabs(observed(s, "mass") - before) <= 1e-12 * before);
	dry_model.free(s);
	dry_model.free(r);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_constant_law_ignores_what_mu_i_needs),
		cmocka_unit_test(equal_fractions_are_equal_layers),
		cmocka_unit_test(fractions_move_the_interfaces),
		cmocka_unit_test(a_periodic_flow_may_begin_anywhere),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
