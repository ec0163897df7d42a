/* What is recorded, when, and the slopes. */
#include "logistic.h"

#include "run/history.h"

/* Slopes of `v(t)` given step by step, with NaN before `clean`. */
static double slope_at_end(double (*v)(double), double dt, int steps, double clean)
{
	struct history history;
	struct error err = {0};
	double values[sizeof logistic_series / sizeof *logistic_series];

	history_init(&history, &logistic_model);
	for (int i = 0; i <= steps; i++) {
		memset(values, 0, sizeof values);
		values[0] = i * dt < clean ? NAN : v(i * dt);
		assert_int_equal(history_add(&history, i * dt, values, &err), 0);
	}
	/* rows before the window are dropped */
	assert_true(history.count - history.first <= 3 + (size_t)(0.05 / dt));
	history_clean(&history);
	return values[1];
}

static void assert_near(double value, double expected, double tolerance)
{
	if (!(fabs(value - expected) <= tolerance))
		fail_msg("%.17g is not %.17g", value, expected);
}

static double line(double t)
{
	return 1 + 3 * t;
}

static double bend(double t)
{
	return t < 0.5 ? 0 : t - 0.5;
}

static void the_slope_of_a_line_is_its_slope(void **state)
{
	(void)state;
	assert_near(slope_at_end(line, 0.007, 100, -1), 3, 1e-12);
	assert_near(slope_at_end(line, 0.2, 4, -1), 3, 1e-12);  /* steps longer than the window */
	assert_near(slope_at_end(line, 0.01, 2, -1), 3, 1e-12); /* shorter than the window */
	assert_near(slope_at_end(line, 0.0001, 5000, -1), 3, 1e-9);
}

static void the_slope_at_the_start_is_zero(void **state)
{
	(void)state;
	assert_true(slope_at_end(line, 0.01, 0, -1) == 0);
}

static void the_slope_looks_back_over_the_window_only(void **state)
{
	(void)state;
	/* at t = 0.52 the window of 0.05 reaches back to 0.47: 0.02 of it is behind the bend */
	assert_near(slope_at_end(bend, 0.01, 52, -1), 0.02 / 0.05, 1e-9);
}

static void the_slope_is_no_number_until_the_window_is_clean(void **state)
{
	(void)state;
	assert_true(isnan(slope_at_end(line, 0.01, 24, 0.2 - 1e-9)));
	assert_true(!isnan(slope_at_end(line, 0.01, 26, 0.2 - 1e-9)));
	assert_true(isnan(slope_at_end(line, 0.01, 0, 1)));
}

static void sums_lose_no_step_between_rows(void **state)
{
	struct config config = logistic_config("output.series_every=0.13");
	struct dataset steps, times;
	struct run_file *file;
	double sum = 0;

	(void)state;
	must_execute(&config, "a");
	steps = read_dataset("a", "/steps");
	times = read_dataset("a", "/time");
	for (size_t i = 0; i < steps.extent[0]; i++)
		sum += steps.values[i];
	file = open_run("a");
	assert_true(sum == (double)run_file_summary(file)->step);
	run_file_close(file);
	/* 0, the first steps at or after 0.13, 0.26, ..., 0.91, and the end */
	assert_int_equal(times.extent[0], 9);
	assert_true(times.values[8] == 1);
	for (int i = 0; i < 8; i++)
		assert_true(times.values[i] >= i * 0.13 && times.values[i] < i * 0.13 + 0.016);
	free(steps.values);
	free(times.values);
}

static void profiles_come_at_their_times_and_once_at_the_end(void **state)
{
	static const struct {
		const char *settings;
		size_t count;
		double times[4];
	} cases[] = {
		{"output.profiles_at=[]", 1, {1}},
		{"output.profiles_at=[1]", 1, {1}},
		{"output.profiles_at=[0,0.5]", 3, {0, 0.5, 1}},
		{"output.profiles_at=[0.5,0.5001,0.5002]", 4, {0.5, 0.5001, 0.5002, 1}},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct config config = logistic_config(cases[i].settings);
		const char name[] = {(char)('a' + i), '\0'};
		struct dataset times;

		must_execute(&config, name);
		times = read_dataset(name, "/profile_time");
		assert_int_equal(times.extent[0], cases[i].count);
		assert_memory_equal(times.values, cases[i].times, cases[i].count * sizeof(double));
		free(times.values);
	}
}

static void profiles_are_linear_between_two_steps(void **state)
{
	struct config steps = logistic_config("output.profiles_at=[]");
	struct config config;
	struct dataset times, fronts, profiles;
	char settings[128];

	(void)state;
	must_execute(&steps, "a");
	times = read_dataset("a", "/time");
	fronts = read_dataset("a", "/front_position");
	(void)snprintf(settings, sizeof settings, "output.profiles_at=[%.17g,%.17g]",
		0.75 * times.values[20] + 0.25 * times.values[21], times.values[30]);
	config = logistic_config(settings);
	must_execute(&config, "b");
	profiles = read_dataset("b", "/h"); /* the last cell of h is the front, plus one */
	assert_near(
		profiles.values[15], 1 + 0.75 * fronts.values[20] + 0.25 * fronts.values[21], 1e-12);
	assert_true(profiles.values[31] == fronts.values[30] + 1);
	free(times.values);
	free(fronts.values);
	free(profiles.values);
}

/* Gauges and stations are rows of the series, between the cells they lie between. */
static void fields_at_positions_follow_the_series(void **state)
{
	static const char *const names[] = {"/h_gauge", "/h_station", "/u_station"};
	struct config config = logistic_config(
		"output.gauges=[0,0.25,1];output.velocity_at=[0.5];output.series_every=0.05");
	struct dataset data[3], time, h, u;
	size_t last;

	(void)state;
	must_execute(&config, "a");
	time = read_dataset("a", "/time");
	h = read_dataset("a", "/h"); /* the last profile is of the last time */
	u = read_dataset("a", "/u");
	last = time.extent[0] - 1;
	for (int i = 0; i < 3; i++) {
		data[i] = read_dataset("a", names[i]);
		assert_int_equal(data[i].rank, i == 2 ? 3 : 2);
		assert_int_equal(data[i].extent[0], last + 1);
		assert_int_equal(data[i].extent[1], i ? 1 : 3);
	}
	assert_int_equal(data[2].extent[2], 3);
	for (int i = 0; i < 3; i++) { /* cells of this model are 1 m apart */
		const double *row = h.values + (size_t)2 * 16, at[] = {0, 0.25, 1};

		assert_near(
			data[0].values[last * 3 + (size_t)i], row[0] + at[i] * (row[1] - row[0]), 1e-15);
	}
	assert_near(data[1].values[last], 0.5 * (h.values[32] + h.values[33]), 1e-15);
	for (size_t a = 0; a < 3; a++) {
		const double *row = u.values + ((size_t)2 * 3 + a) * 16;

		assert_near(data[2].values[last * 3 + a], 0.5 * (row[0] + row[1]), 1e-15);
	}
	for (int i = 0; i < 3; i++)
		free(data[i].values);
	free(time.values);
	free(h.values);
	free(u.values);
}

static void only_the_end_shortens_steps_and_none_is_tiny(void **state)
{
	(void)state;
	for (int i = 0; i < 18; i++) {
		char settings[128], name[32];
		struct config config;
		struct dataset dt, times;
		double end = 0.2 + 0.0017 * i;
		size_t n;

		(void)snprintf(settings, sizeof settings, "output.profiles_at=[];time.end=%.17g", end);
		(void)snprintf(name, sizeof name, "end-%g", end);
		config = logistic_config(settings);
		must_execute(&config, name);
		dt = read_dataset(name, "/dt");
		times = read_dataset(name, "/time");
		n = dt.extent[0];
		assert_true(times.values[n - 1] == end);
		assert_true(dt.values[0] == 0);
		for (size_t k = 1; k < n; k++)
			assert_in_range((long)(dt.values[k] * 1e6), k + 2 < n ? 9999 : 4999, 15000);
		free(dt.values);
		free(times.values);
	}
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
	const struct CMUnitTest tests[] = {
		TEST(the_slope_of_a_line_is_its_slope),
		TEST(the_slope_at_the_start_is_zero),
		TEST(the_slope_looks_back_over_the_window_only),
		TEST(the_slope_is_no_number_until_the_window_is_clean),
		TEST(sums_lose_no_step_between_rows),
		TEST(profiles_come_at_their_times_and_once_at_the_end),
		TEST(profiles_are_linear_between_two_steps),
		TEST(fields_at_positions_follow_the_series),
		TEST(only_the_end_shortens_steps_and_none_is_tiny),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
