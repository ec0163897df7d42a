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
	double *p = calloc((size_t)5 * 160, sizeof *p), mean = 0;

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

/* A flow and the same one, the seam elsewhere: up to `apart` of the largest values. */
static void may_begin_anywhere(const char *const *settings, int count, double apart)
{
	struct config config = read_config(settings, count);
	struct model_state *s = create(&config), *r = create(&config);
	int cells = s->grid.cells, shift = 130;
	double before = observed(s, "mass"), fastest = 0, h_apart = 0, u_apart = 0;

	for (int i = 1; i <= cells; i++)
		r->h[(i - 1 + shift) % cells + 1] = s->h[i];
	grid_fill_even(&r->grid, r->h);
	dry_model.restored(r);
	for (double t = 0; t < config.time.end;) {
		struct error err = {0};
		double dt = dry_model.time_step(s);

		assert_true(fabs(dt - dry_model.time_step(r)) <= apart * dt);
		assert_int_equal(dry_model.step(s, dt, &err), 0);
		assert_int_equal(dry_model.step(r, dt, &err), 0);
		t += dt;
	}
	for (int i = 1; i <= cells; i++) {
		int j = (i - 1 + shift) % cells + 1;

		h_apart = fmax(h_apart, fabs(s->h[i] - r->h[j]));
		for (size_t a = 0; a < 4; a++) {
			double U = s->U[a * s->grid.stride + (size_t)i];

			fastest = fmax(fastest, fabs(U));
			u_apart = fmax(u_apart, fabs(U - r->U[a * s->grid.stride + (size_t)j]));
		}
	}
	assert_true(h_apart <= apart * observed(s, "max_thickness"));
	assert_true(u_apart <= apart * fastest);
	assert_true(s->h[1] > 1e-3 && s->h[cells] > 1e-3); /* the seam lies in the flow */
	assert_true(observed(s, "mass_outflow") == 0);
	assert_true(fabs(observed(s, "mass") - before) <= 1e-12 * before);
	dry_model.free(s);
	dry_model.free(r);
}

#define RING "domain.left=periodic", "domain.right=periodic", "erodible_bed_thickness=0"

/* Grains flow over the seam, also onto a dry bed. */
static void a_periodic_flow_may_begin_anywhere(void **state)
{
	static const char *const hydrostatic[] = {
		RING, "slope=30 deg", "time.end=0.6", "pressure=hydrostatic"};
	static const char *const loose[] = {RING, "slope=30 deg", "time.end=0.6",
		"erodible_bed_thickness=2 mm", "pressure_solver.residual=1e-10"};
	static const char *const tight[] = {RING, "slope=30 deg", "time.end=0.6",
		"erodible_bed_thickness=2 mm", "pressure_solver.residual=1e-12"};
	static const char *const dry[] = {
		RING, "slope=30 deg", "time.end=0.3", "pressure_solver.residual=1e-10"};

	(void)state;
	may_begin_anywhere(hydrostatic, 6, 0); /* not seen in any bit */
	/* what the solver leaves; fronts on a dry bed make more of it, where faces become wet */
	may_begin_anywhere(loose, 7, 1e-9);
	may_begin_anywhere(tight, 7, 1e-11);
	may_begin_anywhere(dry, 6, 1e-7);
}

/* A flow that is the same to the left and to the right of the seam is that between two walls. */
static void a_mirrored_flow_on_a_ring_is_that_between_walls(void **state)
{
	static const char *const half[] = {"initial.front=-0.1 m", "slope=0 deg", "domain.x_max=0.2",
		"domain.cells=80", "domain.right=wall", "pressure_solver.residual=1e-12"};
	static const char *const ring[] = {"slope=0 deg", "domain.x_max=0.6", "domain.cells=160",
		"domain.left=periodic", "domain.right=periodic", "pressure_solver.residual=1e-12"};
	struct config walls = read_config(half, 6), both = read_config(ring, 6);
	struct model_state *s = create(&walls), *r = create(&both);
	double h_apart = 0, u_apart = 0, q_apart = 0, fastest = 0, largest = 0, seam = 0;

	(void)state;
	for (int i = 1; i <= 80; i++)
		r->h[i] = r->h[161 - i] = s->h[i];
	grid_fill_even(&r->grid, r->h);
	dry_model.restored(r);
	for (double t = 0; t < 0.3;) {
		struct error err = {0};
		double dt = dry_model.time_step(s);

		assert_int_equal(dry_model.step(s, dt, &err), 0);
		assert_int_equal(dry_model.step(r, dt, &err), 0);
		seam = fmax(seam, fabs(r->q[0]));
		t += dt;
	}
	for (int i = 1; i <= 80; i++) {
		h_apart = fmax(h_apart, fmax(fabs(s->h[i] - r->h[i]), fabs(s->h[i] - r->h[161 - i])));
		for (size_t a = 0; a < 4; a++) {
			const double *u = r->U + a * r->grid.stride;
			double here = s->U[a * s->grid.stride + (size_t)i];

			fastest = fmax(fastest, fabs(here));
			u_apart = fmax(u_apart, fmax(fabs(here - u[i]), fabs(here + u[161 - i])));
		}
	}
	for (size_t a = 0; a < 4; a++)
		for (size_t f = 0; f <= 80; f++) {
			double here = s->q[a * 81 + f];

			largest = fmax(largest, fabs(here));
			q_apart = fmax(q_apart, fabs(here - r->q[a * 161 + f]));
			q_apart = fmax(q_apart, fabs(here - r->q[a * 161 + 160 - f]));
		}
	assert_true(seam > 0.1 * s->par.gc * 0.14); /* the pressure is not small there */
	/* what the solver leaves: of q 5 to 28 times the residual, for any residual of 1e-8 to 1e-12 */
	assert_true(h_apart <= 1e-11 * observed(s, "max_thickness"));
	assert_true(u_apart <= 1e-11 * fastest);
	assert_true(q_apart <= 3e-11 * largest);
	dry_model.free(s);
	dry_model.free(r);
}

/* P3 5.1: a flow from rest, on few cells. */
#define UNIFORM                                                                                    \
	"pressure=hydrostatic", "slope=0.43 rad", "erodible_bed_thickness=0",                          \
		"initial={shape: uniform, height: 1 m}", "grains.diameter=4 cm",                           \
		"rheology={mu_s: 0.363, mu_2: 0.74}", "domain={x_max: 0.2 m, cells: 4}", "time.cfl=1"

static double steady_error(const char *layers, const char *one, const char *other)
{
	const char *const settings[] = {UNIFORM, layers, one, other, "domain.left=periodic",
		"domain.right=periodic", "time.end=50 s"};
	struct model_state *s = run(settings, sizeof settings / sizeof *settings);
	double error = observed(s, "bagnold_error");

	assert_true(observed(s, "max_speed") > 0.1);
	dry_model.free(s);
	return error;
}

static void a_uniform_flow_becomes_bagnolds(void **state)
{
	double coarse = steady_error("layers=10", "bottom=no-slip", "walls.mu_w=0");
	double fine = steady_error("layers=20", "bottom=no-slip", "walls.mu_w=0");
	double slips = steady_error("layers=20", "bottom=friction", "walls.mu_w=0");

	(void)state;
	assert_true(fine < 6e-4);
	assert_true(coarse / fine > 3.8 && coarse / fine < 4.2); /* second order */
	assert_true(slips > 0.05 && slips < 0.06);               /* first order only: about 1/N */
	/* nothing changes along x, so nothing is stretched */
	assert_true(
		fabs(steady_error("layers=20", "bottom=no-slip", "rheology.strain_rate=second-order") -
			 fine) < 1e-9);
	/* a limit that is reached at the surface at most */
	assert_true(
		steady_error("layers=20", "bottom=no-slip", "regularisation.viscosity=bounded") < 6e-4);
}

/* Where nothing changes along x, there is no non-hydrostatic pressure. */
static void a_uniform_flow_on_a_ring_is_hydrostatic(void **state)
{
	const char *const plain[] = {UNIFORM, RING, "layers=5", "time.end=2 s"};
	const char *const full[] = {
		UNIFORM, RING, "layers=5", "time.end=2 s", "pressure=non-hydrostatic"};
	int count = sizeof plain / sizeof *plain;
	struct model_state *s = run(plain, count), *r = run(full, count + 1);

	(void)state;
	assert_true(r->par.non_hydrostatic && observed(r, "max_speed") > 0.1);
	assert_memory_equal(s->h, r->h, s->grid.stride * sizeof *s->h);
	assert_memory_equal(s->U, r->U, 5 * s->grid.stride * sizeof *s->U);
	for (size_t k = 0; k < 5 * s->grid.stride; k++)
		assert_true(r->W[k] == 0);
	dry_model.free(s);
	dry_model.free(r);
}

static void layers_of_their_own_thickness_come_as_close(void **state)
{
	/* twice as thin near the bottom as near the surface */
	double error = steady_error("layers=8", "bottom=no-slip",
		"layer_fractions=[0.0625, 0.0625, 0.125, 0.125, 0.125, 0.125, 0.1875, 0.1875]");

	(void)state;
	assert_true(
		error < 1.5e-2); /* 2.8e-3 with eight equal ones, first order where the size jumps */
}

/* Side walls carry mu_w (h - z)/W of the weight: the flow is slower, and rests near the bottom. */
static void side_walls_slow_the_flow_as_the_balance_says(void **state)
{
	const char *const settings[] = {UNIFORM, "walls={mu_w: 0.18, width: 1 m}"};
	struct config config = read_config(settings, sizeof settings / sizeof *settings);
	struct model_state *s = create(&config);
	double coarse = steady_error("layers=10", "bottom=no-slip", "walls={mu_w: 0.18, width: 2 m}");
	double fine = steady_error("layers=20", "bottom=no-slip", "walls={mu_w: 0.18, width: 2 m}");

	(void)state;
	assert_true(fine < 1.5e-3);
	assert_true(coarse / fine > 3.6 && coarse / fine < 4.4);
	/* at rest below (tan(theta) - mu_s) W/mu_w, 0.53 m */
	assert_true(s->steady_strain[1] == 0 && s->steady_strain[2] > 0 && s->steady_u[0] == 0);
	dry_model.free(s);
}

/* P3 (52) itself, and where there is no such flow. */
static void the_exact_flow_is_that_of_the_paper(void **state)
{
	static const struct {
		const char *setting;
		double speed; /* of the uppermost layer */
	} cases[] = {{"slope=0.34 rad", 0}, {"slope=0.64 rad", NAN}, {"rheology.law=constant", NAN},
		{"initial.shape=column", NAN}};

	(void)state;
	const char *const settings[] = {UNIFORM, "layers=4", ""};
	const char *list[sizeof settings / sizeof *settings];
	int count = sizeof settings / sizeof *settings;
	struct config config = read_config(settings, count - 1);
	struct model_state *s = create(&config);
	double tan_slope = tan(0.43), gc = 9.81 * cos(0.43);

	for (int a = 0; a < 4; a++) {
		double depth = 1 - (a + 0.5) / 4;
		double u = 2 / (3 * 0.04) * 0.279 * (tan_slope - 0.363) / (0.74 - tan_slope) *
				   sqrt(0.62 * gc) * (1 - pow(depth, 1.5));

		assert_true(fabs(s->steady_u[a] - u) < 1e-13 * u);
	}
	dry_model.free(s);
	memcpy(list, settings, sizeof settings);
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		double speed;

		list[count - 1] = cases[i].setting;
		config = read_config(list, count);
		s = create(&config);
		speed = observed(s, "steady_max_speed");
		assert_true(isnan(cases[i].speed) ? isnan(speed) : speed == cases[i].speed);
		dry_model.free(s);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_constant_law_ignores_what_mu_i_needs),
		cmocka_unit_test(equal_fractions_are_equal_layers),
		cmocka_unit_test(fractions_move_the_interfaces),
		cmocka_unit_test(a_periodic_flow_may_begin_anywhere),
		cmocka_unit_test(a_mirrored_flow_on_a_ring_is_that_between_walls),
		cmocka_unit_test(a_uniform_flow_becomes_bagnolds),
		cmocka_unit_test(a_uniform_flow_on_a_ring_is_hydrostatic),
		cmocka_unit_test(layers_of_their_own_thickness_come_as_close),
		cmocka_unit_test(side_walls_slow_the_flow_as_the_balance_says),
		cmocka_unit_test(the_exact_flow_is_that_of_the_paper),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
