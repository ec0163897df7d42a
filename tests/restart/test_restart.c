/* A run that was stopped and resumed holds the bits of one that never was. */
#include "../run/logistic.h"

#include "base/file.h"
#include "config/config_table.h"

static void stops_anywhere_change_no_bit(void **state)
{
	struct config config = logistic_config("output.gauges=[0.3,1];output.velocity_at=[0.4]");

	(void)state;
	logistic.number = SIGTERM;
	must_execute(&config, "straight");
	for (uint64_t step = 1; step < 70; step += 3) {
		char name[32];

		(void)snprintf(name, sizeof name, "stopped-%llu", (unsigned long long)step);
		logistic.raise_at[0] = step;
		logistic.raise_at[1] = step + 7;
		assert_int_equal(execute_in_child(&config, name, false), EX_INTERRUPTED);
		assert_int_equal(execute_in_child(&config, name, false), EX_INTERRUPTED);
		assert_int_equal(execute_in_child(&config, name, false), 0);
		assert_same_bits("straight", name);
	}
}

static void a_stop_after_every_step_changes_no_bit(void **state)
{
	struct config config = logistic_config("output.series_every=0.07;time.end=0.4");

	(void)state;
	logistic.number = SIGUSR1;
	must_execute(&config, "straight");
	for (int code = EX_INTERRUPTED; code != 0; logistic.raise_at[0]++) {
		code = execute_in_child(&config, "stopped", false);
		if (code != 0)
			assert_int_equal(code, EX_INTERRUPTED);
		assert_true(logistic.raise_at[0] < 100);
	}
	assert_same_bits("straight", "stopped");
}

static void kills_between_checkpoints_change_no_bit(void **state)
{
	struct config config = logistic_config("checkpoint.every_steps=5");

	(void)state;
	logistic.number = SIGKILL;
	must_execute(&config, "straight");
	for (uint64_t step = 3; step < 60; step += 11) {
		struct run_file *file;

		logistic.raise_at[0] = step;
		assert_int_equal(execute_in_child(&config, "killed", false), -SIGKILL);
		file = open_run("killed");
		assert_int_equal(run_file_summary(file)->step, (step - 1) / 5 * 5);
		run_file_close(file);
	}
	logistic.raise_at[0] = 0;
	must_execute(&config, "killed");
	assert_same_bits("straight", "killed");
}

static void the_checkpoint_cadence_changes_no_bit(void **state)
{
	struct config config = logistic_config(""), often = logistic_config("checkpoint.every_steps=1"),
				  clock = logistic_config("checkpoint.every=1e-3");

	(void)state;
	must_execute(&config, "never");
	must_execute(&often, "often");
	must_execute(&clock, "clock");
	assert_same_bits("never", "often");
	assert_same_bits("never", "clock");
}

/* Row of `file` at time t of dataset `times`, or -1. */
static long row_at(const struct dataset *times, double t)
{
	for (size_t i = 0; i < times->extent[0]; i++)
		if (times->values[i] == t)
			return (long)i;
	return -1;
}

/* Every row of the sparse dataset is a row of the dense one, bit by bit. */
static void assert_rows_within(
	const char *sparse, const char *dense, const char *axis, const char *path)
{
	struct dataset few_times = read_dataset(sparse, axis), times = read_dataset(dense, axis);
	struct dataset few = read_dataset(sparse, path), all = read_dataset(dense, path);
	size_t width = 1;

	for (int i = 1; i < all.rank; i++)
		width *= all.extent[i];
	assert_true(few_times.extent[0] > 1);
	for (size_t i = 0; i < few_times.extent[0]; i++) {
		long row = row_at(&times, few_times.values[i]);

		assert_true(row >= 0);
		assert_memory_equal(
			few.values + i * width, all.values + (size_t)row * width, width * sizeof(double));
	}
	free(few_times.values);
	free(times.values);
	free(few.values);
	free(all.values);
}

static void the_cadence_of_series_and_profiles_changes_no_number(void **state)
{
	struct config dense = logistic_config("output.profiles_at=[0.05,0.1,0.2,0.3,0.55]"),
				  sparse = logistic_config("output.profiles_at=[0.1,0.55];output.series_every=0.1");
	static const char *const series[] = {
		"/front_position", "/front_velocity", "/late", "/late_velocity", "/mass"};
	struct dataset times;

	(void)state;
	must_execute(&dense, "dense");
	must_execute(&sparse, "sparse");
	for (size_t i = 0; i < sizeof series / sizeof *series; i++)
		assert_rows_within("sparse", "dense", "/time", series[i]);
	assert_rows_within("sparse", "dense", "/profile_time", "/u");
	assert_rows_within("sparse", "dense", "/profile_time", "/p");
	times = read_dataset("sparse", "/time");
	assert_int_equal(times.extent[0], 11);
	free(times.values);
}

/* As a long run that had its end from the start, for ends that fall everywhere between the steps. */
static void a_later_end_goes_on_to_the_bits_of_the_long_run(void **state)
{
	static const char rest[] = "output.series_every=0.03;output.profiles_at=[0.05]";

	(void)state;
	for (int i = 0; i < 40; i++) {
		char settings[128], name[32], straight[32], kept[64];
		double end = 0.05 + 0.003 * i;
		struct config config;

		(void)snprintf(name, sizeof name, "continued-%d", i);
		(void)snprintf(straight, sizeof straight, "straight-%d", i);
		(void)snprintf(settings, sizeof settings, "%s;time.end=%g", rest, end);
		config = logistic_config(settings);
		must_execute(&config, name);
		(void)snprintf(
			settings, sizeof settings, "%s;time.end=%g", rest, end + 0.001 * (1 + i * i));
		config = logistic_config(settings);
		must_execute(&config, name);
		must_execute(&config, straight);
		assert_same_bits(straight, name);
		(void)snprintf(kept, sizeof kept, "%s/run.end-%g.h5", name, end);
		assert_true(file_exists(in_folder(kept)));
	}
}

/* Count the steps that an attempt takes, by a model that dies at one that is done already. */
static void a_later_end_computes_no_step_again_but_the_shared_ones(void **state)
{
	struct config config = logistic_config("time.end=0.5;output.profiles_at=[]"),
				  later = logistic_config("time.end=1;output.profiles_at=[]");
	struct run_summary first;
	struct error err = {0};

	(void)state;
	must_execute(&config, "a");
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &first, &err), 0);
	logistic.fail = first.step - 2; /* the last two were shared */
	must_execute(&later, "a");
}

static void a_stop_anywhere_in_a_longer_run_changes_no_bit(void **state)
{
	struct config config = logistic_config("time.end=0.4"), later = logistic_config("time.end=0.7");

	(void)state;
	must_execute(&later, "straight");
	logistic.number = SIGTERM;
	/* from within the short run, over its shared steps, to the end of the long one */
	for (uint64_t step = 25; step < 55; step++) {
		char name[32];
		int code;

		(void)snprintf(name, sizeof name, "stopped-%llu", (unsigned long long)step);
		logistic.raise_at[0] = step;
		code = execute_in_child(&config, name, false);
		assert_true(code == EX_INTERRUPTED || code == 0);
		code = execute_in_child(&later, name, false);
		assert_true(code == EX_INTERRUPTED || code == 0);
		logistic.raise_at[0] = step + 2;
		code = execute_in_child(&later, name, false);
		assert_true(code == EX_INTERRUPTED || code == 0);
		must_execute(&later, name);
		assert_same_bits("straight", name);
	}
}

static void an_end_that_moves_twice_changes_no_bit(void **state)
{
	struct config config = logistic_config("time.end=0.4"),
				  later = logistic_config("time.end=0.402"), last = logistic_config("time.end=0.9");

	(void)state;
	must_execute(&config, "a");
	must_execute(&later, "a");
	must_execute(&last, "a");
	must_execute(&last, "straight");
	assert_same_bits("straight", "a");
	assert_true(file_exists(in_folder("a/run.end-0.4.h5")));
	assert_true(file_exists(in_folder("a/run.end-0.402.h5")));
}

static int execute_from(const struct config *config, const char *name, const char *from)
{
	const struct run_options options = {.from = from};
	struct error err = {0};

	return run_execute_model(&logistic_model, config, in_folder(name), &options, &err);
}

static void a_run_can_begin_with_that_of_another_folder_which_stays(void **state)
{
	struct config config = logistic_config("time.end=0.4"), later = logistic_config("time.end=0.9");
	struct run_summary summary;
	struct error err = {0};

	(void)state;
	must_execute(&config, "short");
	assert_int_equal(run_file_peek(in_folder("short/run.h5"), &summary, &err), 0);
	must_execute(&later, "straight");
	logistic.fail = summary.step - 2;
	assert_int_equal(execute_from(&later, "long", in_folder("short")), 0);
	assert_same_bits("straight", "long");
	assert_int_equal(run_file_peek(in_folder("short/run.h5"), &summary, &err), 0);
	assert_true(summary.time == 0.4 && summary.status == RUN_COMPLETE);
}

static void what_is_no_beginning_is_not_gone_on_from(void **state)
{
	static const char *const others[] = {
		"time.end=0.9", "time.end=1.5", "time.end=0.4;time.cfl=0.5"};
	struct config config = logistic_config("time.end=0.9");

	(void)state;
	must_execute(&config, "straight");
	for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
		struct config other = logistic_config(others[i]);
		char first[32], second[32];

		(void)snprintf(first, sizeof first, "other-%zu", i);
		(void)snprintf(second, sizeof second, "run-%zu", i);
		must_execute(&other, first);
		assert_int_equal(execute_from(&config, second, in_folder(first)), 0);
		assert_same_bits("straight", second);
	}
	assert_int_equal(execute_from(&config, "run-absent", in_folder("absent")), 0);
}

static void an_earlier_end_is_refused(void **state)
{
	struct config config = logistic_config("time.end=0.9"), other = logistic_config("time.end=0.4");
	struct error err = {0};

	(void)state;
	must_execute(&config, "a");
	assert_int_equal(execute(&other, "a", false, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_non_null(strstr(err.text, "time.end: 0.9 s -> 0.4 s"));
}

static void a_run_whose_newest_file_is_gone_resumes(void **state)
{
	struct config config = logistic_config("checkpoint.every_steps=5");

	(void)state;
	must_execute(&config, "straight");
	logistic.number = SIGKILL;
	logistic.raise_at[0] = 33;
	assert_int_equal(execute_in_child(&config, "a", false), -SIGKILL);
	assert_int_equal(unlink(in_folder("a/run.h5")), 0);
	logistic.raise_at[0] = 27;
	assert_int_equal(execute_in_child(&config, "a", false), -SIGKILL); /* it begins from step 25 */
	logistic.raise_at[0] = 20;
	must_execute(&config, "a");
	assert_same_bits("straight", "a");
}

static void damage(const char *name)
{
	FILE *file = fopen(in_folder(name), "r+");

	assert_non_null(file);
	assert_int_equal(fseek(file, 5000, SEEK_SET), 0);
	assert_int_equal(fwrite("damage", 1, 6, file), 6);
	assert_int_equal(fclose(file), 0);
}

static void a_damaged_newest_file_falls_back_without_losing_the_good_one(void **state)
{
	struct config config = logistic_config("checkpoint.every_steps=5");
	struct run_summary summary;
	struct error err = {0};

	(void)state;
	must_execute(&config, "straight");
	logistic.number = SIGKILL;
	logistic.raise_at[0] = 33;
	assert_int_equal(execute_in_child(&config, "a", false), -SIGKILL);
	damage("a/run.h5");
	logistic.raise_at[0] = 32;
	assert_int_equal(execute_in_child(&config, "a", false), -SIGKILL);
	/* the checkpoint of step 30 replaced the damaged one: the good one of 25 is still there */
	assert_int_equal(run_file_peek(in_folder("a/run.previous.h5"), &summary, &err), 0);
	assert_int_equal(summary.step, 25);
	logistic.raise_at[0] = 0;
	must_execute(&config, "a");
	assert_same_bits("straight", "a");
}

static void two_damaged_files_are_65_and_stay(void **state)
{
	struct config config = logistic_config("checkpoint.every_steps=5");
	struct run_report report;
	struct error err = {0};

	(void)state;
	must_execute(&config, "a");
	damage("a/run.h5");
	damage("a/run.previous.h5");
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_non_null(strstr(err.text, "run.h5: is damaged"));
	assert_non_null(strstr(err.text, "run.previous.h5: is damaged"));
	assert_true(file_exists(in_folder("a/run.h5")) && file_exists(in_folder("a/run.previous.h5")));
	assert_int_equal(truncate(in_folder("a/run.h5"), 1000), 0);
	assert_int_equal(truncate(in_folder("a/run.previous.h5"), 1000), 0);
	run_report_read(in_folder("a"), &report);
	assert_int_equal(report.state, RUN_STATE_DAMAGED);
}

static uint64_t steps_taken; /* of this process */

static int deadly_step(struct model_state *s, double dt, struct error *err)
{
	if (++steps_taken == logistic.raise_at[0])
		(void)raise(logistic.number);
	return dry_model.step(s, dt, err);
}

/* Of a small dry run, stopped twice between checkpoints. */
static void kills_change_no_bit(const char *name, const char *setting)
{
	static const uint64_t kills[] = {14, 9}; /* begins at 0, at 10, and at 15 to the end */
	char settings[256], straight[64];
	struct config config;

	(void)snprintf(settings, sizeof settings,
		"domain.cells=70;layers=3;time.end=0.25;output.profiles_at=[];%s", setting);
	(void)snprintf(straight, sizeof straight, "straight-%s", name);
	config = logistic_config(settings);
	logistic.raise_at[0] = 0;
	must_execute(&config, straight);
	config.checkpoint.every_steps = 5;
	steps_taken = 0;
	for (size_t i = 0; i < sizeof kills / sizeof *kills; i++) {
		logistic.raise_at[0] = kills[i];
		assert_int_equal(execute_in_child(&config, name, false), -SIGKILL);
	}
	logistic.raise_at[0] = 0;
	must_execute(&config, name);
	assert_same_bits(straight, name);
}

/* Of the dry model, whose solvers may leave something for the next step. */
static void kills_change_no_bit_with_any_pressure_solver(void **state)
{
	const char *const *names = field_find(&config_table, "pressure_solver.method")->choices;
	static struct model deadly;

	(void)state;
	deadly = dry_model;
	deadly.step = deadly_step;
	model_in_use = &deadly;
	logistic.number = SIGKILL;
	for (int method = 0; names[method]; method++) {
		char setting[64];

		(void)snprintf(setting, sizeof setting, "pressure_solver.method=%s", names[method]);
		kills_change_no_bit(names[method], setting);
	}
	kills_change_no_bit(
		"ring", "domain.left=periodic;domain.right=periodic;pressure_solver.start=previous");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
	const struct CMUnitTest tests[] = {
		TEST(stops_anywhere_change_no_bit),
		TEST(a_stop_after_every_step_changes_no_bit),
		TEST(kills_between_checkpoints_change_no_bit),
		TEST(the_checkpoint_cadence_changes_no_bit),
		TEST(the_cadence_of_series_and_profiles_changes_no_number),
		TEST(a_later_end_goes_on_to_the_bits_of_the_long_run),
		TEST(a_later_end_computes_no_step_again_but_the_shared_ones),
		TEST(a_stop_anywhere_in_a_longer_run_changes_no_bit),
		TEST(an_end_that_moves_twice_changes_no_bit),
		TEST(a_run_can_begin_with_that_of_another_folder_which_stays),
		TEST(what_is_no_beginning_is_not_gone_on_from),
		TEST(an_earlier_end_is_refused),
		TEST(a_run_whose_newest_file_is_gone_resumes),
		TEST(a_damaged_newest_file_falls_back_without_losing_the_good_one),
		TEST(two_damaged_files_are_65_and_stay),
		TEST(kills_change_no_bit_with_any_pressure_solver),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
