#include "campaign/expand.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/axis.h"
#include "campaign/reader.h"
#include "campaign/run_key.h"
#include "campaign/setting.h"
#include "talus/text.h"

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
		result = config_from_node(config, experiment->base_root, experiment->base,
			(const char *const *)overlay.texts, overlay.count, err);
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
		if (!result && (mine.failed || other.failed))
			result = error_memory(err, mine.length + other.length);
		*has = !result && !strcmp(text_string(&mine), text_string(&other));
	}
	text_clean(&mine);
	text_clean(&other);
	return result ? -1 : 0;
}

int experiment_find(const struct experiment *experiment, const struct config *config, int repeat,
	size_t *index, struct error *err)
{
	char hash[CONFIG_HASH_SIZE];

	TRY(config_hash(config, hash, err));
	*index = run_key_find(experiment, hash, repeat);
	return 0;
}

static int too_many(const struct reader *reader, const struct node *node)
{
	return reader_fail(reader, node, "an experiment has at most %d runs", EXPERIMENT_RUNS_MAX);
}

/* The hash of a run, on the way to finding those that are there already. */
struct seen {
	uint64_t *hashes; /* [capacity], a power of two; 0: free */
	size_t count, capacity;
};

static int seen_grow(struct seen *seen, struct error *err)
{
	struct seen larger = {.capacity = seen->capacity ? 2 * seen->capacity : 64};

	larger.hashes = calloc(larger.capacity, sizeof *larger.hashes);
	if (!larger.hashes) {
		error_memory(err, larger.capacity * sizeof *larger.hashes);
		return -1;
	}
	for (size_t i = 0; i < seen->capacity; i++) {
		size_t at = seen->hashes[i] & (larger.capacity - 1);

		while (seen->hashes[i] && larger.hashes[at])
			at = (at + 1) & (larger.capacity - 1);
		if (seen->hashes[i])
			larger.hashes[at] = seen->hashes[i];
	}
	larger.count = seen->count;
	free(seen->hashes);
	*seen = larger;
	return 0;
}

/* Note a hash; `*again`: it was noted before. */
static int seen_add(struct seen *seen, const char *hash, bool *again, struct error *err)
{
	uint64_t value = strtoull(hash, NULL, 16) | 1; /* 0 means free; nobody misses a bit of 64 */
	size_t at;

	if (!seen->hashes || 2 * seen->count >= seen->capacity)
		TRY(seen_grow(seen, err));
	at = value & (seen->capacity - 1);
	while (seen->hashes[at] && seen->hashes[at] != value)
		at = (at + 1) & (seen->capacity - 1);
	*again = seen->hashes[at] == value;
	seen->count += !*again;
	seen->hashes[at] = value;
	return 0;
}

struct expansion {
	const struct reader *reader;
	struct experiment *experiment;
	struct seen seen;
	size_t capacity; /* of experiment->runs */
};

/* Append this run, whose settings it takes over; one that is there already is dropped. */
static int add_run(struct expansion *expansion, struct experiment_run *run)
{
	struct experiment *experiment = expansion->experiment;
	struct error *err = expansion->reader->err;
	const struct setting_list none = {0};
	bool again = false;

	if (parse(experiment, &run->settings, &none, &run->config, err) ||
		config_hash(&run->config, run->hash, err) ||
		seen_add(&expansion->seen, run->hash, &again, err))
		goto refused;
	if (again) {
		setting_list_clean(&run->settings);
		return 0;
	}
	if (experiment->run_count == expansion->capacity) {
		size_t capacity = expansion->capacity ? 2 * expansion->capacity : 16;
		struct experiment_run *runs = realloc(experiment->runs, capacity * sizeof *runs);

		if (!runs) {
			error_memory(err, capacity * sizeof *runs);
			goto refused;
		}
		experiment->runs = runs;
		expansion->capacity = capacity;
	}
	experiment->runs[experiment->run_count++] = *run;
	return 0;
refused:
	setting_list_clean(&run->settings);
	return -1;
}

/* The next choice of values, the last axis fastest; false after the last. */
static bool advance(struct axis_list *axes)
{
	for (size_t i = axes->count; i-- > 0;) {
		struct axis *axis = &axes->items[i];

		if (++axis->chosen < axis->count)
			return true;
		axis->chosen = 0;
	}
	return false;
}

static int choose(const struct axis_list *axes, struct experiment_run *run, struct error *err)
{
	for (size_t i = 0; i < axes->count; i++) {
		const struct axis *axis = &axes->items[i];
		const struct node *values = axis->values + axis->chosen * axis->width;

		if (axis->sampled)
			run->point = (int)axis->chosen + 1;
		for (size_t k = 0; k < axis->width; k++)
			TRY(setting_list_add(&run->settings, axis->leaves[k].key, &values[k], err));
	}
	return 0;
}

static int add_entry(struct expansion *expansion, const struct node *entry)
{
	const struct reader *reader = expansion->reader;
	struct axis_list axes;
	double product = 1; /* no overflow */
	int result = axis_list_read(reader, entry, &axes);

	for (size_t i = 0; i < axes.count; i++)
		product *= (double)axes.items[i].count;
	if (!result && product > EXPERIMENT_RUNS_MAX)
		result = too_many(reader, entry);
	while (!result) {
		struct experiment_run run = {.repeat = 1};

		if (expansion->experiment->run_count >= EXPERIMENT_RUNS_MAX)
			result = too_many(reader, entry);
		else if (choose(&axes, &run, reader->err) == 0)
			result = add_run(expansion, &run);
		else
			result = -1;
		if (result)
			setting_list_clean(&run.settings);
		if (!advance(&axes))
			break;
	}
	axis_list_clean(&axes);
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
	struct expansion expansion = {&reader, experiment, {0}, 0};
	struct experiment_run base = {.repeat = 1};
	int result = 0;

	for (size_t i = 0; !result && runs && i < runs->count; i++)
		result = add_entry(&expansion, &runs->items[i]);
	if (!result && !experiment->run_count)
		result = add_run(&expansion, &base);
	free(expansion.seen.hashes);
	TRY(result);
	TRY(add_repeats(&reader, experiment));
	return experiment_name_runs(experiment, err);
}
