/* The configuration of a run: defaults, rules across fields, settings, print, hash, differences. */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "config/config_table.h"
#include "talus/config.h"

#define REQUIRED "slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: 10\n"
#define IMMERSED                                                                                   \
	"model: immersed\nslope: 22 deg\nlayers: 10\ninitial: {solid_fraction: 0.592}\n"               \
	"fluid: {density: 1026 kg/m3, viscosity: 9.8e-3 Pa s}\n"

static void parse(struct config *config, const char *text)
{
	struct error err = {0};

	if (config_parse(config, text, strlen(text), "a.yaml", NULL, 0, &err) != 0)
		fail_msg("%s", err.text);
}

static void parse_with(struct config *config, const char *setting)
{
	struct error err = {0};

	if (config_parse(config, REQUIRED, strlen(REQUIRED), "a.yaml", &setting, 1, &err) != 0)
		fail_msg("%s", err.text);
}

static void path_in_tree(const char *name, char path[4096])
{
	const char *root = getenv("TALUS_ROOT");

	(void)snprintf(path, 4096, "%s/configs/%s", root ? root : ".", name);
}

static void defaults_are_those_of_the_granular_collapse(void **state)
{
	struct config c;

	(void)state;
	parse(&c, REQUIRED);
	assert_int_equal(c.model, MODEL_DRY);
	assert_int_equal(c.pressure, PRESSURE_NON_HYDROSTATIC);
	assert_true(c.slope == 0.38397243543875248);
	assert_true(c.erodible_bed_thickness == 0.00182);
	assert_int_equal(c.layers, 10);
	assert_int_equal(c.n_ini_guess, 0);
	assert_true(c.domain.x_min == -0.2 && c.domain.x_max == 3);
	assert_int_equal(c.domain.cells, 640);
	assert_int_equal(c.domain.left, BOUNDARY_WALL);
	assert_int_equal(c.domain.right, BOUNDARY_OUTFLOW);
	assert_int_equal(c.initial.shape, SHAPE_COLUMN);
	assert_true(c.initial.height == 0.14 && c.initial.front == 0);
	assert_true(c.grains.diameter == 0.0007 && c.grains.density == 2500);
	assert_true(c.grains.solid_fraction == 0.62 && c.rheology.i_0 == 0.279);
	assert_true(c.rheology.mu_s > 0.47697 && c.rheology.mu_s < 0.47698);
	assert_true(c.rheology.mu_2 > 0.72654 && c.rheology.mu_2 < 0.72655);
	assert_true(c.regularisation.strain_rate == 1e-5 && c.regularisation.velocity == 1e-5);
	assert_true(c.time.end == 3 && c.time.cfl == 0.7);
	assert_int_equal(c.time.wave_speed, WAVE_SPEED_FASTEST);
	assert_int_equal(c.scheme.friction_reconstruction, RECONSTRUCTION_RESTING);
	assert_int_equal(c.pressure_solver.method, METHOD_AUTO);
	assert_int_equal(c.pressure_solver.operator_, OPERATOR_SYMMETRIC);
	assert_int_equal(c.pressure_solver.start, START_ZERO);
	assert_int_equal(c.pressure_solver.norm, NORM_L2);
	assert_true(c.pressure_solver.tolerance == 1e-6);
	assert_int_equal(c.pressure_solver.max_iterations, 20000);
	assert_int_equal(c.output.profiles_at.count, 0);
	assert_true(c.output.series_every == 0 && c.output.front_threshold == 0.0005);
	assert_true(c.output.static_speed == 0.01);
	assert_true(c.checkpoint.every == 30);
	assert_int_equal(c.checkpoint.every_steps, 0);
}

static void a_default_may_depend_on_the_model(void **state)
{
	struct config c;

	(void)state;
	parse(&c, REQUIRED);
	assert_int_equal(c.bottom, BOTTOM_FRICTION);
	parse(&c, IMMERSED);
	assert_int_equal(c.bottom, BOTTOM_NO_SLIP);
	parse_with(&c, "bottom=no-slip");
	assert_int_equal(c.bottom, BOTTOM_NO_SLIP);
}

static void choices_name_their_enumerators(void **state)
{
	struct config c;

	(void)state;
	parse(&c, REQUIRED "pressure: hydrostatic\ndomain: {left: outflow, right: wall}\n"
					   "time: {wave_speed: mean}\nscheme: {friction_reconstruction: printed}\n"
					   "pressure_solver: {operator: pointwise, start: previous, norm: linf}\n");
	assert_int_equal(c.pressure, PRESSURE_HYDROSTATIC);
	assert_int_equal(c.domain.left, BOUNDARY_OUTFLOW);
	assert_int_equal(c.domain.right, BOUNDARY_WALL);
	assert_int_equal(c.time.wave_speed, WAVE_SPEED_MEAN);
	assert_int_equal(c.scheme.friction_reconstruction, RECONSTRUCTION_PRINTED);
	assert_int_equal(c.pressure_solver.operator_, OPERATOR_POINTWISE);
	assert_int_equal(c.pressure_solver.start, START_PREVIOUS);
	assert_int_equal(c.pressure_solver.norm, NORM_LINF);
	parse(&c, REQUIRED "pressure: hydrostatic\ndomain: {left: periodic, right: periodic}\n"
					   "initial: {shape: uniform}\nregularisation: {viscosity: bounded}\n"
					   "rheology: {law: constant, strain_rate: second-order}\n");
	assert_int_equal(c.domain.left, BOUNDARY_PERIODIC);
	assert_int_equal(c.domain.right, BOUNDARY_PERIODIC);
	assert_int_equal(c.initial.shape, SHAPE_UNIFORM);
	assert_int_equal(c.regularisation.viscosity, VISCOSITY_BOUNDED);
	assert_int_equal(c.rheology.law, LAW_CONSTANT);
	assert_int_equal(c.rheology.strain_rate, STRAIN_RATE_SECOND_ORDER);
	parse_with(&c, "pressure_solver.norm=l1");
	assert_int_equal(c.pressure_solver.norm, NORM_L1);
}

/* `text` follows REQUIRED, so its first line is line 4. */
static void rules_across_fields_blame_the_later_value(void **state)
{
	static const struct {
		const char *text, *message;
	} cases[] = {
		{"n_ini_guess: 3\n", "a.yaml:4:14: n_ini_guess: 3 does not divide layers (10)"},
		{"n_ini_guess: 10\n", "a.yaml:4:14: n_ini_guess: 10 is not below layers (10)"},
		{"n_ini_guess: 20\n", "a.yaml:4:14: n_ini_guess: 20 is not below layers (10)"},
		{"domain: {x_max: 1 m, x_min: 100 cm}\n",
			"a.yaml:4:29: domain: x_min (1 m) is not below x_max (1 m)"},
		{"domain: {x_max: -1 m}\n",
			"a.yaml:4:17: domain: x_min (-0.2 m) is not below x_max (-1 m)"},
		{"initial: {front: 3.01 m}\n",
			"a.yaml:4:18: initial.front: 3.01 m is outside the domain, 3 m is its x_max"},
		{"initial: {front: -0.1 m}\ndomain: {x_min: 0 m}\n",
			"a.yaml:5:17: initial.front: -0.1 m is outside the domain, 0 m is its x_min"},
		{"rheology: {mu_s: 0.5, mu_2: 0.4}\n",
			"a.yaml:4:29: rheology: mu_s (0.5) is above mu_2 (0.4)"},
		{"rheology: {mu_2: 0.25}\n",
			"a.yaml:4:18: rheology: mu_s (0.4769755326981602) is above mu_2 (0.25)"},
		{"domain: {left: periodic}\n",
			"a.yaml:4:16: domain: left is periodic and right is not; it takes both ends"},
		{"pressure: hydrostatic\ndomain: {right: periodic, left: wall}\n",
			"a.yaml:5:33: domain: right is periodic and left is not; it takes both ends"},
		{"domain: {left: periodic, right: periodic}\npressure_solver: {method: block-direct}\n",
			"a.yaml:5:27: pressure_solver.method: block-direct knows walls and outflows; periodic "
			"ends take auto or conjugate-gradients"},
		{"pressure_solver: {operator: pointwise}\ndomain: {left: periodic, right: periodic}\n",
			"a.yaml:5:16: pressure_solver.operator: pointwise has rows at walls and "
			"outflows (P1 37), none at periodic ends; they take symmetric"},
		{"layer_fractions: [0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.15, 0.05]\n"
		 "pressure_solver: {operator: pointwise}\n",
			"a.yaml:5:29: layer_fractions: pressure_solver.operator: pointwise is P1's, of equal "
			"layers; symmetric takes any"},
		{"rheology: {law: linear}\n",
			"a.yaml:4:17: rheology.law: linear is a law of model: immersed"},
		{"output: {profiles_at: [1 s, 3.5 s]}\n",
			"a.yaml:4:29: output.profiles_at: 3.5 s is after time.end (3 s); an earlier end wants "
			"fewer times: output.profiles_at=[1]"},
		{"output: {profiles_at: [1 s, 2.5 s]}\ntime: {end: 2 s}\n",
			"a.yaml:5:13: output.profiles_at: 2.5 s is after time.end (2 s); an earlier end wants "
			"fewer times: output.profiles_at=[1]"},
		{"output: {gauges: [-0.21, 1]}\n",
			"a.yaml:4:19: output.gauges: -0.21 m is outside the domain, -0.2 m is its x_min"},
		{"output: {velocity_at: [1 m, 1.3 m]}\ndomain: {x_max: 1.2 m}\n",
			"a.yaml:5:17: output.velocity_at: 1.3 m is outside the domain, 1.2 m is its x_max"},
		{"output: {gauges: [1 m, 50 cm]}\n",
			"a.yaml:4:24: output.gauges: 50 cm is not above the value before it"},
		{"output: {profiles_at: [2 s, 1 s]}\n",
			"a.yaml:4:29: output.profiles_at: 1 s is not above the value before it"},
		{"output: {profiles_at: [-1 s]}\n",
			"a.yaml:4:24: output.profiles_at: -1 s is out of range; it must be at least 0"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct config config;
		struct error err = {0};
		struct text text = {0};
		char shown[sizeof err.text];

		text_addf(&text, "%s%s", REQUIRED, cases[i].text);
		assert_int_equal(
			config_parse(&config, text.data, text.length, "a.yaml", NULL, 0, &err), -1);
		assert_int_equal(err.code, EX_DATAERR);
		assert_string_equal(error_format(&err, shown, sizeof shown), cases[i].message);
		text_clean(&text);
	}
}

static void limits_themselves_are_accepted(void **state)
{
	static const char *const settings[] = {"slope=0 deg", "slope=89.99 deg",
		"erodible_bed_thickness=0", "layers=1", "layers=512", "n_ini_guess=5", "n_ini_guess=1",
		"domain.cells=2", "domain.cells=1000000", "time.cfl=1", "grains.solid_fraction=1",
		"initial.front=-0.2 m", "initial.front=3 m", "rheology.mu_2=tan(25.5 deg)",
		"output.profiles_at=[0 s, 3 s]", "output.profiles_at=[]", "checkpoint.every=0",
		"pressure_solver.max_iterations=1", "domain={cells: 20, left: outflow}", "walls.mu_w=0",
		"rheology={law: constant, mu_2: 0.1}", "rheology.strain_rate=second-order"};

	(void)state;
	for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
		struct config config;

		parse_with(&config, settings[i]);
	}
}

/* Just beyond the limits above: what a range wrongly open or closed would let pass. */
static void values_beyond_the_limits_are_refused(void **state)
{
	static const char *const settings[] = {"slope=90 deg", "slope=-1 deg",
		"erodible_bed_thickness=-1e-9 m", "layers=0", "layers=513", "n_ini_guess=-1",
		"domain.cells=1", "domain.cells=1000001", "time.cfl=0", "time.cfl=1.001", "time.end=0 s",
		"grains.solid_fraction=0", "grains.solid_fraction=1.01", "grains.diameter=0 m",
		"grains.density=0 kg/m3", "initial.height=0 m", "rheology.mu_s=0", "rheology.mu_2=0",
		"rheology.i_0=0", "walls.mu_w=-0.1", "walls.width=0 m", "layer_fractions=[1e-7]",
		"regularisation.largest_viscosity=0", "regularisation.strain_rate=0 1/s",
		"regularisation.velocity=0 m/s", "pressure_solver.tolerance=0",
		"pressure_solver.max_iterations=0", "output.series_every=-1 s",
		"output.front_threshold=0 m", "output.static_speed=0 m/s", "checkpoint.every=-1 s",
		"checkpoint.every_steps=-1"};

	(void)state;
	for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
		struct config config;
		struct error err = {0};

		assert_int_equal(
			config_parse(&config, REQUIRED, strlen(REQUIRED), "a.yaml", &settings[i], 1, &err), -1);
		if (!strstr(err.text, " is out of range; it must be "))
			fail_msg("%s: %s", settings[i], err.text);
	}
}

static void later_settings_win_and_replace_the_file_before_checks(void **state)
{
	const char *text = "slope: 22 deg\nerodible_bed_thickness: 1 mm\nlayers: 2.5\n";
	const char *const settings[] = {
		"layers=6", "n_ini_guess=4", "layers=8", "output.profiles_at=[0.32 s, 3 s]"};
	struct config config;
	struct error err = {0};

	(void)state;
	assert_int_equal(config_parse(&config, text, strlen(text), "a.yaml", settings, 4, &err), 0);
	assert_int_equal(config.layers, 8);
	assert_int_equal(config.n_ini_guess, 4);
	assert_int_equal(config.output.profiles_at.count, 2);
	assert_true(config.output.profiles_at.values[0] == 0.32);
}

static void a_required_key_may_come_from_a_setting(void **state)
{
	const char *text = "slope: 22 deg\nlayers: 2\n", *setting = "erodible_bed_thickness=2 mm";
	struct config config;
	struct error err = {0};

	(void)state;
	assert_int_equal(config_parse(&config, text, strlen(text), "a.yaml", &setting, 1, &err), 0);
	assert_true(config.erodible_bed_thickness == 0.002);
}

static void a_bad_setting_cites_itself(void **state)
{
	static const struct {
		const char *setting, *message;
	} cases[] = {
		{"layers=2.5", "layers: 2.5 is not a whole number"},
		{"layer=2", "unknown key 'layer'; did you mean 'layers'?"},
		{"cells=2", "unknown key 'cells'; did you mean 'domain.cells'?"},
		{"tme.cfl=1", "unknown key 'tme.cfl'; did you mean 'time.cfl'?"},
		{"layers", "a setting is written key=value"},
		{"", "a setting is written key=value"},
		{"layers=", "layers: the value is missing"},
		{"layers= ", "layers: the value is missing"},
		{"domain=3", "domain: expected a group of keys, not a single value"},
		{"domain={cell: 3}", "unknown key 'domain.cell'; did you mean 'domain.cells'?"},
		{"layers=[3]", "layers: expected a single value, not a list"},
		{"layers=3: 4", "layers: expected a single value, not a group of keys"},
		{"layers=*a", "layers: anchors and aliases are not supported"},
		{"layers=# 3", "layers: the document is empty"},
		{"n_ini_guess=3", "n_ini_guess: 3 does not divide layers (10)"},
		{"output.profiles_at=[1, 5 s]", "output.profiles_at: 5 s is after time.end (3 s); an "
										"earlier end wants fewer times: output.profiles_at=[1]"},
		{"output.profiles_at=[1, nan]", "output.profiles_at: nan is not a finite decimal number"},
		{"output.profiles_at=[1", "output.profiles_at: not valid YAML: while parsing a flow "
								  "sequence, did not find expected ',' or ']'"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct config config;
		struct error err = {0};
		char shown[sizeof err.text], expected[256];

		assert_int_equal(
			config_parse(&config, REQUIRED, strlen(REQUIRED), "a.yaml", &cases[i].setting, 1, &err),
			-1);
		assert_int_equal(err.code, EX_DATAERR);
		(void)snprintf(
			expected, sizeof expected, "--set %s: %s", cases[i].setting, cases[i].message);
		assert_string_equal(error_format(&err, shown, sizeof shown), expected);
	}
}

static void a_printed_config_reads_back_to_the_same_bytes(void **state)
{
	struct config config, again;
	struct text text = {0};

	(void)state;
	parse(&config, REQUIRED "n_ini_guess: 2\ninitial: {height: 0.1234567890123456789 m}\n"
							"output: {profiles_at: [0.1, 0.32 s, 2500 ms]}\n"
							"rheology: {mu_s: tan(20.9 deg), mu_2: 0.7}\n");
	config_print(&config, &text);
	assert_false(text.failed);
	parse(&again, text_string(&text));
	assert_memory_equal(&config, &again, sizeof config);
	text_clean(&text);
}

/* Every key that the model has can be set to what config_value prints of it, and the config stays the
 * same; every other is refused, by the text as by config_value. */
static void check_keys(const char *required)
{
	struct config config, again;

	parse(&config, required);
	for (size_t i = 0; i < config_table.count; i++) {
		const struct field *field = &config_table.fields[i];
		struct text setting = {0};
		const char *list[1];
		struct error err = {0}, refusal = {0};

		if (field->kind == FIELD_GROUP)
			continue;
		text_addf(&setting, "%s=", field->name);
		if (field_applies(&config_table, field, &config)) {
			assert_int_equal(config_value(&config, field->name, &setting, &err), 0);
			list[0] = text_string(&setting);
			if (config_parse(&again, required, strlen(required), "a.yaml", list, 1, &err) != 0)
				fail_msg("%s: %s", list[0], err.text);
			assert_memory_equal(&config, &again, sizeof config);
		} else {
			text_add(&setting, field->value);
			list[0] = text_string(&setting);
			assert_int_equal(config_value(&config, field->name, &setting, &refusal), -1);
			assert_int_equal(
				config_parse(&again, required, strlen(required), "a.yaml", list, 1, &err), -1);
			assert_int_equal(err.code, EX_DATAERR);
			assert_non_null(strstr(err.text, "is a key of model"));
			assert_string_equal(err.text, refusal.text);
		}
		text_clean(&setting);
	}
}

static void every_key_can_be_set_where_it_applies(void **state)
{
	(void)state;
	check_keys(REQUIRED "output: {profiles_at: [0.32 s]}\n");
	check_keys(IMMERSED);
}

static void a_key_of_another_model_is_refused_at_its_place(void **state)
{
	static const char text[] = IMMERSED "domain: {cells: 20}\n";
	struct config config;
	struct error err = {0};

	(void)state;
	assert_int_equal(config_parse(&config, text, strlen(text), "a.yaml", NULL, 0, &err), -1);
	assert_string_equal(
		err.text, "'domain.cells' is a key of model: dry, and model is immersed here");
	assert_int_equal(err.line, 6);
	assert_int_equal(err.column, 10);
}

/* The hash is that of the printed config: keys of another model must not be in it. */
static void only_keys_that_apply_are_printed(void **state)
{
	struct config config;
	struct text dry = {0}, immersed = {0};

	(void)state;
	parse(&config, REQUIRED);
	config_print(&config, &dry);
	parse(&config, IMMERSED);
	config_print(&config, &immersed);
	assert_null(strstr(text_string(&dry), "fluid"));
	assert_non_null(strstr(text_string(&dry), "domain:\n"));
	assert_non_null(strstr(text_string(&immersed), "fluid:\n"));
	assert_null(strstr(text_string(&immersed), "domain"));
	text_clean(&dry);
	text_clean(&immersed);
}

static void values_are_asked_by_key(void **state)
{
	static const struct {
		const char *key, *value;
	} cases[] = {{"layers", "10"}, {"erodible_bed_thickness", "0.00182 m"},
		{"pressure_solver.operator", "symmetric"}, {"output.profiles_at", "[]"}};
	struct config config;
	struct text text = {0};
	struct error err = {0};

	(void)state;
	parse(&config, REQUIRED);
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		assert_int_equal(config_value(&config, cases[i].key, &text, &err), 0);
		assert_string_equal(text_string(&text), cases[i].value);
		text_clean(&text);
	}
	assert_int_equal(config_value(&config, "layer", &text, &err), -1);
	assert_string_equal(err.text, "unknown key 'layer'; did you mean 'layers'?");
	err = (struct error){0};
	assert_int_equal(config_value(&config, "domain", &text, &err), -1);
	assert_string_equal(err.text, "'domain' is a group of keys, not a key with a value");
	assert_int_equal(err.code, EX_DATAERR);
	assert_int_equal(text.length, 0);
}

static void hash_of(const char *setting, char hash[CONFIG_HASH_SIZE])
{
	struct config config;
	struct error err = {0};

	parse_with(&config, setting);
	assert_int_equal(config_hash(&config, hash, &err), 0);
	assert_int_equal(strlen(hash), 16);
}

static void the_hash_follows_values_not_spellings(void **state)
{
	static const char *const same[] = {"erodible_bed_thickness=0.00182", "time.end=3000 ms",
		"time={end: 0.05 min}", "initial.front=-0 m", "checkpoint.every=1 s",
		"checkpoint.every_steps=7"};
	static const char *const other[] = {"erodible_bed_thickness=1.83 mm", "layers=5",
		"time.end=4 s", "pressure_solver.norm=l1", "output.profiles_at=[1]"};
	char first[CONFIG_HASH_SIZE], second[CONFIG_HASH_SIZE];

	(void)state;
	hash_of("layers=10", first);
	for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
		hash_of(same[i], second);
		assert_string_equal(first, second);
	}
	for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
		hash_of(other[i], second);
		assert_string_not_equal(first, second);
	}
}

static void differences_name_the_keys(void **state)
{
	struct config a, b;
	struct text text = {0};

	(void)state;
	parse(&a, REQUIRED);
	parse(&b, REQUIRED "time: {cfl: 0.5}\ncheckpoint: {every: 1 s}\noutput: {profiles_at: [1]}\n");
	b.layers = 20;
	config_differences(&a, &b, &text);
	assert_string_equal(text_string(&text),
		"layers: 10 -> 20\ntime.cfl: 0.7 -> 0.5\noutput.profiles_at: [] -> [1 s]\n");
	text_clean(&text);
	config_differences(&a, &a, &text);
	assert_string_equal(text_string(&text), "");
}

static void check_reference(const char *model, const char *name, const char *required)
{
	struct config config, defaults;
	struct text text = {0};
	struct error err = {0};
	char path[4096], stored[1 << 16];
	size_t length;
	FILE *file;

	path_in_tree(name, path);
	file = fopen(path, "r");
	assert_non_null(file);
	length = fread(stored, 1, sizeof stored - 1, file);
	stored[length] = '\0';
	assert_int_equal(fclose(file), 0);
	assert_int_equal(config_print_reference(model, &text, &err), 0);
	assert_string_equal(stored, text_string(&text));
	text_clean(&text);
	assert_int_equal(config_read(&config, path, NULL, 0, &err), 0);
	parse(&defaults, required);
	assert_memory_equal(&config, &defaults, sizeof config);
}

static void the_reference_configs_in_the_tree_are_up_to_date_and_read_as_the_defaults(void **state)
{
	(void)state;
	check_reference("dry", "reference.yaml", REQUIRED);
	check_reference("immersed", "reference-immersed.yaml", IMMERSED);
}

/* The annotated config of a model shows every key that it has, with a comment or below a commented
 * group. */
static void check_annotated(const char *name)
{
	struct config config;
	struct node root;
	struct error err = {0};
	char path[4096], key[64];

	path_in_tree(name, path);
	assert_int_equal(config_read(&config, path, NULL, 0, &err), 0);
	assert_int_equal(yaml_load(&root, path, &err), 0);
	for (size_t i = 0; i < config_table.count; i++) {
		const struct node *node = &root;
		char *part, *rest = key;

		if (!field_applies(&config_table, &config_table.fields[i], &config))
			continue;
		(void)snprintf(key, sizeof key, "%s", config_table.fields[i].name);
		while (node && (part = strsep(&rest, ".")) != NULL)
			node = node_find(node, part);
		if (!node)
			fail_msg("%s is not in %s", config_table.fields[i].name, path);
	}
	node_clean(&root);
}

static void the_annotated_configs_have_every_key(void **state)
{
	(void)state;
	check_annotated("granular-collapse.yaml");
	check_annotated("immersed-low-viscosity.yaml");
}

/* A campaign parses thousands. */
static void parsing_takes_well_under_a_millisecond(void **state)
{
	const char *const settings[] = {"layers=20", "n_ini_guess=10", "time.cfl=0.5"};
	struct config config;
	struct error err = {0};
	clock_t start = clock();

	(void)state;
	for (int i = 0; i < 200; i++)
		assert_int_equal(
			config_parse(&config, REQUIRED, strlen(REQUIRED), "a.yaml", settings, 3, &err), 0);
	/* 0.1 ms is usual; 5 ms leaves room for sanitizers, valgrind and a busy machine */
	assert_true((double)(clock() - start) / CLOCKS_PER_SEC / 200 < 5e-3);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(defaults_are_those_of_the_granular_collapse),
		cmocka_unit_test(a_default_may_depend_on_the_model),
		cmocka_unit_test(choices_name_their_enumerators),
		cmocka_unit_test(rules_across_fields_blame_the_later_value),
		cmocka_unit_test(limits_themselves_are_accepted),
		cmocka_unit_test(values_beyond_the_limits_are_refused),
		cmocka_unit_test(later_settings_win_and_replace_the_file_before_checks),
		cmocka_unit_test(a_required_key_may_come_from_a_setting),
		cmocka_unit_test(a_bad_setting_cites_itself),
		cmocka_unit_test(a_printed_config_reads_back_to_the_same_bytes),
		cmocka_unit_test(every_key_can_be_set_where_it_applies),
		cmocka_unit_test(a_key_of_another_model_is_refused_at_its_place),
		cmocka_unit_test(only_keys_that_apply_are_printed),
		cmocka_unit_test(values_are_asked_by_key),
		cmocka_unit_test(the_hash_follows_values_not_spellings),
		cmocka_unit_test(differences_name_the_keys),
		cmocka_unit_test(the_reference_configs_in_the_tree_are_up_to_date_and_read_as_the_defaults),
		cmocka_unit_test(the_annotated_configs_have_every_key),
		cmocka_unit_test(parsing_takes_well_under_a_millisecond),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
