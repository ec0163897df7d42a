/* Tables from run files made by hand: values, repeats, blanks, what is missing, formats, refusals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "run/image.h"
#include "run/trailer.h"
#include "talus/tables.h"

static const char base[] = "slope: 22 deg\n"
						   "erodible_bed_thickness: 1 m\n"
						   "layers: 4\n"
						   "domain: {x_min: -0.2 m, x_max: 1.4 m, cells: 4}\n"
						   "time: {end: 0.3 s, cfl: 0.5}\n"
						   "output: {profiles_at: [0.1 s, 0.3 s]}\n";

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

	(void)snprintf(command, sizeof command, "true %s", (char *)*state);
	result = chdir("/") || system(command); /* NOLINT(cert-env33-c): a folder of our own */
	free(*state);
	return result;
}

static struct experiment read_experiment(const char *text)
{
	struct experiment experiment;
	struct error err = {0};

	write_file("study.yaml", text);
	if (experiment_read(&experiment, "study.yaml", NULL, NULL, 0, &err))
		fail_msg("%d: %s", err.line, err.text);
	return experiment;
}

/* What a run file of these tests says. */
struct content {
	double cpu_seconds;
	double iterations[3];
	double h[2][4]; /* at 0.1 s and 0.3 s */
	const char *host, *compiler;
	enum run_status status;
};

static void add_series(struct image *image, const char *name, const double values[3])
{
	image_dataset(image, &(struct image_data){.path = name,
							 .units = "1",
							 .long_name = name,
							 .rank = 1,
							 .extent = {3},
							 .scales = {"time"},
							 .values = values});
}

static void add_scale(struct image *image, const char *name, size_t count, const double *values)
{
	image_scale(image, &(struct image_data){.path = name,
						   .units = "1",
						   .long_name = name,
						   .rank = 1,
						   .extent = {count},
						   .values = values});
}

static void add_content(struct image *image, const struct content *content)
{
	static const double time[] = {0, 0.15, 0.3}, profile_time[] = {0.1, 0.3}, x[] = {0, 1, 2, 3};
	static const double front[] = {0, 0.5, 1.25}, cpu[] = {0, 1, 2};

	image_real(image, "cpu_seconds", content->cpu_seconds);
	image_text(image, "talus_version", "0.1.0");
	image_text(image, "git_revision", "abc");
	image_text(image, "compiler", content->compiler ? content->compiler : "cc 1");
	image_text(image, "compiler_flags", "-O3");
	image_text(image, "host", content->host ? content->host : "here");
	add_scale(image, "time", 3, time);
	add_scale(image, "profile_time", 2, profile_time);
	add_scale(image, "x", 4, x);
	add_series(image, "pressure_iterations", content->iterations);
	add_series(image, "front_position", front);
	add_series(image, "cpu_pressure", cpu);
	image_dataset(image, &(struct image_data){.path = "h",
							 .units = "m",
							 .long_name = "h",
							 .rank = 2,
							 .extent = {2, 4},
							 .scales = {"profile_time", "x"},
							 .values = content->h[0]});
}

static void make_run(const struct experiment_run *run, const struct content *content)
{
	struct run_summary summary = {.status = content->status, .step = 7, .time = 0.3};
	struct image *image;
	struct error err = {0};
	unsigned char *bytes, trailer[TRAILER_SIZE];
	size_t size;

	(void)snprintf(summary.config_hash, sizeof summary.config_hash, "%s", run->hash);
	assert_int_equal(file_make_folders(run->folder, &err), 0);
	assert_int_equal(image_create(4096, &image, &err), 0);
	add_content(image, content);
	assert_int_equal(image_finish(image, TRAILER_SIZE, &bytes, &size, &err), 0);
	trailer_write(&summary, bytes, size, trailer);
	assert_int_equal(file_replace(&(struct file_place){.folder = run->folder, .name = "run.h5"},
						 (struct file_part[]){{bytes, size}, {trailer, TRAILER_SIZE}}, 2, &err),
		0);
	free(bytes);
}

static struct content complete(double cpu_seconds, double iterations)
{
	return (struct content){.cpu_seconds = cpu_seconds,
		.iterations = {1, iterations, 2},
		.h = {{1, 1, 1, 1}, {1, 1, 1, 1}},
		.status = RUN_COMPLETE};
}

/* The first table of the experiment in a format; what is missing goes to `missing` if not NULL. */
static char *print(const struct experiment *experiment, const char *format, struct text *missing)
{
	struct table table;
	struct error err = {0};
	struct text out = {0};

	if (table_build(&table, experiment, &experiment->tables[0], "the command", &err))
		fail_msg("%d: %s", err.line, err.text);
	table_format_find(format)->print(&table, &out);
	if (missing)
		*missing = table.missing;
	else
		assert_string_equal(text_string(&table.missing), "");
	if (missing)
		table.missing = (struct text){0};
	table_clean(&table);
	return out.data;
}

static void assert_table(
	const struct experiment *experiment, const char *format, const char *expected)
{
	char *text = print(experiment, format, NULL);

	assert_string_equal(text, expected);
	free(text);
}

#define NOTES "\nMade by talus 0.1.0, abc, cc 1, -O3.\nMade on here.\nAgain with: the command\n"

static void a_table_has_published_values_beside_ours(void **state)
{
	struct experiment e = read_experiment(
		"title: Ours and theirs\n"
		"source: P1 Table 0\n"
		"base: base.yaml\n"
		"runs:\n"
		"  - {layers: 20, n_ini_guess: [0, 10]}\n"
		"  - {layers: 8, n_ini_guess: [0, 4]}\n"
		"tables:\n"
		"  - {name: t, rows: layers, columns: n_ini_guess,\n"
		"     metric: [iterations, cpu-seconds, speed-up], baseline: {n_ini_guess: 0}}\n"
		"published:\n"
		"  t: [[[431, 594.2, null], [71, 183.2, 3.24], null], [null, null, null]]\n");

	(void)state;
	for (size_t i = 0; i < e.run_count; i++) {
		struct content content = complete(12.3456 / (double)(i + 1), 100 * (double)(i + 1));

		make_run(&e.runs[i], &content);
	}
	assert_table(&e, "text",
		"t: Ours and theirs (P1 Table 0)\n"
		"\n"
		"        n_ini_guess 0  n_ini_guess 0  n_ini_guess 0  n_ini_guess 0  n_ini_guess 0  "
		"n_ini_guess 10  n_ini_guess 10  n_ini_guess 10  n_ini_guess 10  n_ini_guess 10  "
		"n_ini_guess 10  n_ini_guess 4  n_ini_guess 4  n_ini_guess 4\n" NOTES);
	experiment_clean(&e);
}

static void repeats_make_a_median_and_half_their_range(void **state)
{
	struct experiment e = read_experiment("title: Times\n"
										  "base: base.yaml\n"
										  "repeat: 3\n"
										  "runs: [{layers: [4, 8]}]\n"
										  "tables: [{name: t, rows: layers, metric: "
										  "[iterations, cpu-seconds]}]\n");
	static const double seconds[] = {10, 123.4, 30, 120.4, 12.5, 140.4};

	(void)state;
	for (size_t i = 0; i < e.run_count; i++) {
		struct content content = complete(seconds[i], 9);

		make_run(&e.runs[i], &content);
	}
	assert_table(&e, "text",
		"t: Times, median of 3 repeats \u00b1 half their range\n"
		"\n"
		"        iterations        CPU s\n"
		"layers                         \n"
		"-------------------------------\n"
		"4                9  12.5 \u00b1 10.0\n"
		"8                9     123 \u00b1 10\n" NOTES);
	experiment_clean(&e);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_folder, leave_folder)

int main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(a_table_has_published_values_beside_ours),
		TEST(repeats_make_a_median_and_half_their_range),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
