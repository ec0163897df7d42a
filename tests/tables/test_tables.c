/* Tables from run files made by hand: values, repeats, blanks, what is missing, formats, refusals. */
#include <math.h>

#include "../base/folder.h"

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

/* With base.yaml in it. */
static int enter_study(void **state)
{
	if (enter_folder(state))
		return -1;
	write_file("base.yaml", base);
	return 0;
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
	double h[2][4];     /* at 0.1 s and 0.3 s; fewer cells fill it from its beginning */
	double u[16];       /* over layers and cells at 0.3 s, in runs of at most so many */
	double left;        /* what x is shifted by */
	double layer_error; /* of v in every layer, where v_steady is 1 */
	double speed;       /* what max_speed is multiplied by */
	double thickest;    /* at the end */
	double farther;     /* of the front */
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

static void add_content(struct image *image, const struct content *content, size_t cells)
{
	static const double time[] = {0, 0.15, 0.3}, profile_time[] = {0.1, 0.3};
	static const double cpu[] = {0, 1, 2};
	static const double residual[] = {0, 3.4e-9, 1.2e-9};
	const double front[] = {0, 0.5, 1.25 + content->farther},
				 thickness[] = {9, 2, content->thickest};
	double x[4];

	assert_true(cells <= 4);
	for (size_t i = 0; i < cells; i++)
		x[i] = ((double)i + 0.5) * 4 / (double)cells - 0.5 + content->left;
	image_real(image, "cpu_seconds", content->cpu_seconds);
	image_text(image, "talus_version", "0.1.0");
	image_text(image, "git_revision", "abc");
	image_text(image, "compiler", content->compiler ? content->compiler : "cc 1");
	image_text(image, "compiler_flags", "-O3");
	image_text(image, "host", content->host ? content->host : "here");
	add_scale(image, "time", 3, time);
	add_scale(image, "profile_time", 2, profile_time);
	add_scale(image, "x", cells, x);
	add_series(image, "pressure_iterations", content->iterations);
	add_series(image, "front_position", front);
	add_series(image, "max_thickness", thickness);
	add_series(image, "cpu_pressure", cpu);
	add_series(image, "pressure_residual", residual);
	image_dataset(image, &(struct image_data){.path = "h",
							 .units = "m",
							 .long_name = "h",
							 .rank = 2,
							 .extent = {2, cells},
							 .scales = {"profile_time", "x"},
							 .values = content->h[0]});
}

/* Profiles over the layers, of a model without x, and its series. */
static void add_layers(struct image *image, const struct content *content, size_t layers)
{
	static const double transfer[] = {-1, 2, 2}, mass[] = {2, 2 + 0x1p-37, 2};
	const double speed[] = {0, content->speed, 4 * content->speed};
	double layer[32], interface[33], v[64], steady[64];

	assert_true(layers <= 32);
	for (size_t a = 0; a <= layers; a++)
		interface[a] = (double)a / (double)layers;
	for (size_t a = 0; a < layers; a++)
		layer[a] = ((double)a + 0.5) / (double)layers;
	for (size_t k = 0; k < 2 * layers; k++) {
		steady[k] = 1;
		v[k] = 1 + (k % 2 ? -1 : 1) * content->layer_error;
	}
	add_scale(image, "layer", layers, layer);
	add_scale(image, "interface", layers + 1, interface);
	add_series(image, "max_speed", speed);
	add_series(image, "fluid_transfer", transfer);
	add_series(image, "solid_mass", mass);
	add_series(image, "mass", (double[]){2, 1.5, 1});
	add_series(image, "mass_outflow", (double[]){0, 0.5, 1 + ldexp(1, -50)});
	add_series(image, "front_velocity", (double[]){2, 0.5, 0.75});
	for (int k = 0; k < 2; k++)
		image_dataset(image, &(struct image_data){.path = k ? "v" : "v_steady",
								 .units = "m s-1",
								 .long_name = "v",
								 .rank = 2,
								 .extent = {2, layers},
								 .scales = {"profile_time", "layer"},
								 .values = k ? v : steady});
}

static void add_velocity(
	struct image *image, const struct content *content, size_t layers, size_t cells)
{
	double u[2 * sizeof content->u / sizeof *content->u] = {0};

	memcpy(u + layers * cells, content->u, layers * cells * sizeof *u);
	image_dataset(image, &(struct image_data){.path = "u",
							 .units = "m s-1",
							 .long_name = "u",
							 .rank = 3,
							 .extent = {2, layers, cells},
							 .scales = {"profile_time", "layer", "x"},
							 .values = u});
}

static void make_run(const struct experiment_run *run, const struct content *content)
{
	struct run_summary summary = {.status = content->status, .step = 7, .time = 0.3};
	struct image *image;
	struct error err = {0};
	unsigned char *bytes, trailer[TRAILER_SIZE];
	size_t size, layers = (size_t)run->config.layers, cells = (size_t)run->config.domain.cells;

	(void)snprintf(summary.config_hash, sizeof summary.config_hash, "%s", run->hash);
	assert_int_equal(file_make_folders(run->folder, &err), 0);
	assert_int_equal(image_create(4096, &image, &err), 0);
	add_content(image, content, cells);
	add_layers(image, content, layers);
	if (layers * cells <= sizeof content->u / sizeof *content->u)
		add_velocity(image, content, layers, cells);
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
		"t: Ours and theirs (P1 Table 0)\n\n"
		"                  n_ini_guess 0                      n_ini_guess 10                    n_ini_guess 4\n"
		"        iterations     CPU s     speed-up  iterations     CPU s      speed-up   iterations  CPU s  speed-up\n"
		"layers  ours    P1  ours     P1            ours    P1  ours     P1  ours    P1\n"
		"-----------------------------------------------------------------------------------------------------------\n"
		"20       100   431  12.3  594.2      1.00   200    71  6.17  183.2  2.00  3.24\n"
		"8        300        4.12             1.00                                              400   3.09      1.33\n" NOTES);
	experiment_clean(&e);
}

static void repeats_make_a_median_and_half_their_range(void **state)
{
	struct experiment e =
		read_experiment("title: Times\n"
						"base: base.yaml\n"
						"repeat: 3\n"
						"runs: [{layers: [4, 8]}]\n"
						"tables: [{name: t, rows: layers, metric: [iterations, cpu-seconds]}]\n");
	static const double seconds[] = {10, 123.4, 30, 120.4, 12.5, 140.4};

	(void)state;
	for (size_t i = 0; i < e.run_count; i++) {
		struct content content = complete(seconds[i], 9);

		make_run(&e.runs[i], &content);
	}
	assert_table(&e, "text",
		"t: Times, median of 3 repeats \u00b1 half their range\n"
		"\n"
		"layers  iterations        CPU s\n"
		"-------------------------------\n"
		"4                9  12.5 \u00b1 10.0\n"
		"8                9     123 \u00b1 10\n" NOTES);
	experiment_clean(&e);
}

static void a_metric_is_what_its_run_file_says(void **state)
{
	struct experiment e = read_experiment(
		"title: All\n"
		"base: base.yaml\n"
		"tables: [{name: t, rows: slope, metric: [steps, runout, step-share-pressure,\n"
		"  ns-per-unknown, residual]}]\n");
	struct content content = complete(6, 9);

	(void)state;
	make_run(&e.runs[0], &content);
	assert_table(&e, "text",
		"t: All\n"
		"\n"
		"slope                   steps  runout m  step 3 %  CPU ns/cell/layer/step  residual\n"
		"-----------------------------------------------------------------------------------\n"
		"0.3839724354387525 rad      7     1.250      50.0                53571429  3.40e-09\n" NOTES);
	experiment_clean(&e);
}

static void differences_are_relative_to_the_mass_above_the_bed(void **state)
{
	struct experiment e =
		read_experiment("title: Errors\n"
						"base: base.yaml\n"
						"runs: [{layers: [8, 4]}]\n"
						"tables: [{name: t, rows: layers, metric: [l1-difference, l2-difference],\n"
						"  reference: {layers: 8}, at: [0.1 s, 0.3 s]}]\n");
	/* the bed is 1 m: reference 3, 4 above it; differences 1, 1 and then 0, 5 */
	struct content reference = complete(1, 1), other = complete(1, 1);

	(void)state;
	memcpy(reference.h, (double[2][4]){{4, 5, 1, 1}, {4, 5, 1, 1}}, sizeof reference.h);
	memcpy(other.h, (double[2][4]){{3, 6, 1, 1}, {4, 10, 1, 1}}, sizeof other.h);
	make_run(&e.runs[0], &reference);
	make_run(&e.runs[1], &other);
	assert_table(&e, "text",
		"t: Errors\n"
		"\n"
		"               l1 %                l2 %\n"
		"layers  at 0.1 s  at 0.3 s  at 0.1 s  at 0.3 s\n"
		"----------------------------------------------\n"
		"8           0.00      0.00      0.00      0.00\n"
		"4          28.57     71.43     28.28    100.00\n" NOTES);
	experiment_clean(&e);
}

/* An order needs a row before: the first one is blank, and nothing is missing. */
static void errors_against_steady_profiles_have_orders_from_row_to_row(void **state)
{
	struct experiment experiment = read_experiment(
		"base: base.yaml\n"
		"runs: [{layers: [2, 4, 8]}]\n"
		"tables: [{name: t, rows: layers, metric: [velocity-l1, velocity-l1-order, velocity-linf, velocity-l2-order]}]\n");
	const double errors[] = {0x1p-4, 0x1p-7, 0x1p-9};

	(void)state;
	for (size_t i = 0; i < 3; i++) {
		struct content content = complete(1, 1);

		content.layer_error = errors[i];
		make_run(&experiment.runs[i], &content);
	}
	assert_table(&experiment, "text",
		"t\n"
		"\n"
		"layers     v L1  order   v Linf  order\n"
		"--------------------------------------\n"
		"2        0.0625          0.0625\n"
		"4       0.00781   3.00  0.00781   3.00\n"
		"8       0.00195   2.00  0.00195   2.00\n" NOTES);
	experiment_clean(&experiment);
}

/* The reference is u = layer + 10 cell of four each, h = 1, 2, 3, 4. Its means are 6.5 and 26.5 over halves of
 * the cells and all layers, and 1.5 and 3.5 of h. */
static void errors_against_a_finer_run_are_those_of_its_means(void **state)
{
	struct experiment experiment = read_experiment(
		"base: base.yaml\n"
		"runs: [{zip: {domain.cells: [2, 4, 4], layers: [1, 2, 4]}}]\n"
		"tables: [{name: t, rows: [domain.cells, layers], reference: {domain.cells: 4, layers: 4},\n"
		"  metric: [h-l1, h-l1-order, u-l1, u-l1-order]}]\n");
	struct content coarse = complete(1, 1), finer = complete(1, 1), reference = complete(1, 1);

	(void)state;
	memcpy(reference.h[1], (double[]){1, 2, 3, 4}, sizeof reference.h[1]);
	for (size_t k = 0; k < 16; k++)
		reference.u[k] = (double)(k - k % 4) / 4 + 10 * (double)(k % 4);
	/* h off by 1/4 in both cells of 2 m, u by 1 and 2: 2 (1.75 + 2 3.25) = 16.5 */
	memcpy(coarse.h, (double[]){9, 9, 1.75, 3.25}, sizeof coarse.h[0]);
	memcpy(coarse.u, (double[]){7.5, 24.5}, 2 * sizeof *coarse.u);
	/* h off by 1/4 in one cell of 1 m, u by 1 and 2 in half the height: 1.25/2 + 2 4/2 = 4.625 */
	memcpy(finer.h[1], (double[]){1.25, 2, 3, 4}, sizeof finer.h[1]);
	memcpy(finer.u, (double[]){1.5, 10.5, 20.5, 30.5, 2.5, 12.5, 22.5, 30.5}, 8 * sizeof *finer.u);
	make_run(&experiment.runs[0], &coarse);
	make_run(&experiment.runs[1], &finer);
	make_run(&experiment.runs[2], &reference);
	/* orders log2(1/0.25) and log2(16.5/4.625); the reference has none */
	assert_table(&experiment, "text",
		"t\n"
		"\n"
		"cells  layers  h L1 m2  order  u L1 m3/s  order\n"
		"-----------------------------------------------\n"
		"2      1          1.00              16.5\n"
		"4      2         0.250   2.00       4.62   1.83\n"
		"4      4          0.00              0.00\n" NOTES);
	experiment_clean(&experiment);
}

/* The bed is 1 m thick; fronts at 1.25 and 1.5 m; u is 2 and 5 m/s in the cell at 2 m. */
static void a_deposit_is_told_by_its_height_its_growth_and_its_velocities(void **state)
{
	struct experiment experiment = read_experiment(
		"base: base.yaml\n"
		"set: {layers: 2}\n"
		"runs: [{slope: [1 deg, 2 deg]}]\n"
		"tables: [{name: t, rows: slope, reference: {slope: 1 deg}, at: 0.3 s, at_x: [2.4 m, 1 m],\n"
		"  metric: [deposit-height, runout-change, mean-velocity]}]\n");
	struct content first = complete(1, 1), second = complete(1, 1);

	(void)state;
	first.thickest = 1.5;
	second.thickest = 1.25;
	second.farther = 0.25;
	memcpy(second.u, (double[]){0, 0, 2, 0, 0, 1, 5, 0}, 8 * sizeof *second.u);
	make_run(&experiment.runs[0], &first);
	make_run(&experiment.runs[1], &second);
	assert_table(&experiment, "text",
		"t\n"
		"\n"
		"       height of deposit m  change of runout %   mean velocity m/s\n"
		"                                                      at 0.3 s\n"
		"slope                                           at_x 2.4 m  at_x 1 m\n"
		"--------------------------------------------------------------------\n"
		"1 deg               0.5000                 0.0       0.000     0.000\n"
		"2 deg               0.2500                20.0       3.500     0.500\n" NOTES);
	experiment_clean(&experiment);
}

/* Prints the table, whose missing cells are for this reason. */
static void assert_missing(const struct experiment *experiment, const char *reason)
{
	struct text missing = {0};

	free(print(experiment, "text", &missing));
	if (!strstr(text_string(&missing), reason))
		fail_msg("no '%s' in: %s", reason, text_string(&missing));
	text_clean(&missing);
}

static void a_place_outside_the_domain_is_refused(void **state)
{
	struct experiment experiment =
		read_experiment("base: base.yaml\nset: {layers: 2}\n"
						"tables: [{name: t, rows: slope, metric: mean-velocity, at_x: 4 m}]\n");
	struct content content = complete(1, 1);

	(void)state;
	make_run(&experiment.runs[0], &content);
	assert_missing(&experiment, ": mean-velocity: x = 4 m lies outside the domain\n");
	experiment_clean(&experiment);
}

static void a_reference_whose_grid_does_not_fit_is_refused(void **state)
{
	struct experiment experiment = read_experiment(
		"base: base.yaml\n"
		"runs: [{zip: {domain.cells: [4, 3, 2, 2], layers: [4, 2, 8, 2]}}]\n"
		"tables: [{name: t, rows: [domain.cells, layers], reference: {domain.cells: 4, layers: 4},\n"
		"  metric: [u-l1, u-l1-order]}]\n");

	(void)state;
	for (size_t i = 0; i < experiment.run_count; i++) {
		struct content content = complete(1, 1);

		content.left = i == 3 ? 0.25 : 0;
		make_run(&experiment.runs[i], &content);
	}
	assert_missing(&experiment,
		": u-l1: 3 cells and 2 layers here do not divide the 4 and 4 of the reference\n");
	assert_missing(&experiment, ": u-l1: 2 cells and 8 layers here do not divide");
	assert_missing(&experiment, ": u-l1: the reference has another domain\n");
	experiment_clean(&experiment);
}

static void an_order_needs_another_grid_in_the_row_before(void **state)
{
	struct experiment experiment =
		read_experiment("base: base.yaml\nruns: [{slope: [1 deg, 2 deg]}]\n"
						"tables: [{name: t, rows: slope, metric: velocity-l1-order}]\n");
	struct content content = complete(1, 1);

	(void)state;
	content.layer_error = 0.5;
	make_run(&experiment.runs[0], &content);
	make_run(&experiment.runs[1], &content);
	assert_missing(
		&experiment, ": velocity-l1-order: the row before has the same cells and layers\n");
	experiment_clean(&experiment);
}

static void numbers_of_series_are_those_of_the_whole_run(void **state)
{
	struct experiment experiment = read_experiment(
		"base: base.yaml\nruns: [{layers: [2, 4]}]\n"
		"tables: [{name: t, rows: layers, reference: {layers: 2},\n"
		"  metric: [final-max-speed, half-speed-time, transfer-sign-change, solid-mass-drift, speed-difference]}]\n");
	struct content first = complete(1, 1), second = complete(1, 1);

	(void)state;
	first.speed = 1;
	second.speed = 1.25;
	make_run(&experiment.runs[0], &first);
	make_run(&experiment.runs[1], &second);
	/* times 0, 0.15, 0.3: half of 0, 1, 4 at 0.2; -1, 2 passes 0 at 0.05; 4 and 5 are 25 % apart */
	assert_table(&experiment, "text",
		"t\n"
		"\n"
		"layers  v max m/s  v max/2 at s  G_f changes sign at s  mass drift 1e-12  v max apart %\n"
		"---------------------------------------------------------------------------------------\n"
		"2            4.00         0.200                 0.0500            3.6380          0.000\n"
		"4            5.00         0.200                 0.0500            3.6380         25.000\n" NOTES);
	experiment_clean(&experiment);
}

static void mass_drifts_by_what_did_not_leave_and_fronts_begin_after_the_release(void **state)
{
	struct experiment experiment = read_experiment(
		"base: base.yaml\n"
		"runs: [{layers: 2}]\n"
		"tables: [{name: t, rows: layers, metric: [mass-drift, first-front-velocity, front-velocity,\n"
		"  front-velocity-time]}]\n");
	struct content content = complete(1, 1);

	(void)state;
	make_run(&experiment.runs[0], &content);
	/* 2 + 2^-50 for 2; of the velocities 2, 0.5, 0.75 at 0, 0.15, 0.3 the first is the jump from the gate */
	assert_table(&experiment, "text",
		"t\n"
		"\n"
		"layers  mass drift 1e-15  front at first m/s  fastest front m/s  fastest at s\n"
		"-----------------------------------------------------------------------------\n"
		"2                    0.4               0.500              0.750         0.300\n" NOTES);
	experiment_clean(&experiment);
}

static void an_unfinished_run_is_missing_and_named(void **state)
{
	struct experiment e = read_experiment(
		"title: Gaps\n"
		"base: base.yaml\n"
		"runs: [{layers: [4, 8], slope: [22 deg, 10 deg]}]\n"
		"tables: [{name: t, rows: layers, columns: slope, metric: [iterations]}]\n");
	struct content content = complete(1, 9);
	struct text missing, expected = {0};
	char *text;

	(void)state;
	make_run(&e.runs[0], &content);
	content.status = RUN_FAILED;
	make_run(&e.runs[1], &content);
	content.status = RUN_UNFINISHED;
	make_run(&e.runs[2], &content);
	text = print(&e, "csv", &missing);
	assert_string_equal(text, "layers,\"slope 22 deg, iterations\",\"slope 10 deg, iterations\"\r\n"
							  "4,9,missing\r\n"
							  "8,missing,missing\r\n");
	text_addf(&expected,
		"table 't': run %s: failed\ntable 't': run %s: interrupted\ntable 't': run %s: pending\n",
		e.runs[1].id, e.runs[2].id, e.runs[3].id);
	assert_string_equal(text_string(&missing), text_string(&expected));
	text_clean(&missing);
	text_clean(&expected);
	free(text);
	experiment_clean(&e);
}

static void a_cell_keeps_the_median_of_the_repeats_that_are_there(void **state)
{
	struct experiment e =
		read_experiment("base: base.yaml\n"
						"repeat: 3\n"
						"tables: [{name: t, rows: layers, metric: cpu-seconds}]\n");
	struct content content = complete(2, 9);
	struct text missing;
	char *text;

	(void)state;
	make_run(&e.runs[0], &content);
	content.cpu_seconds = 4;
	make_run(&e.runs[2], &content);
	text = print(&e, "csv", &missing);
	assert_string_equal(text, "layers,CPU s,\"CPU s, \u00b1\"\r\n4,3,1\r\n");
	assert_non_null(strstr(text_string(&missing), e.runs[1].id));
	text_clean(&missing);
	free(text);
	experiment_clean(&e);
}

static void other_builds_and_machines_are_flagged_where_times_compare(void **state)
{
	static const char *const texts[] = {"base: base.yaml\ntiming: true\nruns: [{layers: [4, 8]}]\n"
										"tables: [{name: t, rows: layers, metric: iterations}]\n",
		"base: base.yaml\nruns: [{layers: [4, 8]}]\n"
		"tables: [{name: t, rows: layers, metric: iterations}]\n"};

	(void)state;
	for (int i = 0; i < 2; i++) {
		struct experiment e = read_experiment(texts[i]);
		struct content content = complete(1, 9);
		char *text;

		make_run(&e.runs[0], &content);
		content.host = "there";
		content.compiler = "cc 2";
		make_run(&e.runs[1], &content);
		text = print(&e, "text", NULL);
		assert_int_equal(
			strstr(text, "Beware: the runs were made by 2 different builds") != NULL, !i);
		assert_int_equal(
			strstr(text, "Beware: the runs were made by 2 different machines") != NULL, !i);
		assert_non_null(strstr(text, "Made on here.\nMade on there.\n"));
		free(text);
		experiment_clean(&e);
	}
}

static void labels_are_numbers_to_programs_where_they_share_a_unit(void **state)
{
	struct experiment e = read_experiment(
		"title: Units\n"
		"base: base.yaml\n"
		"runs: [{slope: [0 deg, 22.5 deg], erodible_bed_thickness: [1 mm, 2 cm], layers: [4]}]\n"
		"tables: [{name: t, rows: [slope, erodible_bed_thickness, layers, pressure], metric: runout}]\n");
	struct content content = complete(1, 9);
	struct text missing;
	char *text;

	(void)state;
	for (size_t i = 0; i < e.run_count; i++)
		make_run(&e.runs[i], &content);
	assert_table(&e, "csv",
		"slope deg,erodible_bed_thickness,layers,pressure,runout m\r\n"
		"0,1 mm,4,non-hydrostatic,1.25\r\n0,2 cm,4,non-hydrostatic,1.25\r\n"
		"22.5,1 mm,4,non-hydrostatic,1.25\r\n22.5,2 cm,4,non-hydrostatic,1.25\r\n");
	text = print(&e, "json", &missing);
	assert_non_null(
		strstr(text, "{\"heads\": [\"slope\"], \"label\": true,\n     \"unit\": \"deg\",\n"
					 "     \"values\": [0, 0, 22.5, 22.5]},"));
	assert_non_null(strstr(text, "\"values\": [\"1 mm\", \"2 cm\", \"1 mm\", \"2 cm\"]},"));
	free(text);
	text_clean(&missing);
	experiment_clean(&e);
}

static void markdown_and_csv_survive_their_own_marks(void **state)
{
	struct experiment e =
		read_experiment("title: Marks\n"
						"source: 'A|B'\n"
						"base: base.yaml\n"
						"runs: [{output.profiles_at: [[0.1 s, 0.3 s]]}]\n"
						"tables: [{name: t, rows: output.profiles_at, metric: iterations}]\n"
						"published: {t: [7]}\n");
	struct content content = complete(1, 9);

	(void)state;
	make_run(&e.runs[0], &content);
	assert_table(&e, "csv",
		"profiles_at,\"iterations, ours\",\"iterations, A|B\"\r\n\"[0.1 s, 0.3 s]\",9,7\r\n");
	assert_table(&e, "markdown",
		"**t: Marks (A|B)**\n"
		"\n"
		"| profiles\\_at | iterations, ours | iterations, A\\|B |\n"
		"| :-- | --: | --: |\n"
		"| [0.1 s, 0.3 s] | 9 | 7 |\n"
		"\n"
		"- Made by talus 0.1.0, abc, cc 1, -O3.\n- Made on here.\n- Again with: the command\n");
	experiment_clean(&e);
}

static void latex_and_json_survive_their_own_marks(void **state)
{
	struct experiment e = read_experiment(
		"title: 'Marks \\ ^ ~ # $ % & _ { } \"<\u00b0>'\n"
		"source: \"A|B\\t\"\n"
		"base: base.yaml\n"
		"runs: [{output.profiles_at: [[0.1 s, 0.3 s]], layers: [4, 8]}]\n"
		"tables: [{name: t_1, rows: output.profiles_at, columns: layers, metric: iterations}]\n"
		"published: {t_1: [[7, null]]}\n");
	struct content content = complete(1, 9);
	struct text missing;
	char *text;

	(void)state;
	make_run(&e.runs[0], &content);
	text = print(&e, "latex", &missing);
	assert_string_equal(text,
		"% \\usepackage{booktabs}\n"
		"\\begin{table}\n\\centering\n"
		"\\caption{t\\_1: Marks \\textbackslash{} \\textasciicircum{} \\textasciitilde{} \\# \\$ \\% \\& "
		"\\_ \\{ \\} \"\\textless{}\\textdegree{}\\textgreater{} (A\\textbar{}B)}\n"
		"\\label{tab:t-1}\n"
		"\\begin{tabular}{lrrr}\n\\toprule\n"
		" & \\multicolumn{2}{c}{layers 4} & layers 8 \\\\\n\\cmidrule(lr){2-3}\n"
		" & \\multicolumn{2}{c}{iterations} & iterations \\\\\n\\cmidrule(lr){2-3}\n"
		"profiles\\_at & ours & A\\textbar{}B &  \\\\\n\\midrule\n"
		"{[}0.1 s, 0.3 s{]} & 9 & 7 & \\emph{missing} \\\\\n\\bottomrule\n"
		"\\end{tabular}\n\\end{table}\n"
		"% Made by talus 0.1.0, abc, cc 1, -O3.\n% Made on here.\n% Again with: the command\n");
	free(text);
	text_clean(&missing);
	text = print(&e, "json", &missing);
	assert_non_null(
		strstr(text, "  \"title\": \"t_1: Marks \\\\ ^ ~ # $ % & _ { } \\\"<\u00b0> (A|B)\",\n"
					 "  \"columns\": [\n"
					 "    {\"heads\": [\"profiles_at\"], \"label\": true,\n"
					 "     \"values\": [\"[0.1 s, 0.3 s]\"]},\n"
					 "    {\"heads\": [\"layers 4\", \"iterations\", \"ours\"], \"label\": false,\n"
					 "     \"values\": [9]},\n"
					 "    {\"heads\": [\"layers 4\", \"iterations\", \"A|B\"], \"label\": false,\n"
					 "     \"values\": [7]},\n"
					 "    {\"heads\": [\"layers 8\", \"iterations\"], \"label\": false,\n"
					 "     \"values\": [null],\n"
					 "     \"missing\": [true]}],\n"));
	assert_non_null(strstr(text, "pending\"]\n}\n"));
	free(text);
	text_clean(&missing);
	experiment_clean(&e);
}

static void errors_against_observations_are_relative_to_what_moved(void **state)
{
	/* h is 3, 5, 1, 1 m at x = 0, 1, 2, 3 m over a bed of 1 m; observed are 4 m at 0.5 and 2 m at
	 * 2 m. Ours there: 4 and 1. The front is 0, 0.5, 1.25 m at 0, 0.15, 0.3 s. */
	struct experiment e =
		read_experiment("title: Errors\n"
						"base: base.yaml\n"
						"observations: [{file: h.csv, only: {layers: 4}}, {file: front.csv}]\n"
						"tables: [{name: t, rows: layers, metric: [l2-observed, front-observed],\n"
						"  at: 0.1 s}]\n");
	struct content content = complete(1, 1);

	(void)state;
	memcpy(content.h, (double[2][4]){{3, 5, 1, 1}, {1, 1, 1, 1}}, sizeof content.h);
	make_run(&e.runs[0], &content);
	write_file("h.csv", "\xEF\xBB\xBF# measured\r\n"
						"\r\n"
						" time [ms] , \"x\" ,h [cm]\r\n"
						"100,0.5,400\r\n"
						" 100,2 , \"200\"\r\n"
						"300,0,\r\n");
	write_file("front.csv", "time,front_position [cm]\n0.15,60\n0.3,125");
	/* weights are equal: sqrt(0 + 1) / sqrt(9 + 1), and 0.1 / sqrt(0.36 + 1.5625) */
	assert_table(&e, "csv",
		"layers,\"l2 from observed %, at 0.1 s\",front from observed %\r\n"
		"4,31.622776601683793,7.212184459746187\r\n");
	experiment_clean(&e);
}

static void bad_observations_are_refused_with_their_place(void **state)
{
	static const struct {
		const char *csv, *message;
	} cases[] = {
		{"", "h.csv:1:1: holds no values: a line that names its columns is wanted first"},
		{"# only\n", "h.csv:2:1: holds no values: a line that names its columns is wanted first"},
		{"time,x,h\n", "h.csv:2:1: holds no values below the names of its columns"},
		{"t,x,h\n", "h.csv:1:1: a column 'time' is wanted: the first line names the columns"},
		{"time,x\n", "h.csv:1:1: a column of values is wanted beside time and x, "
					 "named like a dataset of the run files: h, front_position"},
		{"time,x,h,h\n", "h.csv:1:10: column 'h' stands here twice"},
		{"time,,h\n", "h.csv:1:6: the name of a column is wanted here"},
		{"time,x,h [inch]\n", "h.csv:1:11: unknown unit 'inch'"},
		{"time,x,h [m] y\n", "h.csv:1:8: a unit stands in brackets at the end: h [mm]"},
		{"time,x,h\n0.1,1\n", "h.csv:2:6: this row has 2 of 3 fields"},
		{"time,x,h\n0.1,1,2,3\n", "h.csv:2:9: this row has more than 3 fields"},
		{"time,x,h\n0.1,1, 2x\n", "h.csv:2:8: h: '2x' is not a number"},
		{"time,x,h\n0.1,1,nan\n", "h.csv:2:7: h: 'nan' is not a number"},
		{"time,x,h\n0.1,,2\n", "h.csv:2:5: x is wanted in every row"},
		{"time,x,h\n0.1,1,2\n0.1,1,2\n",
			"h.csv:3:5: x goes from 1 m to 1 m at one time; it must go up"},
		{"time,x,h\n0.1,1,2\n0.05,1,2\n", "h.csv:3:1: time goes back from 0.1 s to 0.05 s"},
		{"time,h\n0.1,1\n0.1,2\n", "h.csv:3:1: time 0.1 s stands here twice"},
		{"time,x,h\n0.1,\"1,2\n",
			"h.csv:2:5: the quote that opens here is not closed in this line"},
		{"time,x,h\n0.1,\"1\"1,2\n", "h.csv:2:8: a comma is wanted behind the quote"},
		{"time,x,h\n0.3,1,2\n0.3,2,2\n", "study.yaml:3:59: table 't': the observations of run "},
		{"time,h\n0.1,2\n", "study.yaml:3:59: table 't': run "},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct experiment e =
			read_experiment("base: base.yaml\n"
							"observations: [{file: h.csv}]\n"
							"tables: [{name: t, rows: layers, metric: l2-observed, at: 0.1 s}]\n");
		struct error err = {0};
		char message[4096];

		write_file("h.csv", cases[i].csv);
		assert_int_equal(table_check(&e, &err), -1);
		assert_int_equal(err.code, EX_DATAERR);
		message[0] = '\0';
		(void)error_format(&err, message, sizeof message);
		message[strlen(cases[i].message)] = '\0';
		assert_string_equal(message, cases[i].message);
		experiment_clean(&e);
	}
}

static void only_chooses_runs_by_value_however_written(void **state)
{
	struct experiment e = read_experiment("title: Some\n"
										  "base: base.yaml\n"
										  "runs: [{layers: [4, 8], slope: [22 deg, 10 deg]}]\n"
										  "tables: [{name: t, rows: layers, metric: iterations,\n"
										  "  only: {slope: 10.0 deg}}]\n");

	(void)state;
	for (size_t i = 0; i < e.run_count; i++) {
		struct content content = complete(1, (double)i + 2);

		make_run(&e.runs[i], &content);
	}
	assert_table(&e, "csv", "layers,iterations\r\n4,3\r\n8,5\r\n");
	experiment_clean(&e);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_study, leave_folder)

int main(void)
{
	const struct CMUnitTest tests[] = {
		TEST(a_table_has_published_values_beside_ours),
		TEST(repeats_make_a_median_and_half_their_range),
		TEST(a_metric_is_what_its_run_file_says),
		TEST(differences_are_relative_to_the_mass_above_the_bed),
		TEST(a_deposit_is_told_by_its_height_its_growth_and_its_velocities),
		TEST(a_place_outside_the_domain_is_refused),
		TEST(errors_against_steady_profiles_have_orders_from_row_to_row),
		TEST(errors_against_a_finer_run_are_those_of_its_means),
		TEST(a_reference_whose_grid_does_not_fit_is_refused),
		TEST(an_order_needs_another_grid_in_the_row_before),
		TEST(numbers_of_series_are_those_of_the_whole_run),
		TEST(mass_drifts_by_what_did_not_leave_and_fronts_begin_after_the_release),
		TEST(an_unfinished_run_is_missing_and_named),
		TEST(a_cell_keeps_the_median_of_the_repeats_that_are_there),
		TEST(other_builds_and_machines_are_flagged_where_times_compare),
		TEST(labels_are_numbers_to_programs_where_they_share_a_unit),
		TEST(markdown_and_csv_survive_their_own_marks),
		TEST(only_chooses_runs_by_value_however_written),
		TEST(latex_and_json_survive_their_own_marks),
		TEST(errors_against_observations_are_relative_to_what_moved),
		TEST(bad_observations_are_refused_with_their_place),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
