/* Experiment files: what runs they ask for, what those are called, and what is refused. */
#include <sys/stat.h>

#include "../base/folder.h"

#include "talus/experiment.h"

static const char base[] = "slope: 22 deg\n"
						   "erodible_bed_thickness: 1.82 mm\n"
						   "layers: 4\n"
						   "domain: {x_min: -0.2 m, x_max: 1.4 m, cells: 160}\n"
						   "time: {end: 0.3 s, cfl: 0.5}\n";

/* With base.yaml in it. */
static int enter_study(void **state)
{
	if (enter_folder(state))
		return -1;
	write_file("base.yaml", base);
	return 0;
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
	struct experiment e =
		read_good("base: base.yaml\n"
				  "runs:\n"
				  "  - {model: dry, slope: [22 deg, 0.1 rad], rheology.mu_s: tan(25.5 deg)}\n"
				  "  - {rheology.mu_s: '0.4'}\n",
			NULL, 0);

	(void)state;
	assert_readable(&e.runs[0], "model-dry_slope-22deg");
	assert_readable(&e.runs[1], "model-dry_slope-0.1rad");
	assert_readable(&e.runs[2], "mu_s-0.4");
	experiment_clean(&e);
}

static void a_name_leaves_out_what_follows_from_the_rest(void **state)
{
	struct experiment e = read_good("base: base.yaml\n"
									"runs:\n"
									"  - {slope: 22 deg, time.end: 0.3 s, layers: [4, 8]}\n"
									"  - {slope: 0 deg, time.end: 0.2 s, layers: [4, 8]}\n",
		NULL, 0);

	(void)state;
	assert_readable(&e.runs[0], "slope-22deg_layers-4");
	assert_readable(&e.runs[3], "slope-0deg_layers-8");
	experiment_clean(&e);
}

static void a_zip_goes_in_step_and_multiplies_as_one(void **state)
{
	struct experiment e =
		read_good("base: base.yaml\n"
				  "runs:\n"
				  "  - zip: {layers: [4, 8, 10], n_ini_guess: [2, 4, 5], slope: 20 deg}\n"
				  "    time.cfl: [0.3, 0.4]\n",
			NULL, 0);
	static const int layers[] = {4, 4, 8, 8, 10, 10};

	(void)state;
	assert_int_equal(e.run_count, 6);
	for (size_t i = 0; i < e.run_count; i++) {
		assert_int_equal(e.runs[i].config.layers, layers[i]);
		assert_int_equal(e.runs[i].config.n_ini_guess, layers[i] / 2);
		assert_true(e.runs[i].config.time.cfl == (i % 2 ? 0.4 : 0.3));
	}
	assert_readable(&e.runs[5], "layers-10_cfl-0.4");
	experiment_clean(&e);
}

static void a_range_has_both_ends_and_round_numbers_between(void **state)
{
	struct experiment e =
		read_good("base: base.yaml\n"
				  "runs:\n"
				  "  - time.cfl: {from: 0.1, to: 0.7, steps: 7}\n"
				  "  - layers: {from: 2, to: 10, steps: 3}\n"
				  "  - grains.diameter: {from: 1 mm, to: 0.01 mm, steps: 3, scale: log}\n",
			NULL, 0);

	(void)state;
	assert_int_equal(e.run_count, 13);
	assert_string_equal(e.runs[0].settings.items[0].value, "0.1");
	assert_string_equal(e.runs[2].settings.items[0].value, "0.3");
	assert_string_equal(e.runs[6].settings.items[0].value, "0.7");
	assert_int_equal(e.runs[8].config.layers, 6);
	assert_string_equal(e.runs[11].settings.items[0].value, "0.1 mm");
	assert_string_equal(e.runs[12].settings.items[0].value, "0.01 mm");
	experiment_clean(&e);
}

static const char hypercube[] = "base: base.yaml\n"
								"runs:\n"
								"  - sample: {points: 20, seed: 3}\n"
								"    slope: {from: 20 deg, to: 24 deg}\n"
								"    rheology.mu_s: {from: 0.3, to: 0.5}\n"
								"    layers: {from: 3, to: 6}\n"
								"    time.cfl: [0.3, 0.4]\n";

/* Bit i: a value lies in the i-th of `parts` equal parts. */
static void note(unsigned *parts, unsigned count, double from, double to, double value)
{
	unsigned part = (unsigned)((value - from) / (to - from) * count);

	assert_true(value >= from && value < to && part < count);
	*parts |= 1U << part;
}

static void a_latin_hypercube_has_a_point_in_every_part_of_every_range(void **state)
{
	struct experiment e = read_good(hypercube, NULL, 0), again = read_good(hypercube, NULL, 0);
	unsigned slopes = 0, frictions = 0, layers = 0;

	(void)state;
	assert_int_equal(e.run_count, 40);
	for (size_t i = 0; i < e.run_count; i += 2) {
		note(&slopes, 20, 20, 24, atof(e.runs[i].settings.items[0].value)); /* NOLINT */
		note(&frictions, 20, 0.3, 0.5, e.runs[i].config.rheology.mu_s);
		note(&layers, 4, 3, 7, e.runs[i].config.layers);
		assert_string_equal(e.runs[i].hash, again.runs[i].hash);
		assert_true(e.runs[i].config.slope == e.runs[i + 1].config.slope);
	}
	assert_int_equal(slopes, 0xFFFFF);
	assert_int_equal(frictions, 0xFFFFF);
	assert_int_equal(layers, 0xF);
	assert_readable(&e.runs[0], "point-1_cfl-0.3");
	experiment_clean(&e);
	experiment_clean(&again);
}

static void another_seed_draws_other_points(void **state)
{
	struct experiment e = read_good(hypercube, NULL, 0), other;
	char text[sizeof hypercube];

	(void)state;
	memcpy(text, hypercube, sizeof text);
	*strchr(strstr(text, "seed"), '3') = '4';
	other = read_good(text, NULL, 0);
	assert_string_not_equal(e.runs[0].hash, other.runs[0].hash);
	experiment_clean(&e);
	experiment_clean(&other);
}

static void more_points_of_sobol_keep_those_that_were_drawn(void **state)
{
	static const char format[] = "base: base.yaml\n"
								 "runs:\n"
								 "  - sample: {method: sobol, points: %d, seed: 5}\n"
								 "    slope: {from: 20 deg, to: 24 deg}\n"
								 "    grains.diameter: {from: 0.5 mm, to: 1 mm, scale: log}\n";
	char few[512], many[512];
	struct experiment e, more;
	unsigned slopes = 0;

	(void)state;
	(void)snprintf(few, sizeof few, format, 16);
	(void)snprintf(many, sizeof many, format, 64);
	e = read_good(few, NULL, 0);
	more = read_good(many, NULL, 0);
	assert_int_equal(e.run_count, 16);
	assert_int_equal(more.run_count, 64);
	for (size_t i = 0; i < e.run_count; i++) {
		assert_string_equal(e.runs[i].hash, more.runs[i].hash);
		note(&slopes, 8, 20, 24, atof(e.runs[i].settings.items[0].value)); /* NOLINT */
	}
	assert_int_equal(slopes, 0xFF);
	experiment_clean(&e);
	experiment_clean(&more);
}

static void what_makes_no_axis_is_refused_with_its_place(void **state)
{
	static const char *const cases[][2] = {
		{"slope: {from: 1 deg, to: 2 deg}",
			"study.yaml:2:16: slope: a range needs its 'steps', or a 'sample' beside it"},
		{"slope: {from: 1 deg, steps: 2}", "study.yaml:2:16: slope: a range lacks its 'to'"},
		{"slope: {from: 1 deg, to: 2 rad, steps: 2}",
			"study.yaml:2:34: to: 2 rad has another unit than 1 deg"},
		{"slope: {from: 1 deg, to: 1 deg, steps: 2}",
			"study.yaml:2:34: to: a range of one value; write the value instead"},
		{"slope: {from: tan(1 deg), to: 2 deg, steps: 2}",
			"study.yaml:2:23: from: tan(1 deg) is not a number, or a number and its unit"},
		{"slope: {from: 1 deg, to: 2 deg, steps: 1}",
			"study.yaml:2:48: steps: 1 is not a whole number from 2 to 10000"},
		{"slope: {from: 1 deg, to: 2 deg, step: 3}",
			"study.yaml:2:41: unknown key 'step'; did you mean 'steps'?"},
		{"slope: {from: 0 deg, to: 2 deg, steps: 3, scale: log}",
			"study.yaml:2:23: from: a log scale has only values above 0"},
		{"slope: {from: 1 deg, to: 2 deg, steps: 3, scale: cubic}",
			"study.yaml:2:58: scale: cubic is not one of linear, log"},
		{"layers: {from: 2, to: 5, steps: 3}",
			"study.yaml:2:17: layers: 3.5 is not a whole number"},
		{"zip: {layers: [1, 2], slope: [1 deg, 2 deg, 3 deg]}",
			"study.yaml:2:38: slope: 3 values, and 2 of another key in this zip"},
		{"zip: {layers: [1, 2]}, layers: 3", "study.yaml:2:32: duplicate key 'layers'"},
		{"zip: [1]", "study.yaml:2:14: zip: a mapping of config keys is wanted here"},
		{"sample: {points: 4}, layers: [1, 2]",
			"study.yaml:2:17: sample: no range of this entry is without 'steps', to be sampled"},
		{"sample: {seed: 4}, layers: {from: 1, to: 2}",
			"study.yaml:2:17: sample: a sample lacks its 'points'"},
		{"sample: {points: 2, method: dice}, layers: {from: 1, to: 2}",
			"study.yaml:2:37: method: dice is not one of latin-hypercube, sobol"},
		{"sample: {points: 0}, layers: {from: 1, to: 2}",
			"study.yaml:2:26: points: 0 is not a whole number from 1 to 10000"},
	};
	char text[512];

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		(void)snprintf(text, sizeof text, "base: base.yaml\nruns: [{%s}]\n", cases[i][0]);
		assert_refused(text, cases[i][1]);
	}
	assert_refused("base: base.yaml\nset: {slope: {from: 1 deg, to: 2 deg, steps: 2}}\n",
		"study.yaml:2:14: slope: one value is wanted here; ranges belong into runs");
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
			"study.yaml:2:1: unknown key 'zzzzzzzz'; "
			"known are: title, source, base, set, runs, "
			"repeat, timing, tables, plots, observations, published, slurm"},
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
			"study.yaml:1:7: base: none.yaml cannot be read: No such file or directory"},
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

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_study, leave_folder)

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
		TEST(a_name_leaves_out_what_follows_from_the_rest),
		TEST(a_zip_goes_in_step_and_multiplies_as_one),
		TEST(a_range_has_both_ends_and_round_numbers_between),
		TEST(a_latin_hypercube_has_a_point_in_every_part_of_every_range),
		TEST(another_seed_draws_other_points),
		TEST(more_points_of_sobol_keep_those_that_were_drawn),
		TEST(what_makes_no_axis_is_refused_with_its_place),
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
