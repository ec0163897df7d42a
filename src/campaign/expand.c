#include "campaign/expand.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/reader.h"
#include "campaign/setting.h"
#include "talus/text.h"

/* The values of one key in an entry of `runs`. */
struct axis {
	const char *key;
	const struct node *values; /* [count] */
	size_t count, chosen;
};

enum { LAYERS = 4 }; /* of settings: of the file, of the run, of the command line, of the caller */

/* "key=value" texts for config_parse, layer by layer. */
struct overlay {
	const struct setting_list *layers[LAYERS];
	char **texts; /* [count] */
	int count;
};

static void overlay_clean(struct overlay *overlay)
{
	for (int i = 0; overlay->texts && i < overlay->count; i++)
		free(overlay->texts[i]);
	free(overlay->texts);
}

static int overlay_write(struct overlay *overlay, struct error *err)
{
	size_t total = 0;

	for (int l = 0; l < LAYERS; l++)
		total += overlay->layers[l]->count;
	overlay->texts = calloc(total + 1, sizeof *overlay->texts);
	if (!overlay->texts)
		return error_memory(err, (total + 1) * sizeof *overlay->texts);
	for (int l = 0; l < LAYERS; l++)
		for (size_t i = 0; i < overlay->layers[l]->count; i++) {
			const struct setting *setting = &overlay->layers[l]->items[i];
			char *text;

			if (asprintf(&text, "%s=%s", setting->key, setting->value) < 0)
				return error_memory(err, strlen(setting->key) + strlen(setting->value));
			overlay->texts[overlay->count++] = text;
		}
	return 0;
}

/* A config error that cites `--set key=value` gets the place where the experiment says so: the last
 * setting of that text is the one in force. Those of the command line stay as they are. */
static void cite_place(
	const struct overlay *overlay, const struct experiment *experiment, struct error *err)
{
	static const char option[] = "--set ";
	char shown[256 - sizeof option + 1]; /* as much as config.c shows */
	int text = overlay->count;

	if (strncmp(err->file, option, strlen(option)) != 0)
		return;
	for (int l = LAYERS; l-- > 0;)
		for (size_t i = overlay->layers[l]->count; i-- > 0;) {
			const struct setting *setting = &overlay->layers[l]->items[i];

			(void)text_excerpt(overlay->texts[--text], shown, sizeof shown);
			if (!setting->line || strcmp(err->file + strlen(option), shown) != 0)
				continue;
			(void)snprintf(err->file, sizeof err->file, "%s", experiment->path);
			err->line = setting->line;
			err->column = setting->column;
			return;
		}
}

static int parse(const struct experiment *experiment, const struct setting_list *settings,
	const struct setting_list *more, struct config *config, struct error *err)
{
	struct overlay overlay = {.layers = {&experiment->set, settings, &experiment->overrides, more}};
	int result = overlay_write(&overlay, err);

	if (!result)
		result = config_parse(config, experiment->base_text, experiment->base_length,
			experiment->base, (const char *const *)overlay.texts, overlay.count, err);
	if (result && overlay.texts && err->code == EX_DATAERR)
		cite_place(&overlay, experiment, err);
	overlay_clean(&overlay);
	return result;
}

int experiment_vary(const struct experiment *experiment, const struct experiment_run *run,
	const struct setting_list *more, struct config *config, struct error *err)
{
	return parse(experiment, &run->settings, more, config, err);
}

int experiment_has(const struct experiment *experiment, const struct experiment_run *run,
	const struct setting_list *values, bool *has, struct error *err)
{
	struct text mine = {0}, other = {0};
	struct error refusal = {0};
	struct config config;
	int result = 0;

	*has = true;
	if (!values->count)
		return 0;
	if (experiment_vary(experiment, run, values, &config, &refusal)) {
		*has = false;
		if (refusal.code != EX_DATAERR)
			*err = refusal;
		return refusal.code == EX_DATAERR ? 0 : -1;
	}
	for (size_t i = 0; !result && *has && i < values->count; i++) {
		const char *key = values->items[i].key;

		mine.length = other.length = 0;
		result =
			config_value(&run->config, key, &mine, err) || config_value(&config, key, &other, err);
		*has = !result && !strcmp(text_string(&mine), text_string(&other));
	}
	text_clean(&mine);
	text_clean(&other);
	return result ? -1 : 0;
}

static size_t find_hash(const struct experiment *experiment, const char *hash, int repeat)
{
	size_t i = 0;

	while (i < experiment->run_count &&
		   (strcmp(experiment->runs[i].hash, hash) != 0 || experiment->runs[i].repeat != repeat))
		i++;
	return i;
}

int experiment_find(const struct experiment *experiment, const struct config *config, int repeat,
	size_t *index, struct error *err)
{
	char hash[CONFIG_HASH_SIZE];

	TRY(config_hash(config, hash, err));
	*index = find_hash(experiment, hash, repeat);
	return 0;
}

static int too_many(const struct reader *reader, const struct node *node)
{
	return reader_fail(reader, node, "an experiment has at most %d runs", EXPERIMENT_RUNS_MAX);
}

/* Append a run with these settings, which it takes over; a run that is there already is dropped. */
static int add_run(
	const struct reader *reader, struct experiment *experiment, struct setting_list *settings)
{
	struct experiment_run run = {.settings = *settings, .repeat = 1};
	const struct setting_list none = {0};
	struct experiment_run *runs;

	*settings = (struct setting_list){0};
	if (parse(experiment, &run.settings, &none, &run.config, reader->err) ||
		config_hash(&run.config, run.hash, reader->err))
		goto refused;
	if (find_hash(experiment, run.hash, 1) < experiment->run_count) {
		setting_list_clean(&run.settings);
		return 0;
	}
	runs = realloc(experiment->runs, (experiment->run_count + 1) * sizeof *runs);
	if (!runs) {
		error_memory(reader->err, (experiment->run_count + 1) * sizeof *runs);
		goto refused;
	}
	experiment->runs = runs;
	runs[experiment->run_count++] = run;
	return 0;
refused:
	setting_list_clean(&run.settings);
	return -1;
}

/* The next choice of values, the last axis fastest; false after the last. */
static bool advance(struct axis *axes, size_t count)
{
	while (count-- > 0) {
		if (++axes[count].chosen < axes[count].count)
			return true;
		axes[count].chosen = 0;
	}
	return false;
}

static int add_product(const struct reader *reader, struct experiment *experiment,
	const struct node *entry, struct axis *axes, size_t count)
{
	do {
		struct setting_list settings = {0};

		if (experiment->run_count >= EXPERIMENT_RUNS_MAX)
			return too_many(reader, entry);
		for (size_t i = 0; i < count; i++)
			if (setting_list_add(
					&settings, axes[i].key, &axes[i].values[axes[i].chosen], reader->err)) {
				setting_list_clean(&settings);
				return -1;
			}
		TRY(add_run(reader, experiment, &settings));
	} while (advance(axes, count));
	return 0;
}

static int add_entry(
	const struct reader *reader, struct experiment *experiment, const struct node *entry)
{
	struct leaf_list leaves = {0};
	struct axis *axes = NULL;
	double product = 1; /* no overflow */
	int result = -1;

	if (reader_leaves(reader, entry, &leaves))
		goto done;
	axes = calloc(leaves.count + 1, sizeof *axes);
	if (!axes) {
		error_memory(reader->err, (leaves.count + 1) * sizeof *axes);
		goto done;
	}
	for (size_t i = 0; i < leaves.count; i++) {
		const struct node *node = leaves.items[i].node;
		bool list = node->kind == NODE_SEQUENCE;

		axes[i] = (struct axis){
			leaves.items[i].key, list ? node->items : node, list ? node->count : 1, 0};
		if (!axes[i].count) {
			reader_fail(reader, node, "an empty list asks for no run at all");
			goto done;
		}
		product *= (double)axes[i].count;
	}
	result = product > EXPERIMENT_RUNS_MAX
				 ? too_many(reader, entry)
				 : add_product(reader, experiment, entry, axes, leaves.count);
done:
	free(axes);
	reader_leaves_clean(&leaves);
	return result;
}

static int copy_settings(
	struct setting_list *out, const struct setting_list *settings, struct error *err)
{
	for (size_t i = 0; i < settings->count; i++) {
		const struct setting *setting = &settings->items[i];
		const struct node value = {.kind = NODE_SCALAR,
			.text = setting->value,
			.line = setting->line,
			.column = setting->column};

		TRY(setting_list_add(out, setting->key, &value, err));
	}
	return 0;
}

/* Repeats come after one another, so that a machine that changes in between changes all cells. */
static int add_repeats(const struct reader *reader, struct experiment *experiment)
{
	size_t once = experiment->run_count, all = once * (size_t)experiment->repeat;
	struct experiment_run *runs;

	if (all > EXPERIMENT_RUNS_MAX)
		return too_many(reader, node_find(experiment->root, "repeat"));
	runs = realloc(experiment->runs, all * sizeof *runs);
	if (!runs)
		return error_memory(reader->err, all * sizeof *runs);
	experiment->runs = runs;
	for (size_t i = once; i < all; i++) {
		runs[i] = runs[i - once];
		runs[i].settings = (struct setting_list){0};
		runs[i].repeat++;
		experiment->run_count = i + 1;
		TRY(copy_settings(&runs[i].settings, &runs[i - once].settings, reader->err));
	}
	return 0;
}

int experiment_expand(struct experiment *experiment, const struct node *runs, struct error *err)
{
	const struct reader reader = {experiment->path, err};
	struct setting_list none = {0};

	for (size_t i = 0; runs && i < runs->count; i++)
		TRY(add_entry(&reader, experiment, &runs->items[i]));
	if (!experiment->run_count)
		TRY(add_run(&reader, experiment, &none));
	TRY(add_repeats(&reader, experiment));
	return experiment_name_runs(experiment, err);
}
