/* The queue of Slurm over commands that stand in for squeue and scancel. */
#include <sys/stat.h>

#include "../base/folder.h"

#include "base/file.h"
#include "talus/campaign.h"

static void write_program(const char *name, const char *text)
{
	write_file(name, text);
	assert_int_equal(chmod(name, 0755), 0);
}

/* With a folder before those of PATH. */
static int enter_shimmed(void **state)
{
	char path[4096];

	if (enter_folder(state) || mkdir("shim", 0777))
		return -1;
	(void)snprintf(path, sizeof path, "%s/shim:%s", (char *)*state, getenv("PATH"));
	return setenv("PATH", path, 1);
}

/* Three runs, of which the queue has two: one waits, and one computes although it waits as well. */
static struct experiment read_study(void)
{
	struct experiment experiment;
	struct error err = {0};
	struct text runs = {0};

	write_file("base.yaml", "slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: 4\n");
	write_file("study.yaml", "base: base.yaml\nruns: [{layers: [4, 2, 3]}]\n");
	assert_int_equal(experiment_read(&experiment, "study.yaml", NULL, NULL, 0, &err), 0);
	assert_int_equal(file_make_folders("results/study/slurm", &err), 0);
	text_addf(&runs, "gone\n%s\n%s\n", experiment.runs[2].id, experiment.runs[0].id);
	write_file("results/study/slurm/talus-study-1.runs", text_string(&runs));
	text_clean(&runs);
	write_program("shim/squeue",
		"#!/bin/sh\n"
		"echo '12_0 PENDING talus-study-1 (Resources)'\n"
		"echo '12_1 PENDING talus-study-1 Nodes required for job are DOWN'\n"
		"echo '12_2 PENDING talus-study-1 Priority'\n"
		"echo '13_2 RUNNING talus-study-1 None'\n"
		"echo '12_2 PENDING talus-study-1 Priority'\n"
		"echo '12_77 RUNNING talus-study-1 None'\n"
		"echo '14_1 RUNNING talus-study-2 None'\n"
		"echo '15_1 RUNNING ../slurm/talus-study-1 None'\n"
		"echo '16 RUNNING talus-study-1 None'\n");
	return experiment;
}

static void a_task_is_known_by_the_name_of_its_array(void **state)
{
	struct experiment e = read_study();
	struct queue_entry entries[3] = {{.job = ""}};
	struct error err = {0};

	(void)state;
	assert_int_equal(executor_find("slurm")->queue(&e, entries, &err), 0);
	assert_string_equal(entries[0].job, "13_2");
	assert_string_equal(entries[0].state, "RUNNING");
	assert_string_equal(entries[1].job, "");
	assert_string_equal(entries[2].job, "12_1");
	assert_string_equal(entries[2].reason, "Nodes required for job are DOWN");
	experiment_clean(&e);
}

static void an_experiment_that_was_never_submitted_asks_nobody(void **state)
{
	struct experiment e = read_study();
	struct queue_entry entries[3] = {{.job = ""}};
	struct error err = {0};
	size_t count = 7;

	(void)state;
	write_program("shim/squeue", "#!/bin/sh\nexit 1\n");
	assert_int_equal(executor_queue(&e, entries, &err), -1);
	assert_int_equal(err.code, EX_UNAVAILABLE);
	err = (struct error){0};
	assert_int_equal(rename("results/study/slurm", "elsewhere"), 0);
	assert_int_equal(executor_queue(&e, entries, &err), 0);
	assert_int_equal(executor_find("slurm")->cancel(&e, NULL, &count, &err), 0);
	assert_int_equal(count, 0);
	experiment_clean(&e);
}

/* What scancel was asked with `chosen`. */
static void assert_cancels(const bool *chosen, size_t expected, const char *arguments)
{
	struct experiment e = read_study();
	unsigned char *asked = NULL;
	struct error err = {0};
	size_t count, size;

	(void)unlink("asked");
	write_program("shim/scancel", "#!/bin/sh\necho \"$*\" >asked\n");
	assert_int_equal(executor_find("slurm")->cancel(&e, chosen, &count, &err), 0);
	assert_int_equal(count, expected);
	if (*arguments) {
		assert_int_equal(file_read("asked", &asked, &size, &err), 0);
		assert_string_equal((char *)asked, arguments);
	} else {
		assert_false(file_exists("asked"));
	}
	free(asked);
	experiment_clean(&e);
}

static void the_tasks_of_the_chosen_runs_are_cancelled(void **state)
{
	(void)state;
	assert_cancels(NULL, 2, "13_2 12_1\n");
	assert_cancels((bool[]){true, true, false}, 1, "13_2\n");
	assert_cancels((bool[]){false, true, false}, 0, "");
}

static void a_scancel_that_refuses_is_told(void **state)
{
	struct experiment e = read_study();
	struct error err = {0};
	size_t count;

	(void)state;
	write_program("shim/scancel", "#!/bin/sh\necho 'scancel: error: Access denied' >&2; exit 1\n");
	assert_int_equal(executor_find("slurm")->cancel(&e, NULL, &count, &err), -1);
	assert_int_equal(err.code, EX_UNAVAILABLE);
	assert_string_equal(err.text, "scancel ended with code 1: scancel: error: Access denied");
	assert_int_equal(count, 0);
	experiment_clean(&e);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(
			a_task_is_known_by_the_name_of_its_array, enter_shimmed, leave_folder),
		cmocka_unit_test_setup_teardown(
			an_experiment_that_was_never_submitted_asks_nobody, enter_shimmed, leave_folder),
		cmocka_unit_test_setup_teardown(
			the_tasks_of_the_chosen_runs_are_cancelled, enter_shimmed, leave_folder),
		cmocka_unit_test_setup_teardown(
			a_scancel_that_refuses_is_told, enter_shimmed, leave_folder),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
