/* Campaigns over programs that crash, hang or are not there. */
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "../base/folder.h"

#include "talus/campaign.h"

static const char base[] = "slope: 22 deg\n"
						   "erodible_bed_thickness: 1.82 mm\n"
						   "layers: 4\n";

/* With base.yaml in it. */
static int enter_study(void **state)
{
	if (enter_folder(state))
		return -1;
	write_file("base.yaml", base);
	return 0;
}

/* Two runs with layers 4 and 8, each executed by ./program with this text (NULL: there is none). */
static struct campaign execute_with(struct experiment *experiment, const char *script,
	const struct campaign_watch *watch, struct campaign_options options)
{
	struct campaign campaign;
	struct error err = {0};

	write_file("study.yaml", "base: base.yaml\nruns: [{layers: [4, 8]}]\n");
	if (script) {
		write_file("program", script);
		assert_int_equal(chmod("program", 0700), 0);
	}
	assert_int_equal(experiment_read(experiment, "study.yaml", NULL, NULL, 0, &err), 0);
	assert_int_equal(campaign_create(&campaign, experiment, &options, &err), 0);
	if (watch)
		campaign.watch = *watch;
	assert_int_equal(campaign_execute(&campaign, executor_find("local"), &err), 0);
	return campaign;
}

static struct campaign execute(
	struct experiment *experiment, const char *script, const struct campaign_watch *watch)
{
	return execute_with(experiment, script, watch,
		(struct campaign_options){.jobs = 1, .in_order = true, .program = "./program"});
}

static void a_crash_fails_the_run_and_the_others_go_on(void **state)
{
	struct experiment e;
	struct campaign c = execute(&e,
		"#!/bin/sh\n"
		"echo \"$1 $2 $3 $4 $5\" >>calls\n"
		"echo last words >&2\n"
		"case $2 in *layers-4*) kill -SEGV $$ ;; esac\n"
		"exit 1\n",
		NULL);
	struct text log = {0};

	(void)state;
	assert_int_equal(c.tasks[0].state, TASK_FAILED);
	assert_int_equal(c.tasks[0].code, 128 + SIGSEGV);
	assert_int_equal(c.tasks[1].state, TASK_FAILED);
	assert_int_equal(c.tasks[1].code, 1);
	assert_int_equal(campaign_code(&c), EX_FAILED);
	campaign_log_end(c.tasks[0].run, 5, &log);
	assert_string_equal(text_string(&log), "last words\n");
	text_clean(&log);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void a_run_that_cannot_use_its_files_has_their_code_and_the_others_go_on(void **state)
{
	static const struct {
		const char *script;
		int code;
	} ends[] = {{"#!/bin/sh\nexit 65\n", EX_DATAERR}, {"#!/bin/sh\nexit 73\n", EX_CANTCREAT},
		{"#!/bin/sh\ncase $2 in *layers-4*) exit 74 ;; esac\nexit 1\n", EX_IOERR}};

	(void)state;
	for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
		struct experiment e;
		struct campaign c = execute(&e, ends[i].script, NULL);

		assert_int_equal(c.tasks[0].state, TASK_FAILED);
		assert_int_equal(c.tasks[1].state, TASK_FAILED);
		assert_int_equal(c.fault.code, 0);
		assert_int_equal(campaign_code(&c), ends[i].code);
		campaign_clean(&c);
		experiment_clean(&e);
	}
}

static void a_killed_run_can_be_resumed(void **state)
{
	struct experiment e;
	struct campaign c = execute(&e, "#!/bin/sh\nkill -KILL $$\n", NULL);

	(void)state;
	assert_int_equal(c.tasks[0].state, TASK_INTERRUPTED);
	assert_int_equal(campaign_code(&c), EX_INTERRUPTED);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void a_run_that_claims_to_be_complete_and_is_not_has_failed(void **state)
{
	struct experiment e;
	struct campaign c = execute(&e, "#!/bin/sh\nexit 0\n", NULL);

	(void)state;
	assert_int_equal(c.tasks[0].state, TASK_FAILED);
	assert_int_equal(campaign_code(&c), EX_FAILED);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void a_run_that_is_refused_time_after_time_is_left(void **state)
{
	struct experiment e;
	struct campaign c = execute(&e, "#!/bin/sh\necho >>\"$4/tries\"\nexit 75\n", NULL);
	struct stat tries;
	char name[512];

	(void)state;
	assert_int_equal(c.tasks[0].state, TASK_INTERRUPTED);
	(void)snprintf(name, sizeof name, "%s/tries", c.tasks[0].run->folder);
	assert_int_equal(stat(name, &tries), 0);
	assert_int_equal(tries.st_size, 3);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void a_program_that_is_not_there_fails_with_the_reason_in_the_log(void **state)
{
	struct experiment e;
	struct campaign c = execute(&e, NULL, NULL);
	struct text log = {0};

	(void)state;
	assert_int_equal(c.tasks[0].code, EX_UNAVAILABLE);
	campaign_log_end(c.tasks[0].run, 5, &log);
	assert_string_equal(
		text_string(&log), "talus: cannot start ./program: No such file or directory\n");
	text_clean(&log);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void interrupt_ourselves(void *context, const struct campaign *campaign)
{
	(void)campaign;
	if (access("ready", F_OK) == 0 && ++*(int *)context <= 2)
		(void)kill(getpid(), SIGINT);
}

static void the_first_interrupt_stops_the_runs_and_the_second_ends_the_wait(void **state)
{
	int interrupts = 0;
	const struct campaign_watch watch = {.tick = interrupt_ourselves, .context = &interrupts};
	struct experiment e;
	struct campaign c = execute(&e,
		"#!/bin/sh\n"
		"trap 'touch told' TERM\n"
		"touch ready\n"
		"while [ ! -e enough ]; do sleep 0.05; done\n",
		&watch);

	(void)state;
	assert_int_equal(interrupts, 2);
	assert_int_equal(access("told", F_OK), 0);
	assert_true(c.stopping);
	assert_int_equal(c.tasks[0].state, TASK_RUNNING);
	assert_int_equal(c.tasks[1].state, TASK_WAITING);
	assert_int_equal(campaign_code(&c), EX_INTERRUPTED);
	write_file("enough", "");
	assert_int_equal(waitpid(c.tasks[0].pid, NULL, 0), c.tasks[0].pid);
	campaign_clean(&c);
	experiment_clean(&e);
}

static off_t tries_of(const struct task *task)
{
	struct stat tries;
	char name[512];

	(void)snprintf(name, sizeof name, "%s/tries", task->run->folder);
	return stat(name, &tries) ? 0 : tries.st_size;
}

static void what_crashes_is_tried_again_as_often_as_asked(void **state)
{
	struct experiment e;
	struct campaign c = execute_with(&e, "#!/bin/sh\necho >>\"$4/tries\"\nkill -SEGV $$\n", NULL,
		(struct campaign_options){.jobs = 2, .retry = 3, .program = "./program"});

	(void)state;
	assert_int_equal(tries_of(&c.tasks[0]), 4);
	assert_int_equal(tries_of(&c.tasks[1]), 4);
	assert_int_equal(c.tasks[0].state, TASK_FAILED);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void enough_failures_start_no_more_runs(void **state)
{
	struct experiment e;
	struct campaign c = execute_with(&e, "#!/bin/sh\nexit 74\n", NULL,
		(struct campaign_options){
			.jobs = 1, .max_failures = 1, .in_order = true, .program = "./program"});

	(void)state;
	assert_int_equal(c.tasks[0].state, TASK_FAILED);
	assert_int_equal(c.tasks[1].state, TASK_WAITING);
	assert_true(c.gave_up);
	assert_int_equal(campaign_code(&c), EX_FAILED);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void a_run_that_hangs_is_told_to_stop_after_its_time(void **state)
{
	struct experiment e;
	struct campaign c = execute_with(&e,
		"#!/bin/sh\n"
		"trap 'exit 75' TERM\n"
		"echo >>\"$4/tries\"\n"
		"while :; do sleep 0.05; done\n",
		NULL,
		(struct campaign_options){.jobs = 2, .timeout = 0.3, .retry = 1, .program = "./program"});

	(void)state;
	assert_int_equal(tries_of(&c.tasks[0]), 2);
	assert_int_equal(c.tasks[0].state, TASK_INTERRUPTED);
	assert_string_equal(c.tasks[0].report.reason, "stopped after the --timeout of 0.3 s");
	assert_int_equal(campaign_code(&c), EX_INTERRUPTED);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void cancel_when_ready(void *context, const struct campaign *campaign)
{
	struct error err = {0};

	if (access("ready", F_OK) == 0 && !*(bool *)context) {
		*(bool *)context = true;
		assert_int_equal(campaign_cancel(campaign->experiment, &err), 0);
	}
}

static void a_cancel_stops_this_campaign_and_no_later_one(void **state)
{
	static const char script[] = "#!/bin/sh\n"
								 "trap 'touch told; exit 75' TERM\n"
								 "touch ready\n"
								 "[ -e told ] || while :; do sleep 0.05; done\n"
								 "exit 1\n";
	bool cancelled = false;
	const struct campaign_watch watch = {.tick = cancel_when_ready, .context = &cancelled};
	struct experiment e;
	struct campaign c = execute(&e, script, &watch);

	(void)state;
	assert_true(cancelled && c.stopping);
	assert_int_equal(c.tasks[0].state, TASK_INTERRUPTED);
	assert_int_equal(c.tasks[1].state, TASK_WAITING);
	campaign_clean(&c);
	experiment_clean(&e);
	c = execute(&e, script, NULL);
	assert_false(c.stopping);
	assert_int_equal(c.tasks[1].state, TASK_FAILED);
	campaign_clean(&c);
	experiment_clean(&e);
}

static void a_config_is_written_for_each_run(void **state)
{
	struct experiment e;
	struct campaign c =
		execute(&e, "#!/bin/sh\ngrep -q '^layers: [48]$' \"$2\" || exit 3\nexit 1\n", NULL);

	(void)state;
	assert_int_equal(c.tasks[0].code, 1);
	assert_int_equal(c.tasks[1].code, 1);
	campaign_clean(&c);
	experiment_clean(&e);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_study, leave_folder)

int main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(a_crash_fails_the_run_and_the_others_go_on),
		TEST(a_run_that_cannot_use_its_files_has_their_code_and_the_others_go_on),
		TEST(a_killed_run_can_be_resumed),
		TEST(a_run_that_claims_to_be_complete_and_is_not_has_failed),
		TEST(a_run_that_is_refused_time_after_time_is_left),
		TEST(a_program_that_is_not_there_fails_with_the_reason_in_the_log),
		TEST(the_first_interrupt_stops_the_runs_and_the_second_ends_the_wait),
		TEST(what_crashes_is_tried_again_as_often_as_asked),
		TEST(enough_failures_start_no_more_runs),
		TEST(a_run_that_hangs_is_told_to_stop_after_its_time),
		TEST(a_cancel_stops_this_campaign_and_no_later_one),
		TEST(a_config_is_written_for_each_run),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
