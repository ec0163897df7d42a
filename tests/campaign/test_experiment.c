/* Experiment files: what runs they ask for, what those are called, and what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "talus/experiment.h"

static const char base[] = "slope: 22 deg\n"
						   "erodible_bed_thickness: 1.82 mm\n"
						   "layers: 4\n"
						   "domain: {x_min: -0.2 m, x_max: 1.4 m, cells: 160}\n"
						   "time: {end: 0.3 s, cfl: 0.5}\n";

static void write_file(const char *name, const char *text)
{
	FILE *file = fopen(name, "w");

	assert_non_null(file);
	assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
	assert_int_equal(fclose(file), 0);
}

static int enter_folder(void **state)
{
	char name[] = "/tmp/talus-test-XXXXXX";

	if (!mkdtemp(name) || chdir(name))
		return -1;
	*state = strdup(name);
	write_file("base.yaml", base);
	return 0;
}

static int leave_folder(void **state)
{
	char command[256];
	int result;

	(void)snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
	result = chdir("/") || system(command); /* NOLINT(cert-env33-c): a folder of our own */
	free(*state);
	return result;
}

/* The experiment of this text on top of base.yaml. */
static struct experiment read_good(const char *text, const char *const *overrides, int count)
{
	struct experiment experiment;
	struct error err = {0};
	char message[4096];

	write_file("study.yaml", text);
	if (experiment_read(&experiment, "study.yaml", NULL, overrides, count, &err))
		fail_msg("%s", error_format(&err, message, sizeof message));
	return experiment;
}

static void assert_refused(const char *text, const char *expected)
{
	struct experiment experiment;
	struct error err = {0};
	char message[4096];

	write_file("study.yaml", text);
	assert_int_equal(experiment_read(&experiment, "study.yaml", NULL, NULL, 0, &err), -1);
	experiment_clean(&experiment);
	assert_string_equal(error_format(&err, message, sizeof message), expected);
	assert_int_equal(err.code, EX_DATAERR);
}

/* The part of an id before its hash. */
static void assert_readable(const struct experiment_run *run, const char *expected)
{
	size_t length = strlen(run->id) - 9;

	assert_int_equal(run->id[length], '-');
	assert_memory_equal(run->id + length + 1, run->hash, 8);
	assert_int_equal(length, strlen(expected));
	assert_memory_equal(run->id, expected, length);
}

static void an_entry_is_the_product_of_its_lists_the_last_fastest(void **state)
{
	struct experiment e = read_good("base: base.yaml\n"
									"runs:\n"
									"  - {layers: [8, 4], n_ini_guess: [0, 2]}\n"
									"  - {layers: 10, n_ini_guess: 5}\n",
		NULL, 0);
	static const int layers[] = {8, 8, 4, 4, 10}, guesses[] = {0, 2, 0, 2, 5};

	(void)state;
	assert_int_equal(e.run_count, 5);
	for (size_t i = 0; i < e.run_count; i++) {
		assert_int_equal(e.runs[i].config.layers, layers[i]);
		assert_int_equal(e.runs[i].config.n_ini_guess, guesses[i]);
		assert_int_equal(e.runs[i].config.domain.cells, 160);
	}
	assert_readable(&e.runs[1], "layers-8_n_ini_guess-2");
	experiment_clean(&e);
}

static void no_runs_are_one_run_of_the_base(void **state)
{
	static const char *const texts[] = {
		"base: base.yaml\n", "base: base.yaml\nruns: []\n", "base: base.yaml\nruns:\n"};

	(void)state;
	for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
		struct experiment e = read_good(texts[i], NULL, 0);

		assert_int_equal(e.run_count, 1);
		assert_int_equal(e.runs[0].config.layers, 4);
		assert_readable(&e.runs[0], "base");
		experiment_clean(&e);
	}
}

static void set_applies_below_the_runs_and_the_command_line_above(void **state)
{
	static const char *const overrides[] = {"time.cfl=0.25"};
	struct experiment e = read_good("base: base.yaml\n"
									"set: {layers: 6, time: {end: 0.2 s, cfl: 0.4}}\n"
									"runs: [{layers: 8}, {time.cfl: 0.3}]\n",
		overrides, 1);

	(void)state;
	assert_int_equal(e.runs[0].config.layers, 8);
	assert_int_equal(e.runs[1].config.layers, 6);
	assert_true(e.runs[0].config.time.end == 0.2);
	assert_true(e.runs[1].config.time.cfl == 0.25);
	experiment_clean(&e);
}

static void a_list_in_a_list_is_one_value(void **state)
{
	struct experiment e = read_good("base: base.yaml\n"
									"runs: [{output.profiles_at: [[0.1 s, 0.2 s], [0.3 s]]}]\n",
		NULL, 0);

	(void)state;
	assert_int_equal(e.run_count, 2);
	assert_int_equal(e.runs[0].config.output.profiles_at.count, 2);
	assert_readable(&e.runs[0], "profiles_at-0.1s-0.2s");
	experiment_clean(&e);
}

static void equal_runs_are_merged(void **state)
{
	struct experiment e =
		read_good("base: base.yaml\n"
				  "runs: [{layers: [4, 8]}, {}, {erodible_bed_thickness: 0.00182}]\n",
			NULL, 0);

	(void)state;
	assert_int_equal(e.run_count, 2);
	experiment_clean(&e);
}

static void repeats_come_after_one_another(void **state)
{
	struct experiment e =
		read_good("base: base.yaml\nrepeat: 2\nruns: [{layers: [4, 8]}]\n", NULL, 0);

	(void)state;
	assert_int_equal(e.run_count, 4);
	assert_readable(&e.runs[0], "layers-4_repeat-1");
	assert_readable(&e.runs[1], "layers-8_repeat-1");
	assert_readable(&e.runs[2], "layers-4_repeat-2");
	assert_string_equal(e.runs[0].hash, e.runs[2].hash);
	experiment_clean(&e);
}

static void a_name_has_what_varies_as_it_was_written(void **state)
{
	struct experiment e = read_good("base: base.yaml\n"
									"runs:\n"
									"  - {model: dry, slope: [22 deg, 0.1 rad], "
									"rheology.mu_s: tan(25.5 deg)}\n"
									"  - {rheology.mu_s: '0.4'}\n",
		NULL, 0);

	(void)state;
	assert_readable(&e.runs[0], "model-dry_slope-22deg_mu_s-tan-25.5deg");
	assert_readable(&e.runs[1], "model-dry_slope-0.1rad_mu_s-tan-25.5deg");
	assert_readable(&e.runs[2], "mu_s-0.4");
	experiment_clean(&e);
}

static void keys_that_end_alike_are_written_in_full(void **state)
{
	struct experiment e = read_good(
		"base: base.yaml\n"
		"runs: [{regularisation.velocity: [1e-5, 1e-4], output.static_speed: [0.01, 0.02]},"
		" {initial.front: [0 m, 0.1 m], output.front_threshold: 1 mm}]\n",
		NULL, 0);

	(void)state;
	assert_readable(&e.runs[0], "velocity-1e-5_static_speed-0.01");
	experiment_clean(&e);
}

static void long_names_are_cut_and_stay_apart(void **state)
{
	char text[4096] = "base: base.yaml\nruns: [{layers: [4, 8], output.profiles_at: [[0.000 s";
	struct experiment e;

	(void)state;
	for (int i = 1; i < 100; i++)
		(void)snprintf(text + strlen(text), sizeof text - strlen(text), ", 0.%03d s", i);
	strcat(text, "], [0.2 s]]}]\n"); /* NOLINT: it fits */
	e = read_good(text, NULL, 0);
	for (size_t i = 0; i < e.run_count; i++) {
		assert_true(strlen(e.runs[i].id) < 200);
		for (size_t k = 0; k < i; k++)
			assert_string_not_equal(e.runs[i].id, e.runs[k].id);
	}
	experiment_clean(&e);
}

static void a_folder_is_found_by_hash_whatever_its_name_begins_with(void **state)
{
	const char *text = "base: base.yaml\nruns: [{layers: [4, 8]}]\n";
	struct experiment e = read_good(text, NULL, 0);
	char name[300];

	(void)state;
	assert_int_equal(mkdir("results", 0777), 0);
	assert_int_equal(mkdir("results/study", 0777), 0);
	(void)snprintf(name, sizeof name, "results/study/old-%.8s", e.runs[1].hash);
	assert_int_equal(mkdir(name, 0777), 0);
	experiment_clean(&e);
	e = read_good(text, NULL, 0);
	assert_string_equal(e.runs[1].folder, name);
	(void)snprintf(name, sizeof name, "results/study/%s", e.runs[0].id);
	assert_string_equal(e.runs[0].folder, name);
	experiment_clean(&e);
}

static void the_folder_of_a_single_run_is_that_of_its_first_repeat(void **state)
{
	struct experiment e = read_good("base: base.yaml\n", NULL, 0);
	char name[300];

	(void)state;
	(void)snprintf(name, sizeof name, "results/study/%s", e.runs[0].id);
	assert_int_equal(mkdir("results", 0777), 0);
	assert_int_equal(mkdir("results/study", 0777), 0);
	assert_int_equal(mkdir(name, 0777), 0);
	experiment_clean(&e);
	e = read_good("base: base.yaml\nrepeat: 2\n", NULL, 0);
	assert_string_equal(e.runs[0].folder, name);
	assert_string_not_equal(e.runs[1].folder, name);
	experiment_clean(&e);
}

static void a_run_is_found_by_a_varied_config(void **state)
{
	struct experiment e =
		read_good("base: base.yaml\n"
				  "runs: [{layers: [4, 8]}]\n"
				  "tables: [{name: t, rows: layers, metric: speed-up, baseline: {layers: 8}}]\n",
			NULL, 0);
	struct config config;
	struct error err = {0};
	size_t index = 99;

	(void)state;
	assert_int_equal(experiment_vary(&e, &e.runs[0], &e.tables[0].baseline, &config, &err), 0);
	assert_int_equal(experiment_find(&e, &config, 1, &index, &err), 0);
	assert_int_equal(index, 1);
	assert_int_equal(experiment_find(&e, &config, 2, &index, &err), 0);
	assert_int_equal(index, e.run_count);
	experiment_clean(&e);
}

static void what_is_wrong_is_refused_with_its_place(void **state)
{
	static const struct {
		const char *text, *message;
	} cases[] = {
		{"bse: base.yaml\n", "study.yaml:1:1: unknown key 'bse'; did you mean 'base'?"},
		{"title: x\nzzzzzzzz: 1\n",
			"study.yaml:2:1: unknown key 'zzzzzzzz'; known are: title, source, base, set, runs, "
			"repeat, timing, tables, published, slurm"},
		{"base: base.yaml\nbase: base.yaml\n",
			"study.yaml:2:1: duplicate key 'base'; it is already on line 1"},
		{"title: x\n", "study.yaml:1:1: the experiment lacks its 'base' config"},
		{"[]\n", "study.yaml:1:1: a mapping of keys is wanted here"},
		{"base: base.yaml\nrepeat: 0\n",
			"study.yaml:2:9: repeat: 0 is not a whole number from 1 to 1000"},
		{"base: base.yaml\nrepeat: 1.5\n",
			"study.yaml:2:9: repeat: 1.5 is not a whole number from 1 to 1000"},
		{"base: base.yaml\ntiming: yes\n", "study.yaml:2:9: timing: yes is neither true nor false"},
		{"base: base.yaml\nruns: 5\n", "study.yaml:2:7: runs: a list of mappings is wanted here"},
		{"base: base.yaml\nruns: [5]\n", "study.yaml:2:8: a mapping of config keys is wanted here"},
		{"base: base.yaml\nruns: [{layers: []}]\n",
			"study.yaml:2:17: layers: an empty list asks for no run at all"},
		{"base: base.yaml\nruns:\n  - {layer: 5}\n",
			"study.yaml:3:6: unknown key 'layer'; did you mean 'layers'?"},
		{"base: base.yaml\nset: {time: {cfll: 5}}\n",
			"study.yaml:2:14: unknown key 'time.cfll'; did you mean 'time.cfl'?"},
		{"base: base.yaml\nset: {time: 5}\n",
			"study.yaml:2:7: 'time' is a group of keys, not a key with a value"},
		{"base: base.yaml\nset: {time.cfl: 0.5, time: {cfl: 0.4}}\n",
			"study.yaml:2:29: duplicate key 'time.cfl'"},
		{"base: base.yaml\nruns:\n  - layers: [4, 2.5]\n",
			"study.yaml:3:17: layers: 2.5 is not a whole number"},
		{"base: base.yaml\nruns:\n  - {layers: [4, 10], n_ini_guess: 2}\n  - {layers: 5,\n"
		 "     n_ini_guess: 2}\n",
			"study.yaml:5:19: n_ini_guess: 2 does not divide layers (5)"},
		{"base: base.yaml\nset: {slope: 22}\n",
			"study.yaml:2:14: slope: 22 has no unit; an angle must say deg or rad, as in 22 deg"},
		{"base: base.yaml\nruns: [{layers: }]\n", "study.yaml:2:17: layers: the value is missing"},
		{"base: none.yaml\n",
			"study.yaml:1:7: base: cannot read none.yaml: No such file or directory"},
		{"base: base.yaml\ntables: [{rows: layers, metric: steps}]\n",
			"study.yaml:2:10: this table lacks its 'name'"},
		{"base: base.yaml\ntables: [{name: t, metric: steps}]\n",
			"study.yaml:2:10: table 't' lacks its 'rows'"},
		{"base: base.yaml\ntables: [{name: t, rows: layers}]\n",
			"study.yaml:2:10: table 't' lacks its 'metric'"},
		{"base: base.yaml\ntables: [{name: t, row: layers}]\n",
			"study.yaml:2:20: unknown key 'row'; did you mean 'rows'?"},
		{"base: base.yaml\ntables:\n  - {name: t, rows: layers, metric: steps}\n"
		 "  - {name: t, rows: layers, metric: steps}\n",
			"study.yaml:4:5: table 't' stands here twice"},
		{"base: base.yaml\ntables: [{name: t, rows: [layers, layers], metric: steps}]\n",
			"study.yaml:2:26: rows: layers stands here twice"},
		{"base: base.yaml\npublished: {t: []}\n",
			"study.yaml:2:13: published: no table of this experiment is named 't'"},
		{"base: base.yaml\nruns: [{layers: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]}]\nrepeat: 1000\n",
			"study.yaml:3:9: repeat: an experiment has at most 10000 runs"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
		assert_refused(cases[i].text, cases[i].message);
}

static void a_product_beyond_all_bounds_is_refused_before_it_is_made(void **state)
{
	char text[8192] = "base: base.yaml\nruns:\n  - {";
	static const char *const keys[] = {
		"layers", "domain.cells", "pressure_solver.max_iterations", "checkpoint.every_steps"};

	(void)state;
	for (size_t k = 0; k < 4; k++) {
		(void)snprintf(text + strlen(text), sizeof text - strlen(text), "%s: [", keys[k]);
		for (int i = 1; i <= 100; i++)
			(void)snprintf(text + strlen(text), sizeof text - strlen(text), "%d, ", i);
		(void)snprintf(text + strlen(text), sizeof text - strlen(text), "101], ");
	}
	strcat(text, "}\n"); /* NOLINT: it fits */
	assert_refused(text, "study.yaml:3:5: an experiment has at most 10000 runs");
}

static void a_bad_override_cites_the_command_line(void **state)
{
	static const char *const overrides[] = {"layers=2.5"};
	struct experiment experiment;
	struct error err = {0};
	char message[4096];

	(void)state;
	write_file("study.yaml", "base: base.yaml\nruns: [{layers: 8}]\n");
	assert_int_equal(experiment_read(&experiment, "study.yaml", NULL, overrides, 1, &err), -1);
	experiment_clean(&experiment);
	assert_string_equal(error_format(&err, message, sizeof message),
		"--set layers=2.5: layers: 2.5 is not a whole number");
}

static void an_error_of_the_base_is_cited_there(void **state)
{
	(void)state;
	write_file("base.yaml", "slope: 22 deg\nerodible_bed_thickness: 0\nlayers: many\n");
	assert_refused("base: base.yaml\n", "base.yaml:3:9: layers: many is not a whole number");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_folder, leave_folder)

int main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(an_entry_is_the_product_of_its_lists_the_last_fastest),
		TEST(no_runs_are_one_run_of_the_base),
		TEST(set_applies_below_the_runs_and_the_command_line_above),
		TEST(a_list_in_a_list_is_one_value),
		TEST(equal_runs_are_merged),
		TEST(repeats_come_after_one_another),
		TEST(a_name_has_what_varies_as_it_was_written),
		TEST(keys_that_end_alike_are_written_in_full),
		TEST(long_names_are_cut_and_stay_apart),
		TEST(a_folder_is_found_by_hash_whatever_its_name_begins_with),
		TEST(the_folder_of_a_single_run_is_that_of_its_first_repeat),
		TEST(a_run_is_found_by_a_varied_config),
		TEST(what_is_wrong_is_refused_with_its_place),
		TEST(a_product_beyond_all_bounds_is_refused_before_it_is_made),
		TEST(a_bad_override_cites_the_command_line),
		TEST(an_error_of_the_base_is_cited_there),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
