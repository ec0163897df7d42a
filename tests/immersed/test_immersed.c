/* The immersed model as a whole: steady states, what is preserved, accuracy, exact state, failure. */
#include "immersed_cases.h"

/* Relative errors of v against the steady flow stored beside it. */
static void errors(const struct model_state *s, double *l1, double *linf)
{
	double v[512], phi[512], apart = 0, whole = 0, most = 0, largest = 0;

	immersed_exact(s, v, phi);
	for (int a = 0; a < s->layers; a++) {
		double off = fabs(s->now.v[a] - v[a]);

		apart += s->l[a] * off;
		whole += s->l[a] * v[a];
		most = fmax(most, off);
		largest = fmax(largest, v[a]);
	}
	*l1 = apart / whole;
	*linf = most / largest;
}

/* P4 Table 3: 1/(2 N^2) and 1/(3 N^2 - 1). */
static void without_drag_the_steady_error_is_known_in_closed_form(void **state)
{
	static const int layers[] = {1, 2, 4, 16, 64};
	static const char *const kinds[] = {"preserves=height", "preserves=granular-mass",
		"dilatancy.interface_fraction=mean", "rheology.law=mu_i"};

	(void)state;
	for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
		for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
			char settings[128];
			double l1, linf, n2 = (double)layers[i] * layers[i];
			struct model_state *s;

			(void)snprintf(settings, sizeof settings, "drag=off;%s;layers=%d", kinds[k], layers[i]);
			s = case_run(low_loose, settings, 3000);
			errors(s, &l1, &linf);
			/* what is left: delta in the stress of the upper layers, some 1e-7 */
			assert_true(fabs(l1 - 1 / (2 * n2)) < 4e-7);
			assert_true(fabs(linf - 1 / (3 * n2 - 1)) < 4e-7);
			immersed_model.free(s);
		}
}

static void unequal_layers_reach_the_exact_flow_too(void **state)
{
	struct model_state *s = case_run(low_loose,
		"drag=off;layers=8;layer_fractions=[0.05, 0.05, 0.1, 0.1, 0.15, 0.15, 0.2, 0.2]", 3000);
	double l1, linf;

	(void)state;
	errors(s, &l1, &linf);
	assert_true(l1 < 0.02);
	immersed_model.free(s);
}

/* P4 Table 4, its mean reading and the better one. */
static void with_walls_the_backward_reading_is_far_closer(void **state)
{
	static const char walls[] = "drag=off;preserves=height;walls.mu_w=tan(13.1 deg);"
								"walls.width=15 mm;layers=16;output.steady_surface=1e-6;";
	static const struct {
		const char *reading;
		double published, within;
	} rows[] = {
		{"mean", 5.69e-2, 0.03 * 5.69e-2},
		{"backward", 1.72e-3, 2e-4},
	};

	(void)state;
	for (size_t i = 0; i < 2; i++) {
		char settings[256];
		struct model_state *s;
		double l1, linf;

		(void)snprintf(
			settings, sizeof settings, "%sdilatancy.interface_fraction=%s", walls, rows[i].reading);
		s = case_run(low_loose, settings, 1000);
		errors(s, &l1, &linf);
		assert_true(fabs(l1 - rows[i].published) <= rows[i].within);
		immersed_model.free(s);
	}
}

static void every_combination_runs_to_its_steady_state_and_preserves(void **state)
{
	static const char *const texts[] = {low_dense, low_loose, high_dense, high_loose};
	static const int layers[] = {1, 2, 3, 5, 20, 50};

	(void)state;
	for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
		for (int kind = 0; kind < 2; kind++)
			for (size_t k = 0; k < sizeof layers / sizeof *layers; k++) {
				const char *kept = kind ? "height" : "solid_mass";
				char settings[128];
				struct config config;
				struct model_state *s;
				double before;

				(void)snprintf(settings, sizeof settings, "layers=%d;preserves=%s", layers[k],
					kind ? "height" : "granular-mass");
				config = case_config(texts[i], settings);
				s = case_create(&config);
				before = case_observed(s, kept);
				for (double t = 0; t < config.time.end;) {
					t = case_step(s, t, config.time.end);
					assert_true(fabs(case_observed(s, kept) / before - 1) <= 1e-12);
				}
				/* no excess pressure is left: 0.2 % of the weight */
				assert_true(fabs(case_observed(s, "excess_pressure")) <
							2e-3 * case_observed(s, "bottom_pressure"));
				immersed_model.free(s);
			}
}

/* v_max of a run with a hundredth of the tolerance, at the times of this one. */
static void the_transient_is_within_two_thousandths(void **state)
{
	struct config config = case_config(low_dense, "time.end=100");
	struct config finer = case_config(low_dense, "time.end=100;time.tolerance=1e-6");
	struct model_state *s = case_create(&config), *reference = case_create(&finer);
	double worst = 0, largest = 0;

	(void)state;
	for (double t = 0, at = 0; t < 100;) {
		double next = case_step(s, t, 100);

		case_advance(reference, at, next);
		t = at = next;
		worst = fmax(
			worst, fabs(case_observed(s, "max_speed") - case_observed(reference, "max_speed")));
		largest = fmax(largest, case_observed(reference, "max_speed"));
	}
	assert_true(worst < 2e-3 * largest);
	assert_true(case_observed(s, "steps") < 1000);
	assert_true(case_observed(s, "rejected_steps") > 0);
	immersed_model.free(s);
	immersed_model.free(reference);
}

/* Two schemes that share only the laws: the distance falls with the step of the explicit one. */
static void the_schemes_agree(void **state)
{
	static const char *const texts[] = {low_dense, low_loose};
	static const double ends[] = {0.02, 0.02};

	(void)state;
	for (size_t i = 0; i < 2; i++) {
		struct model_state *fine = case_run(texts[i], "layers=3;time.tolerance=1e-7", ends[i]);
		double v = case_observed(fine, "mean_speed"), p = case_observed(fine, "bottom_pressure");
		double apart[2];

		for (int k = 0; k < 2; k++) {
			struct model_state *s = case_run(texts[i],
				k ? "layers=3;time.scheme=semi-implicit;time.step=1e-6"
				  : "layers=3;time.scheme=semi-implicit;time.step=4e-6",
				ends[i]);

			apart[k] = fabs(case_observed(s, "mean_speed") / v - 1);
			assert_true(fabs(case_observed(s, "bottom_pressure") / p - 1) < 1e-3);
			assert_true(case_observed(s, "pressure_error") < 1e-6);
			immersed_model.free(s);
		}
		assert_true(apart[1] < 2e-3);
		assert_true(apart[1] < 0.5 * apart[0]);
		immersed_model.free(fine);
	}
}

/* P4 4.2.2: "t = 5.1e-3 s". */
static void the_transfer_changes_its_sign_when_the_paper_says(void **state)
{
	struct config config =
		case_config(low_loose, "layers=2;time.tolerance=1e-5;dilatancy.interface_fraction=mean");
	struct model_state *s = case_create(&config);
	double t = 0;

	(void)state;
	do
		t = case_step(s, t, 1);
	while (case_observed(s, "fluid_transfer") < 0 && t < 1);
	assert_true(t > 5.05e-3 && t < 5.2e-3);
	immersed_model.free(s);
}

static void on_a_gentle_slope_nothing_but_creep_moves(void **state)
{
	struct model_state *s = case_run(low_dense, "slope=15 deg", 100);

	(void)state;
	/* regularised: a few delta times the height */
	assert_true(case_observed(s, "max_speed") < 1e-6);
	immersed_model.free(s);
	s = case_run(low_dense, "slope=0 deg", 100);
	assert_true(case_observed(s, "max_speed") == 0);
	immersed_model.free(s);
}

/* Everything that the next step needs is in the arrays: also the step that is next, and its past. */
static void a_restored_state_goes_on_with_the_same_bits(void **state)
{
	static const char *const settings[] = {"", "preserves=height;layers=1",
		"time.scheme=semi-implicit", "walls.mu_w=0.2;dilatancy.interface_fraction=mean"};

	(void)state;
	for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
		struct config config = case_config(low_dense, settings[i]);
		struct model_state *straight = case_create(&config);
		double t = 0;

		for (int step = 0; step < 20; step++)
			t = case_step(straight, t, 300);
		for (int stop = 0; stop < 5; stop++) {
			struct model_state *resumed = case_create(&config);
			struct array from[MODEL_ARRAYS_MAX], to[MODEL_ARRAYS_MAX];
			size_t count = immersed_model.arrays(straight, from);
			double at = t;

			assert_int_equal(immersed_model.arrays(resumed, to), count);
			for (size_t k = 0; k < count; k++)
				memcpy(to[k].data, from[k].data,
					from[k].extent[0] * from[k].extent[1] * sizeof(double));
			immersed_model.restored(resumed);
			for (int step = 0; step < 12; step++) {
				t = case_step(straight, t, 300);
				at = case_step(resumed, at, 300);
				assert_true(t == at);
			}
			count = immersed_model.arrays(straight, from);
			(void)immersed_model.arrays(resumed, to);
			for (size_t k = 0; k < count; k++)
				assert_memory_equal(to[k].data, from[k].data,
					from[k].extent[0] * from[k].extent[1] * sizeof(double));
			immersed_model.free(resumed);
		}
		immersed_model.free(straight);
	}
}

/* Step until one fails. The state is then that of before it. */
static void check_failure(const struct config *config, const char *reason)
{
	struct model_state *s = case_create(config);
	struct array list[MODEL_ARRAYS_MAX];
	struct error err = {0};
	double before[64];

	for (int step = 0; !err.code && step < 100000; step++) {
		(void)immersed_model.arrays(s, list);
		memcpy(before, list[1].data, (size_t)s->layers * sizeof *before);
		(void)immersed_model.step(s, immersed_model.time_step(s), &err);
	}
	assert_int_equal(err.code, EX_FAILED);
	if (!strstr(err.text, reason))
		fail_msg("'%s' does not say '%s'", err.text, reason);
	(void)immersed_model.arrays(s, list);
	assert_string_equal(list[1].name, "v");
	assert_memory_equal(list[1].data, before, (size_t)s->layers * sizeof *before);
	immersed_model.free(s);
}

static void a_step_that_fails_says_why_and_leaves_the_state_alone(void **state)
{
	struct config explicit_drag =
		case_config(high_dense, "time.scheme=semi-implicit;time.step=1e-4;layers=3");
	/* metres of grains on a wall: found by trying parameters at random */
	struct config collapse = case_config(high_dense,
		"layers=8;slope=86 deg;initial.height=3.35;initial.solid_fraction=0.524;"
		"grains.diameter=0.764 mm;fluid.viscosity=0.493;fluid.density=1341;rheology.mu_s=0.528;"
		"rheology.k_1=52;dilatancy.k=7.6;dilatancy.k_2=0.5686;dilatancy.critical_fraction=0.788;"
		"time.tolerance=4.5e-3");

	(void)state;
	check_failure(&explicit_drag, "is too long for the semi-implicit scheme");
	check_failure(&collapse, "the step has shrunk to");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(without_drag_the_steady_error_is_known_in_closed_form),
		cmocka_unit_test(unequal_layers_reach_the_exact_flow_too),
		cmocka_unit_test(with_walls_the_backward_reading_is_far_closer),
		cmocka_unit_test(every_combination_runs_to_its_steady_state_and_preserves),
		cmocka_unit_test(the_transient_is_within_two_thousandths),
		cmocka_unit_test(the_schemes_agree),
		cmocka_unit_test(the_transfer_changes_its_sign_when_the_paper_says),
		cmocka_unit_test(on_a_gentle_slope_nothing_but_creep_moves),
		cmocka_unit_test(a_restored_state_goes_on_with_the_same_bits),
		cmocka_unit_test(a_step_that_fails_says_why_and_leaves_the_state_alone),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
