/* Beds, initial shapes and coordinates: what rests, what is the same in two systems, what a gate does. */
#include "dry_cases.h"

static struct model_state *begin(const char *const *settings, int count)
{
	struct config config = read_config(settings, count);

	return create(&config);
}

/* The largest change of the thickness while the flow goes on for `time`. */
static double change(struct model_state *s, double time)
{
	double *h = calloc(s->grid.stride, sizeof *h), largest = 0;

	assert_non_null(h);
	memcpy(h, s->h, s->grid.stride * sizeof *h);
	advance(s, time);
	for (int i = 1; i <= s->grid.cells; i++)
		largest = fmax(largest, fabs(s->h[i] - h[i]));
	free(h);
	return largest;
}

static double change_of(const char *const *settings, int count, double time)
{
	struct model_state *s = begin(settings, count);
	double largest = change(s, time);

	dry_model.free(s);
	return largest;
}

#define BEGIN(...)                                                                                 \
	begin((const char *const[]){__VA_ARGS__},                                                      \
		(int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)))

#define CHANGE(time, ...)                                                                          \
	change_of((const char *const[]){__VA_ARGS__},                                                  \
		(int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)), time)

static void cartesian_coordinates_without_a_slope_are_local_ones(void **state)
{
	struct model_state *s = BEGIN("slope=0 deg", "topography.shape=random");
	struct model_state *r =
		BEGIN("slope=0 deg", "topography.shape=random", "coordinates=cartesian");

	(void)state;
	advance(s, 0.2);
	advance(r, 0.2);
	assert_memory_equal(s->h, r->h, s->grid.stride * sizeof *s->h);
	assert_memory_equal(s->U, r->U, 4 * s->grid.stride * sizeof *s->U);
	assert_memory_equal(s->W, r->W, 4 * s->grid.stride * sizeof *s->W);
	dry_model.free(s);
	dry_model.free(r);
}

static void a_seed_repeats_its_bed_and_another_does_not(void **state)
{
	struct model_state *s = BEGIN("topography.shape=random");
	struct model_state *same = BEGIN("topography.shape=random", "layers=2");
	struct model_state *other = BEGIN("topography.shape=random", "topography.seed=2");
	size_t bytes = s->grid.stride * sizeof *s->b;

	(void)state;
	assert_memory_equal(s->b, same->b, bytes);
	assert_memory_not_equal(s->b, other->b, bytes);
	dry_model.free(s);
	dry_model.free(same);
	dry_model.free(other);
}

static void points_are_joined_by_lines(void **state)
{
	struct model_state *s =
		BEGIN("topography={shape: file, points: [[-1, 0.2], [0.4, 0.1], [2, 0.1]]}");

	(void)state;
	for (int i = 1; i <= s->grid.cells; i++) {
		double x = grid_centre(&s->grid, i), line = 0.1 + fmax(0, 0.4 - x) * 0.1 / 1.4;

		assert_true(fabs(s->b[i] - line) < 1e-15);
	}
	dry_model.free(s);
}

#define REST                                                                                       \
	"slope=0 deg", "erodible_bed_thickness=0", "domain.right=wall",                                \
		"initial={shape: level, surface_slope: 15 deg}"
#define BUMPS "topography={shape: file, points: [[-1, 0.1], [0.1, -0.02], [0.4, 0.08], [2, 0.1]]}"
#define RANDOM "topography={shape: random, roughness: 0.05 m}"

/* Under the angle of repose, wet and with a bed that stands out of the grains. */
static void grains_at_rest_keep_their_shape(void **state)
{
	static const char *const beds[] = {"topography.shape=plane", BUMPS, RANDOM};
	static const char *const heights[] = {"initial.height=0.1 m", "initial.height=0.6 m"};
	static const char *const layers[] = {"layers=1", "layers=2", "layers=5"};

	(void)state;
	for (int k = 0; k < 18; k++) {
		const char *bed = beds[k % 3], *height = heights[k / 3 % 2], *n = layers[k / 6];

		assert_true(CHANGE(1, REST, bed, height, n) == 0);
		assert_true(CHANGE(0.2, REST, bed, height, n, "pressure=hydrostatic", "time.cfl=0.1") == 0);
	}
}

/* Or the test above would hold of grains that nothing can move. */
static void grains_creep_with_delta_where_rest_is_not_told(void **state)
{
	double most = CHANGE(1, REST, RANDOM, "layers=2", "initial.height=0.6 m",
		"scheme.friction_reconstruction=static");
	double less = CHANGE(1, REST, RANDOM, "layers=2", "initial.height=0.6 m",
		"scheme.friction_reconstruction=static",
		"regularisation={velocity: 1e-6, strain_rate: 1e-6}");

	(void)state;
	assert_true(most > 1e-6 && less > 1e-7 && less < 0.2 * most);
}

/* A degree above the angle of repose nothing holds them. */
static void grains_above_their_angle_of_repose_move(void **state)
{
	(void)state;
	assert_true(CHANGE(0.2, REST, RANDOM, "layers=2", "initial.height=0.6 m",
					"initial.surface_slope=26.5 deg") > 1e-4);
}

static void level_grains_rest_on_a_bed_that_stands_out(void **state)
{
	(void)state;
	assert_true(CHANGE(0.5, REST, RANDOM, "layers=2", "initial.height=0.08 m",
					"initial.surface_slope=0 deg") < 1e-12);
	assert_true(CHANGE(0.5, REST, BUMPS, "layers=2", "initial.height=0.05 m",
					"initial.surface_slope=0 deg", "pressure=hydrostatic") < 1e-12);
}

/* P1 Table 6 in small: at the very limit. */
#define LIMIT                                                                                      \
	"slope=0 deg", "erodible_bed_thickness=0", "layers=2", "topography.shape=random",              \
		"domain={x_min: -3, x_max: 1, cells: 300, left: outflow, right: outflow}",                 \
		"initial={shape: level, height: 0.8, centre: 2, surface_slope: 20 deg}",                   \
		"rheology.mu_s=tan(20 deg)", "scheme.friction_reconstruction=printed",                     \
		"regularisation={velocity: 1e-10, strain_rate: 1e-10}"

static void the_thickness_of_25_keeps_what_h_does_not(void **state)
{
	double kept = CHANGE(0.8, LIMIT);

	(void)state;
	assert_true(kept < 5e-9); /* 60 delta t; P1: 5 delta in 1 s on the mean over 4 m */
	assert_true(CHANGE(0.8, LIMIT, "scheme.friction_thickness=plain") > 100 * kept);
	assert_true(CHANGE(0.2, LIMIT, "initial.surface_slope=20.01 deg") > 1e-6);
}

#define COLLAPSE                                                                                   \
	"slope=22 deg", "initial={shape: triangle, height: 0.14 m}", "erodible_bed_thickness=0"

static double mass_of(const struct model_state *s)
{
	double sum = 0;

	for (int i = 1; i <= s->grid.cells; i++)
		sum += s->h[i];
	return sum * s->grid.dx;
}

/* P2 4.1: Y^2 (tan + cot)/2 of the triangle is the area of the body, in both coordinates. */
static void a_turned_body_keeps_its_area(void **state)
{
	static const char *const domains[] = {"domain={x_min: -0.5, cells: 190}"};
	double slope = tan(22 * acos(-1) / 180), area = 0.14 * 0.14 * (slope + 1 / slope) / 2;
	struct model_state *s = BEGIN(COLLAPSE, domains[0]);
	struct model_state *r =
		BEGIN(COLLAPSE, domains[0], "coordinates=cartesian", "topography.coordinates=local");
	struct model_state *back = BEGIN(COLLAPSE, domains[0], "topography.coordinates=cartesian",
		"initial.height=0.15099485 m"); /* 0.14/cos(22 deg), upright */

	(void)state;
	assert_true(fabs(mass_of(s) / area - 1) < 2e-3); /* values in the middle of 1 cm cells */
	assert_true(fabs(mass_of(r) / area - 1) < 1e-5);
	assert_true(fabs(mass_of(back) / area - 1) < 1e-5);
	for (int i = 1; i <= s->grid.cells; i++) /* the same triangle, but for its tip */
		assert_true(fabs(back->h[i] - s->h[i]) < 0.003);
	dry_model.free(s);
	dry_model.free(r);
	dry_model.free(back);
}

/* The bed of Cartesian coordinates has the plane, of which the pressure force sees the slope. */
/* A layer normal to the plane is thicker along the vertical: it is no front. */
static void the_front_is_above_the_turned_bed_layer(void **state)
{
	struct model_state *s = BEGIN("coordinates=cartesian", "topography.coordinates=local",
		"erodible_bed_thickness=20 mm", "initial.height=50 mm");
	double front = observed(s, "front_position");

	(void)state;
	assert_true(fabs(front) < 0.05 * s->par.tan_slope + 3 * s->grid.dx);
	dry_model.free(s);
}

static void the_plane_is_a_part_of_a_cartesian_bed(void **state)
{
	struct model_state *s = BEGIN(COLLAPSE, "coordinates=cartesian");
	double fall = tan(22 * acos(-1) / 180) * s->grid.dx;

	(void)state;
	assert_true(s->par.gc > 9.8);
	for (int i = 0; i <= s->grid.cells; i++)
		assert_true(fabs(s->bed[i] - s->bed[i + 1] - fall) < 1e-14);
	dry_model.free(s);
}

static const struct {
	const char *const *settings;
	int count;
} beds[] = {
	CASE("coordinates=cartesian"),
	CASE("coordinates=cartesian", "erodible_bed_thickness=0", "layers=1"),
	CASE("topography={shape: random, roughness: 0.05}"),
	CASE("topography={shape: random, roughness: 0.05}", "erodible_bed_thickness=0", "layers=10",
		"domain.right=wall"),
	CASE("topography={shape: random, roughness: 0.05}", "coordinates=cartesian",
		"pressure=hydrostatic"),
	CASE(BUMPS, "erodible_bed_thickness=0", "layers=1", "scheme.friction=coulomb"),
	CASE(BUMPS, "scheme.exchange=upwind", "pressure=hydrostatic", "layers=5"),
	CASE("topography={shape: bump, coordinates: cartesian}", "domain={x_min: -2, x_max: 2}",
		"initial={shape: cap, height: 1.91, centre: -1.53}", "scheme.exchange=upwind"),
	CASE("topography={shape: bump, coordinates: cartesian}", "domain={x_min: -2, x_max: 2}",
		"initial={shape: cap, height: 1.91, centre: -1.53}", "coordinates=cartesian",
		"n_ini_guess=2", "erodible_bed_thickness=0"),
	CASE("gate.speed=2.3 m/s", "layers=1", "erodible_bed_thickness=0"),
};

/* Rough beds, shores, both coordinates: mass to rounding, energy never up (P1 Theorem 1). */
static void flows_on_beds_keep_their_mass_and_lose_energy(void **state)
{
	(void)state;
	for (size_t k = 0; k < sizeof beds / sizeof *beds; k++) {
		struct config config = read_config(beds[k].settings, beds[k].count);
		struct model_state *s = create(&config);
		double mass = observed(s, "mass"), first = observed(s, "energy"), last = first;
		struct error err = {0};

		for (double t = 0; t < 0.3;) {
			double dt = dry_model.time_step(s), now;

			if (dry_model.step(s, dt, &err))
				fail_msg("bed %zu: %s", k, err.text);
			now = observed(s, "energy");
			if (config.domain.left == BOUNDARY_WALL && now - last > 1e-6 * fabs(first))
				fail_msg("bed %zu: the energy rises by %g at %g s", k, (now - last) / first, t);
			last = now;
			t += dt;
		}
		assert_true(fabs(observed(s, "mass") + observed(s, "mass_outflow") - mass) < 1e-12 * mass);
		dry_model.free(s);
	}
}

/* P2 (30), and what its friction leaves of it. */
static void the_gate_takes_up_the_grains_behind_it(void **state)
{
	struct model_state *s = BEGIN("gate.speed=2.3 m/s", "layers=1", "erodible_bed_thickness=0");
	struct model_state *r = BEGIN(
		"gate.speed=2.3 m/s", "layers=1", "erodible_bed_thickness=0", "scheme.friction=coulomb");

	(void)state;
	for (int i = 1; i <= s->grid.cells; i++) {
		double x = grid_centre(&s->grid, i), w = x > -0.025 && x < 0 ? 2.3 : 0;

		assert_true(fabs(s->w[i] - w) < 1e-15);
	}
	dry_friction(s, 1e-3); /* nothing flows yet */
	dry_friction(r, 1e-3);
	for (int i = 1; i <= s->grid.cells; i++) {
		double x = grid_centre(&s->grid, i), W = x > -0.025 && x < 0 ? 2.3 * s->h[i] : 0;

		assert_true(fabs(s->W[i] - W) < 1e-15);
		assert_true(fabs(r->W[i]) <= 0);
	}
	dry_model.free(s);
	dry_model.free(r);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(cartesian_coordinates_without_a_slope_are_local_ones),
		cmocka_unit_test(a_seed_repeats_its_bed_and_another_does_not),
		cmocka_unit_test(points_are_joined_by_lines),
		cmocka_unit_test(grains_at_rest_keep_their_shape),
		cmocka_unit_test(grains_creep_with_delta_where_rest_is_not_told),
		cmocka_unit_test(grains_above_their_angle_of_repose_move),
		cmocka_unit_test(level_grains_rest_on_a_bed_that_stands_out),
		cmocka_unit_test(the_thickness_of_25_keeps_what_h_does_not),
		cmocka_unit_test(a_turned_body_keeps_its_area),
		cmocka_unit_test(the_front_is_above_the_turned_bed_layer),
		cmocka_unit_test(the_plane_is_a_part_of_a_cartesian_bed),
		cmocka_unit_test(flows_on_beds_keep_their_mass_and_lose_energy),
		cmocka_unit_test(the_gate_takes_up_the_grains_behind_it),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
