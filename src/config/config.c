#include "talus/config.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "config/config_table.h"
#include "config/quantity.h"

/* One "key=value" and the name it has in messages. */
struct setting {
	struct field_source source;
	char name[256];
};

/* A word or number, perhaps with a unit, that YAML takes for just that. Nearly all values are, and a
 * parser for each would be most of the time that thousands of runs take to plan. */
static bool is_plain(const char *value)
{
	const char *start = value + (*value == '-' || *value == '+'), *end = start;

	while (isalnum((unsigned char)*end) || (end > start && *end && strchr("._+-/() ", *end)))
		end++;
	return end > start && !*end && end[-1] != ' ';
}

/* The value is YAML, so that lists are written as in a file. */
static int parse_setting(
	struct setting *setting, const char *key, const char *value, struct error *err)
{
	bool blank = !value[strspn(value, " \t")]; /* no YAML document at all */

	if (blank || is_plain(value)) {
		setting->source.root =
			(struct node){.kind = NODE_SCALAR, .text = strdup(blank ? "" : value)};
		return setting->source.root.text ? 0 : error_memory(err, 1);
	}
	if (yaml_parse(&setting->source.root, value, strlen(value), setting->name, err) != 0) {
		err->line = err->column = 0; /* of the value, which nobody sees as a file */
		return error_context(err, "%s", key);
	}
	return 0;
}

static int collect_setting(
	struct field_reader *reader, struct setting *setting, const char *text, struct error *err)
{
	const char *equals = strchr(text, '=');
	int used = snprintf(setting->name, sizeof setting->name, "--set ");
	char *key;
	int status;

	(void)text_excerpt(text, setting->name + used, sizeof setting->name - (size_t)used);
	setting->source.name = setting->name;
	setting->source.setting = true;
	if (!equals)
		return error_at(err, EX_DATAERR, setting->name, 0, 0, "a setting is written key=value");
	key = strndup(text, (size_t)(equals - text));
	if (!key)
		return error_memory(err, (size_t)(equals - text) + 1);
	status = parse_setting(setting, key, equals + 1, err);
	if (status == 0)
		status = field_collect_key(reader, &setting->source, key, &setting->source.root, err);
	free(key);
	return status;
}

static int check_layers(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	int n = config->n_ini_guess;

	if (n >= config->layers)
		(void)error_set(
			err, EX_DATAERR, "n_ini_guess: %d is not below layers (%d)", n, config->layers);
	else if (n > 0 && config->layers % n != 0)
		(void)error_set(
			err, EX_DATAERR, "n_ini_guess: %d does not divide layers (%d)", n, config->layers);
	return err->code ? field_blame(reader, "n_ini_guess", "layers", -1, err) : 0;
}

/* Shapes that end at a gate. */
static bool has_front(const struct config *config)
{
	int shape = config->initial.shape;

	return shape == SHAPE_COLUMN || shape == SHAPE_TRIANGLE || shape == SHAPE_CAP ||
		   config->gate.speed != 0;
}

static int check_domain(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	double x_min = config->domain.x_min, x_max = config->domain.x_max;
	double front = config->initial.front;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (x_min >= x_max) {
		(void)error_set(err, EX_DATAERR, "domain: x_min (%s m) is not below x_max (%s m)",
			text_real(x_min, first), text_real(x_max, second));
		return field_blame(reader, "domain.x_min", "domain.x_max", -1, err);
	}
	if (!has_front(config) || (front >= x_min && front <= x_max))
		return 0;
	(void)error_set(err, EX_DATAERR, "initial.front: %s m is outside the domain, %s m is its %s",
		text_real(front, first), text_real(front < x_min ? x_min : x_max, second),
		front < x_min ? "x_min" : "x_max");
	return field_blame(
		reader, "initial.front", front < x_min ? "domain.x_min" : "domain.x_max", -1, err);
}

/* The rows of P1 (37) tie two faces at either end: fewer cells have no row of their own left. */
static int check_operator(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	int method = config->pressure_solver.method;

	if (config->pressure_solver.operator_ != OPERATOR_POINTWISE)
		return 0;
	if (config_symmetric_only(method)) {
		(void)error_set(err, EX_DATAERR,
			"pressure_solver.method: %s solves symmetric systems only, and "
			"pressure_solver.operator "
			"is pointwise",
			field_find(&config_table, "pressure_solver.method")->choices[method]);
		return field_blame(reader, "pressure_solver.method", "pressure_solver.operator", -1, err);
	}
	if (config->domain.cells >= 4)
		return 0;
	(void)error_set(err, EX_DATAERR,
		"domain.cells: %d is too few for the pointwise operator, which needs 4",
		config->domain.cells);
	return field_blame(reader, "domain.cells", "pressure_solver.operator", -1, err);
}

static int check_rheology(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (config->rheology.law == LAW_LINEAR && config->model != MODEL_IMMERSED) {
		(void)error_set(err, EX_DATAERR, "rheology.law: linear is a law of model: immersed");
		return field_blame(reader, "rheology.law", "model", -1, err);
	}
	if (config->rheology.law == LAW_CONSTANT && config->model != MODEL_DRY) {
		(void)error_set(err, EX_DATAERR,
			"rheology.law: constant is a law of model: dry; in the others linear with k_1: 0 is");
		return field_blame(reader, "rheology.law", "model", -1, err);
	}
	if (config->rheology.law != LAW_MU_I || config->rheology.mu_s <= config->rheology.mu_2)
		return 0;
	(void)error_set(err, EX_DATAERR, "rheology: mu_s (%s) is above mu_2 (%s)",
		text_real(config->rheology.mu_s, first), text_real(config->rheology.mu_2, second));
	return field_blame(reader, "rheology.mu_s", "rheology.mu_2", -1, err);
}

static int check_fractions(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *fractions = &config->layer_fractions;
	char shown[TEXT_REAL_SIZE];
	double sum = 0;

	if (!fractions->count)
		return 0;
	for (int i = 0; i < fractions->count; i++)
		sum += fractions->values[i];
	if (fractions->count != config->layers) {
		(void)error_set(err, EX_DATAERR, "layer_fractions: %d values for layers: %d",
			fractions->count, config->layers);
		return field_blame(reader, "layer_fractions", "layers", -1, err);
	}
	if (!(fabs(sum - 1) <= 1e-9)) {
		(void)error_set(
			err, EX_DATAERR, "layer_fractions: they add up to %s, not to 1", text_real(sum, shown));
		return field_blame(reader, "layer_fractions", NULL, -1, err);
	}
	if (config->model != MODEL_DRY || config->pressure == PRESSURE_HYDROSTATIC ||
		config->pressure_solver.operator_ == OPERATOR_SYMMETRIC)
		return 0;
	(void)error_set(err, EX_DATAERR,
		"layer_fractions: pressure_solver.operator: pointwise is P1's, of equal layers; symmetric "
		"takes any");
	return field_blame(reader, "layer_fractions", "pressure_solver.operator", -1, err);
}

/* What leaves at one end comes in at the other. */
static int check_ends(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	bool left = config->domain.left == BOUNDARY_PERIODIC;
	bool right = config->domain.right == BOUNDARY_PERIODIC;

	if (left != right) {
		(void)error_set(err, EX_DATAERR, "domain: %s is periodic and %s is not; it takes both ends",
			left ? "left" : "right", left ? "right" : "left");
		return field_blame(reader, "domain.left", "domain.right", -1, err);
	}
	if (!left || config->pressure == PRESSURE_HYDROSTATIC)
		return 0;
	if (config->pressure_solver.operator_ == OPERATOR_POINTWISE) {
		(void)error_set(err, EX_DATAERR,
			"pressure_solver.operator: pointwise has rows at walls and outflows (P1 37), none at "
			"periodic ends; they take symmetric");
		return field_blame(reader, "pressure_solver.operator", "domain.left", -1, err);
	}
	if (config_periodic_too(config->pressure_solver.method))
		return 0;
	(void)error_set(err, EX_DATAERR,
		"pressure_solver.method: %s knows walls and outflows; periodic ends take auto or "
		"conjugate-gradients",
		field_find(&config_table, "pressure_solver.method")
			->choices[config->pressure_solver.method]);
	return field_blame(reader, "pressure_solver.method", "domain.left", -1, err);
}

/* Grains that do not sink have no weight to press them together. */
static int check_fluid(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	if (config->model != MODEL_IMMERSED || config->fluid.density < config->grains.density)
		return 0;
	(void)error_set(err, EX_DATAERR,
		"fluid.density: %s kg/m3 is not below grains.density (%s kg/m3)",
		text_real(config->fluid.density, first), text_real(config->grains.density, second));
	return field_blame(reader, "fluid.density", "grains.density", -1, err);
}

/* The times that would do are told as they are to be set: the commonest way here is an earlier end. */
static int check_times(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	const struct real_list *times = &config->output.profiles_at;
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];
	struct text kept = {0};
	int good = 0;

	while (good < times->count && times->values[good] <= config->time.end) {
		text_addf(&kept, "%s%s", good ? "," : "", text_real(times->values[good], first));
		good++;
	}
	if (good < times->count)
		(void)error_set(err, EX_DATAERR,
			"output.profiles_at: %s s is after time.end (%s s); an earlier end wants fewer times: "
			"output.profiles_at=[%s]",
			text_real(times->values[good], first), text_real(config->time.end, second),
			text_string(&kept));
	text_clean(&kept);
	return good < times->count ? field_blame(reader, "output.profiles_at", "time.end", good, err)
							   : 0;
}

static int check_positions(const struct config *config, const char *key,
	const struct real_list *positions, const struct field_reader *reader, struct error *err)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];

	for (int i = 0; i < positions->count; i++) {
		double x = positions->values[i];
		bool left = x < config->domain.x_min;

		if (!left && x <= config->domain.x_max)
			continue;
		(void)error_set(err, EX_DATAERR, "%s: %s m is outside the domain, %s m is its %s", key,
			text_real(x, first),
			text_real(left ? config->domain.x_min : config->domain.x_max, second),
			left ? "x_min" : "x_max");
		return field_blame(reader, key, left ? "domain.x_min" : "domain.x_max", i, err);
	}
	return 0;
}

static int check_output(
	const struct config *config, const struct field_reader *reader, struct error *err)
{
	TRY(check_times(config, reader, err));
	TRY(check_positions(config, "output.gauges", &config->output.gauges, reader, err));
	return check_positions(config, "output.velocity_at", &config->output.velocity_at, reader, err);
}

static int read_tree(struct config *config, const struct field_source *file,
	const char *const *settings, int count, struct error *err)
{
	struct field_reader reader = {.table = &config_table};
	struct setting *list = NULL;
	int status = -1;

	memset(config, 0, sizeof *config);
	if (count > 0) {
		list = calloc((size_t)count, sizeof *list);
		if (!list)
			return error_memory(err, (size_t)count * sizeof *list);
	}
	if (field_collect(&reader, file, &file->root, err) != 0)
		goto done;
	for (int i = 0; i < count; i++)
		if (collect_setting(&reader, &list[i], settings[i], err) != 0)
			goto done;
	if (field_convert(&reader, config, err) == 0 && check_layers(config, &reader, err) == 0 &&
		check_domain(config, &reader, err) == 0 && check_ends(config, &reader, err) == 0 &&
		check_rheology(config, &reader, err) == 0 && check_output(config, &reader, err) == 0 &&
		check_operator(config, &reader, err) == 0 && check_fractions(config, &reader, err) == 0 &&
		check_fluid(config, &reader, err) == 0 && config_check_geometry(config, &reader, err) == 0)
		status = 0;
done:
	for (int i = 0; i < count; i++)
		node_clean(&list[i].source.root);
	free(list);
	return status;
}

int config_read(struct config *config, const char *path, const char *const *settings, int count,
	struct error *err)
{
	struct field_source file = {.name = path};
	int status = yaml_load(&file.root, path, err);

	if (status == 0)
		status = read_tree(config, &file, settings, count, err);
	node_clean(&file.root);
	return status;
}

int config_parse(struct config *config, const char *text, size_t length, const char *name,
	const char *const *settings, int count, struct error *err)
{
	struct field_source file = {.name = name};
	int status = yaml_parse(&file.root, text, length, name, err);

	if (status == 0)
		status = read_tree(config, &file, settings, count, err);
	node_clean(&file.root);
	return status;
}

int config_from_node(struct config *config, const struct node *root, const char *name,
	const char *const *settings, int count, struct error *err)
{
	const struct field_source file = {.name = name, .root = *root};

	return read_tree(config, &file, settings, count, err);
}

void config_print(const struct config *config, struct text *out)
{
	field_print(&config_table, config, false, out);
}

int config_print_reference(const char *model, struct text *out, struct error *err)
{
	const struct field *selector = field_find(&config_table, config_table.selector);
	struct text names = {0};
	struct config config = {0};

	while (selector->choices[config.model] && strcmp(selector->choices[config.model], model) != 0)
		config.model++;
	if (!selector->choices[config.model]) {
		for (int i = 0; selector->choices[i]; i++)
			text_addf(&names, "%s%s", i ? ", " : "", selector->choices[i]);
		(void)error_set(
			err, EX_USAGE, "no model is called '%s'; there are %s", model, text_string(&names));
		text_clean(&names);
		return -1;
	}
	text_addf(out,
		"# Every key of a config of the %s model, with its default.\n"
		"# Generated by `talus check --reference=%s`.\n"
		"# Quantities carry units, a bare number is SI, an angle must say deg or rad.\n",
		model, model);
	field_print_reference(&config_table, &config, out);
	return 0;
}

void config_print_leading(const struct config *config, struct text *out)
{
	for (size_t i = 0; i < config_table.count; i++) {
		const struct field *field = &config_table.fields[i];

		if (!(field->flags & FIELD_LEADING) || !field_applies(&config_table, field, config))
			continue;
		text_addf(out, "  %-23s", field->name);
		field_print_value(field, config, out);
		text_add(out, "\n");
	}
}

int config_hash(const struct config *config, char hash[CONFIG_HASH_SIZE], struct error *err)
{
	struct text text = {0};

	field_print(&config_table, config, true, &text);
	if (text.failed) {
		(void)error_memory(err, text.capacity);
		text_clean(&text);
		return -1;
	}
	(void)snprintf(
		hash, CONFIG_HASH_SIZE, "%016llx", (unsigned long long)XXH3_64bits(text.data, text.length));
	text_clean(&text);
	return 0;
}

bool config_is_key(const char *key)
{
	const struct field *field = field_find(&config_table, key);

	return field && field->kind != FIELD_GROUP;
}

bool config_is_whole(const char *key)
{
	const struct field *field = field_find(&config_table, key);

	return field && field->kind == FIELD_INTEGER;
}

void config_differences(const struct config *a, const struct config *b, struct text *out)
{
	field_differences(&config_table, a, b, out);
}

/* The row of a key with a value, NULL with the error set. */
static const struct field *find_key(const char *key, struct error *err)
{
	const struct field *field = field_find(&config_table, key);

	if (!field)
		(void)field_unknown(&config_table, key, err);
	else if (field->kind == FIELD_GROUP)
		(void)error_set(err, EX_DATAERR, "'%s' is a group of keys, not a key with a value", key);
	return field && field->kind != FIELD_GROUP ? field : NULL;
}

int config_check_key(const char *key, struct error *err)
{
	return find_key(key, err) ? 0 : -1;
}

int config_value(const struct config *config, const char *key, struct text *out, struct error *err)
{
	const struct field *field = find_key(key, err);

	if (!field)
		return -1;
	if (!field_applies(&config_table, field, config))
		return field_inapplicable(&config_table, field, config, err);
	field_print_value(field, config, out);
	return out->failed ? error_memory(err, out->capacity) : 0;
}
