/* A run's life in its folder. */
#include "logistic.h"

#include "base/file.h"
#include "base/lock.h"

static void assert_contains(const char *text, const char *part)
{
	if (!strstr(text, part))
		fail_msg("\"%s\" is not in \"%s\"", part, text);
}

static struct run_report report_of(const char *name)
{
	struct run_report report;

	run_report_read(in_folder(name), &report);
	return report;
}

static void a_run_goes_from_pending_to_complete(void **state)
{
	struct config config = logistic_config("");
	struct run_report report = report_of("a");

	(void)state;
	assert_int_equal(report.state, RUN_STATE_PENDING);
	must_execute(&config, "a");
	report = report_of("a");
	assert_int_equal(report.state, RUN_STATE_COMPLETE);
	assert_true(report.time == 1 && report.end == 1);
	assert_int_equal(report.attempts, 1);
	assert_string_equal(report.reason, "");
}

static void a_complete_run_is_left_alone(void **state)
{
	struct config config = logistic_config("");
	unsigned char *before, *after;
	size_t size, again;
	struct error err = {0};

	(void)state;
	must_execute(&config, "a");
	assert_int_equal(file_read(in_folder("a/run.h5"), &before, &size, &err), 0);
	must_execute(&config, "a");
	assert_int_equal(file_read(in_folder("a/run.h5"), &after, &again, &err), 0);
	assert_int_equal(size, again);
	assert_memory_equal(before, after, size);
	free(before);
	free(after);
}

static void the_folder_holds_the_config_that_was_run(void **state)
{
	struct config config = logistic_config("time.cfl=0.3"), stored;
	struct error err = {0};
	char first[CONFIG_HASH_SIZE], second[CONFIG_HASH_SIZE];

	(void)state;
	must_execute(&config, "deeper/and/deeper/a");
	assert_int_equal(
		config_read(&stored, in_folder("deeper/and/deeper/a/config.yaml"), NULL, 0, &err), 0);
	assert_int_equal(config_hash(&config, first, &err), 0);
	assert_int_equal(config_hash(&stored, second, &err), 0);
	assert_string_equal(first, second);
}

static void another_config_is_refused_and_the_keys_are_named(void **state)
{
	struct config config = logistic_config(""), other = logistic_config("time.cfl=0.3;layers=4");
	struct error err = {0};

	(void)state;
	must_execute(&config, "a");
	assert_int_equal(execute(&other, "a", false, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_contains(err.text, "layers: 3 -> 4, time.cfl: ");
}

static void checkpoint_keys_are_not_another_config(void **state)
{
	struct config config = logistic_config(""), other = logistic_config("checkpoint.every_steps=3");

	(void)state;
	must_execute(&config, "a");
	must_execute(&other, "a");
}

static void another_numerics_version_is_refused(void **state)
{
	struct config config = logistic_config("");
	struct model other = logistic_model;
	const struct run_options options = {0};
	struct error err = {0};

	(void)state;
	other.numerics_version = 8;
	must_execute(&config, "a");
	assert_int_equal(run_execute_model(&other, &config, in_folder("a"), &options, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_contains(err.text, "numerics_version 7, and this program has 8");
}

static void a_failure_keeps_the_checkpoint_and_says_when_and_why(void **state)
{
	struct config config = logistic_config("checkpoint.every_steps=10");
	struct run_summary summary;
	struct run_report report;
	struct error err = {0};

	(void)state;
	logistic.fail = 25;
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_FAILED);
	assert_contains(err.text, "step 25 at t = ");
	assert_contains(err.text, "negative thickness -1 m at x = 3 m");
	err = (struct error){0};
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &summary, &err), 0);
	assert_int_equal(summary.status, RUN_FAILED);
	assert_int_equal(summary.step, 20);
	report = report_of("a");
	assert_int_equal(report.state, RUN_STATE_FAILED);
	assert_contains(report.reason, "negative thickness");
}

static void a_run_that_loses_mass_is_not_complete(void **state)
{
	struct config config = logistic_config("");
	struct run_report report;
	struct error err = {0};

	(void)state;
	logistic.lose = 25;
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_FAILED);
	assert_contains(err.text, "mass and mass_outflow add up to 1024 at first and 1 from it later");
	report = report_of("a");
	assert_int_equal(report.state, RUN_STATE_FAILED);
}

static void the_state_is_known_without_the_status_file(void **state)
{
	struct config config = logistic_config("");
	struct run_report report;
	struct error err = {0};

	(void)state;
	logistic.fail = 25;
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(unlink(in_folder("a/status.yaml")), 0);
	report = report_of("a");
	assert_int_equal(report.state, RUN_STATE_FAILED);
	assert_int_equal(report.attempts, 1);
	assert_true(report.end == 1);
	assert_contains(report.reason, "negative thickness");
}

static void a_failed_run_starts_anew_only_when_told(void **state)
{
	struct config config = logistic_config("");
	struct error err = {0};

	(void)state;
	logistic.fail = 25;
	assert_int_equal(execute(&config, "a", false, &err), -1);
	logistic.fail = 0;
	err = (struct error){0};
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_FAILED);
	assert_contains(err.text, "failed before: ");
	assert_contains(err.text, "negative thickness");
	err = (struct error){0};
	assert_int_equal(execute(&config, "a", true, &err), 0);
	must_execute(&config, "b");
	assert_same_bits("a", "b");
	assert_int_equal(report_of("a").attempts, 2);
}

static void the_end_of_every_attempt_is_kept_with_its_reason(void **state)
{
	struct config config = logistic_config("checkpoint.every_steps=10");
	struct text history = {0};
	struct error err = {0};

	(void)state;
	logistic.number = SIGKILL;
	logistic.raise_at[0] = 15;
	assert_int_equal(execute_in_child(&config, "a", false), -SIGKILL);
	logistic.number = SIGTERM;
	assert_int_equal(execute_in_child(&config, "a", false), EX_INTERRUPTED);
	logistic.raise_at[0] = 0;
	logistic.fail = 25;
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(report_of("a").failures, 1);
	logistic.fail = 0;
	err = (struct error){0};
	assert_int_equal(execute(&config, "a", true, &err), 0);
	run_report_history(in_folder("a"), &history);
	assert_contains(
		text_string(&history), " attempt 1: ended without a word: killed, or the machine");
	assert_contains(
		text_string(&history), " attempt 2: interrupted: stopped by SIGTERM after step 15");
	assert_contains(text_string(&history), " attempt 3: failed: step 25 at t = ");
	assert_contains(text_string(&history), " attempt 4: complete\n");
	text_clean(&history);
	assert_int_equal(report_of("a").failures, 1);
}

static void a_time_step_that_is_no_number_ends_the_run(void **state)
{
	struct config config = logistic_config("");
	struct error err = {0};

	(void)state;
	logistic.vanish = 12;
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_FAILED);
	assert_contains(err.text, "step 12 at t = ");
	assert_contains(err.text, "the time step has become nan s");
}

static void a_locked_run_says_by_whom(void **state)
{
	struct config config = logistic_config("");
	char expected[64];
	struct lock lock;
	struct error err = {0};

	(void)state;
	assert_int_equal(file_make_folders(in_folder("a"), &err), 0);
	assert_int_equal(lock_take(&lock, in_folder("a/run.lock"), &err), 0);
	assert_int_equal(report_of("a").state, RUN_STATE_RUNNING);
	assert_int_equal(execute(&config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_INTERRUPTED);
	(void)snprintf(expected, sizeof expected, "is locked by process %ld on ", (long)getpid());
	assert_contains(err.text, expected);
	lock_release(&lock);
	must_execute(&config, "a");
}

static void asking_for_the_state_takes_no_lock(void **state)
{
	struct lock lock;
	struct error err = {0};

	(void)state;
	assert_false(lock_is_held(in_folder("run.lock")));
	assert_false(file_exists(in_folder("run.lock")));
	assert_int_equal(lock_take(&lock, in_folder("run.lock"), &err), 0);
	lock_release(&lock);
	assert_false(lock_is_held(in_folder("run.lock")));
	assert_true(file_exists(in_folder("run.lock")));
}

static void a_folder_that_cannot_be_made_is_73(void **state)
{
	struct config config = logistic_config("");
	struct error err = {0};

	(void)state;
	assert_int_equal(file_append(in_folder("file"), "text\n", &err), 0);
	assert_int_equal(execute(&config, "file/a", false, &err), -1);
	assert_int_equal(err.code, EX_CANTCREAT);
}

static void a_status_that_cannot_be_written_stops_nobody(void **state)
{
	struct config config = logistic_config("");
	struct error err = {0};

	(void)state;
	assert_int_equal(file_make_folders(in_folder("a/status.yaml"), &err), 0);
	assert_int_equal(file_make_folders(in_folder("a/run.log"), &err), 0);
	must_execute(&config, "a");
	assert_int_equal(report_of("a").state, RUN_STATE_COMPLETE);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
	const struct CMUnitTest tests[] = {
		TEST(a_run_goes_from_pending_to_complete),
		TEST(a_complete_run_is_left_alone),
		TEST(the_folder_holds_the_config_that_was_run),
		TEST(another_config_is_refused_and_the_keys_are_named),
		TEST(checkpoint_keys_are_not_another_config),
		TEST(another_numerics_version_is_refused),
		TEST(a_run_that_loses_mass_is_not_complete),
		TEST(a_failure_keeps_the_checkpoint_and_says_when_and_why),
		TEST(the_state_is_known_without_the_status_file),
		TEST(a_failed_run_starts_anew_only_when_told),
		TEST(the_end_of_every_attempt_is_kept_with_its_reason),
		TEST(a_time_step_that_is_no_number_ends_the_run),
		TEST(a_locked_run_says_by_whom),
		TEST(asking_for_the_state_takes_no_lock),
		TEST(a_folder_that_cannot_be_made_is_73),
		TEST(a_status_that_cannot_be_written_stops_nobody),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
