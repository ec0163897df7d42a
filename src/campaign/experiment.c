#include "talus/experiment.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "campaign/expand.h"
#include "campaign/experiment_observations.h"
#include "campaign/experiment_plots.h"
#include "campaign/range.h"
#include "campaign/reader.h"
#include "campaign/sample.h"
#include "campaign/setting.h"
#include "campaign/slurm.h"

/* What the entries of an experiment file fill. */
struct form {
	struct experiment *experiment;
	const struct node *base, *runs;
};

static int read_title(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &((struct form *)target)->experiment->title);
}

static int read_source(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &((struct form *)target)->experiment->source);
}

static int read_base(const struct reader *reader, const struct node *node, void *target)
{
	const char *path;

	((struct form *)target)->base = node;
	return reader_text(reader, node, &path);
}

static int read_set(const struct reader *reader, const struct node *node, void *target)
{
	return reader_settings(reader, node, &((struct form *)target)->experiment->set);
}

static int read_runs(const struct reader *reader, const struct node *node, void *target)
{
	bool blank = node->kind == NODE_SCALAR && !node->text[0] && !node->quoted;

	if (!blank && node->kind != NODE_SEQUENCE)
		return reader_fail(reader, node, "a list of mappings is wanted here");
	((struct form *)target)->runs = node;
	return 0;
}

static int read_repeat(const struct reader *reader, const struct node *node, void *target)
{
	return reader_integer(reader, node, 1, 1000, &((struct form *)target)->experiment->repeat);
}

static int read_timing(const struct reader *reader, const struct node *node, void *target)
{
	return reader_bool(reader, node, &((struct form *)target)->experiment->timing);
}

static int read_table_name(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment_table *table = target;

	table->name = (struct term){NULL, node->line, node->column};
	return reader_text(reader, node, &table->name.text);
}

static int read_table_title(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &((struct experiment_table *)target)->title);
}

static int read_rows(const struct reader *reader, const struct node *node, void *target)
{
	return reader_terms(reader, node, &((struct experiment_table *)target)->rows);
}

static int read_columns(const struct reader *reader, const struct node *node, void *target)
{
	return reader_terms(reader, node, &((struct experiment_table *)target)->columns);
}

static int read_metric(const struct reader *reader, const struct node *node, void *target)
{
	return reader_terms(reader, node, &((struct experiment_table *)target)->metrics);
}

static int read_at(const struct reader *reader, const struct node *node, void *target)
{
	return reader_terms(reader, node, &((struct experiment_table *)target)->at);
}

static int read_at_x(const struct reader *reader, const struct node *node, void *target)
{
	return reader_terms(reader, node, &((struct experiment_table *)target)->at_x);
}

static int read_baseline(const struct reader *reader, const struct node *node, void *target)
{
	return reader_settings(reader, node, &((struct experiment_table *)target)->baseline);
}

static int read_reference(const struct reader *reader, const struct node *node, void *target)
{
	return reader_settings(reader, node, &((struct experiment_table *)target)->reference);
}

static int read_dimensionless(const struct reader *reader, const struct node *node, void *target)
{
	return reader_bool(reader, node, &((struct experiment_table *)target)->dimensionless);
}

static int read_only(const struct reader *reader, const struct node *node, void *target)
{
	return reader_settings(reader, node, &((struct experiment_table *)target)->only);
}

static const struct reader_key table_keys[] = {
	{"name", read_table_name, "what `--table` and `published` call it; required"},
	{"title", read_table_title, "above the table (default: that of the experiment)"},
	{"rows", read_rows, "a config key, or a list of them, whose values make the rows; required"},
	{"columns", read_columns, "the same for the columns (default: none)"},
	{"metric", read_metric, "what the cells show, or a list of that: see the metrics; required"},
	{"baseline", read_baseline,
		"config keys and values that make of a run's config that of the run it is timed against"},
	{"reference", read_reference,
		"config keys and values that make of a run's config that of the run taken as exact"},
	{"at", read_at, "profile times of the metrics that are taken at one (default: the end)"},
	{"at_x", read_at_x, "positions of the metrics that are taken at one; the nearest cell"},
	{"only", read_only,
		"config keys and values: runs without them are left out (default: all runs)"},
	{"dimensionless", read_dimensionless,
		"true: lengths, times and velocities divided as a plot does (default: false)"},
};

static int read_table(
	const struct reader *reader, const struct node *node, struct experiment_table *table)
{
	table->title = "";
	TRY(reader_keys(reader, node, table_keys, sizeof table_keys / sizeof *table_keys, table));
	if (!table->name.text)
		return reader_fail(reader, node, "this table lacks its 'name'");
	if (!table->rows.count)
		return reader_fail(reader, node, "table '%s' lacks its 'rows'", table->name.text);
	if (!table->metrics.count)
		return reader_fail(reader, node, "table '%s' lacks its 'metric'", table->name.text);
	return 0;
}

static int read_tables(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment *experiment = ((struct form *)target)->experiment;

	if (node->kind != NODE_SEQUENCE)
		return reader_fail(reader, node, "a list of tables is wanted here");
	experiment->tables = calloc(node->count ? node->count : 1, sizeof *experiment->tables);
	if (!experiment->tables)
		return error_memory(reader->err, node->count * sizeof *experiment->tables);
	for (size_t i = 0; i < node->count; i++) {
		struct experiment_table *table = &experiment->tables[i];

		experiment->table_count = i + 1;
		TRY(read_table(reader, &node->items[i], table));
		for (size_t k = 0; k < i; k++)
			if (!strcmp(experiment->tables[k].name.text, table->name.text))
				return reader_fail(
					reader, &node->items[i], "table '%s' stands here twice", table->name.text);
	}
	return 0;
}

static int read_observations(const struct reader *reader, const struct node *node, void *target)
{
	return experiment_observations_read(reader, node, ((struct form *)target)->experiment);
}

static int read_plots(const struct reader *reader, const struct node *node, void *target)
{
	return experiment_plots_read(reader, node, ((struct form *)target)->experiment);
}

static int read_published(const struct reader *reader, const struct node *node, void *target)
{
	(void)target; /* handed to the tables when all of them are known */
	if (node->kind != NODE_MAPPING)
		return reader_fail(reader, node, "a mapping of table names is wanted here");
	return 0;
}

static int share_published(const struct reader *reader, struct experiment *experiment)
{
	const struct node *published = node_find(experiment->root, "published");

	for (size_t i = 0; published && i < published->count; i++) {
		const struct node *item = &published->items[i];
		size_t k = 0;

		while (
			k < experiment->table_count && strcmp(experiment->tables[k].name.text, item->key) != 0)
			k++;
		if (k == experiment->table_count)
			return error_at(reader->err, EX_DATAERR, reader->path, item->key_line, item->key_column,
				"published: no table of this experiment is named '%s'", item->key);
		experiment->tables[k].published = item;
	}
	return 0;
}

static int read_slurm(const struct reader *reader, const struct node *node, void *target)
{
	return slurm_read(reader, node, &((struct form *)target)->experiment->slurm);
}

static const struct reader_key form_keys[] = {
	{"title", read_title, "one line, above the tables"},
	{"source", read_source, "what is reproduced, such as P1 Table 4"},
	{"base", read_base, "path of the config that all runs share, relative to this file; required"},
	{"set", read_set, "config keys and values for all runs, before those of `runs`"},
	{"runs", read_runs,
		"a list of entries, each the product of its axes; "
		"a run that two entries ask for is one (default: one run of the base)"},
	{"repeat", read_repeat, "how often each run is run, 1 to 1000 (default: 1)"},
	{"timing", read_timing,
		"true: one run at a time and in the order of the file, for CPU times (default: false)"},
	{"tables", read_tables, "a list of tables, see below"},
	{"plots", read_plots, "a list of plots, see below"},
	{"observations", read_observations, "a list of files of measured values, see below"},
	{"published", read_published,
		"per name of a table, its published values: a list of rows, null where blank"},
	{"slurm", read_slurm, "how a cluster runs the runs, see below and docs/slurm.md"},
};

void experiment_reference(struct text *out)
{
	static const struct reader_key axes[] = {
		{"KEY", NULL,
			"a config key with a value, a list of values, or a range; a value that is a list stands in a list"},
		{"zip", NULL, "config keys whose lists or ranges, of one length, go in step: one axis"},
		{"sample", NULL, "a design that draws the ranges without `steps` of this entry: one axis"},
	};

	reader_reference(out, "An experiment", form_keys, sizeof form_keys / sizeof *form_keys);
	reader_reference(out, "An entry of runs", axes, sizeof axes / sizeof *axes);
	reader_reference(out, "A range", range_keys, RANGE_KEYS);
	reader_reference(out, "A sample", sample_keys, SAMPLE_KEYS);
	reader_reference(out, "A table", table_keys, sizeof table_keys / sizeof *table_keys);
	experiment_plots_reference(out);
	experiment_observations_reference(out);
	reader_reference(out, "The section slurm", slurm_keys, SLURM_KEYS);
}

static int read_form(const struct reader *reader, struct form *form)
{
	struct experiment *experiment = form->experiment;
	const struct node *root = experiment->root;

	if (root->kind == NODE_MAPPING && root->count && !node_find(root, "base") &&
		config_is_key(root->items[0].key)) {
		reader_fail(reader, root, "this is a config, not an experiment; `talus run %s` runs it",
			reader->path);
		return -1;
	}
	TRY(reader_keys(
		reader, experiment->root, form_keys, sizeof form_keys / sizeof *form_keys, form));
	if (!form->base) {
		reader_fail(reader, experiment->root, "the experiment lacks its 'base' config");
		return -1;
	}
	return share_published(reader, experiment);
}

/* The base config; its path is relative to the experiment's. One that cannot be read is told with the place
 * where the experiment names it. */
static int load_base(
	const struct reader *reader, struct experiment *experiment, const struct node *base)
{
	struct error why = {0};

	experiment->base = reader_file(reader, base->text);
	if (!experiment->base)
		return error_memory(reader->err, strlen(experiment->path) + strlen(base->text));
	experiment->base_root = calloc(1, sizeof *experiment->base_root);
	if (!experiment->base_root)
		return error_memory(reader->err, sizeof *experiment->base_root);
	if (!yaml_load(experiment->base_root, experiment->base, &why))
		return 0;
	if (why.code == EX_DATAERR && !why.line)
		return reader_fail(reader, base, "%s %s", experiment->base, why.text);
	*reader->err = why;
	return -1;
}

static int keep_overrides(
	struct experiment *experiment, const char *const *overrides, int count, struct error *err)
{
	for (int i = 0; i < count; i++) {
		const char *equals = strchr(overrides[i], '=');
		struct node value = {.kind = NODE_SCALAR};
		char *key;
		int result;

		if (!equals || equals == overrides[i])
			return error_set(err, EX_DATAERR, "--set %s: key=value is wanted here", overrides[i]);
		key = strndup(overrides[i], (size_t)(equals - overrides[i]));
		value.text = strdup(equals + 1);
		result = key && value.text ? setting_list_add(&experiment->overrides, key, &value, err)
								   : error_memory(err, strlen(overrides[i]));
		free(key);
		free(value.text);
		TRY(result);
	}
	return 0;
}

/* results/<stem of the file> unless the caller names a folder. No name begins with '-', which other
 * programs would take for an option. */
static int name_folder(struct experiment *experiment, const char *folder, struct error *err)
{
	struct text name = {0};
	bool right = true;

	if (folder)
		text_addf(&name, "%s%s", *folder == '-' ? "./" : "", folder);
	else {
		text_add(&name, "results/");
		right = file_stem(experiment->path, &name);
	}
	experiment->folder = name.data;
	if (name.failed)
		return error_memory(err, name.length);
	return right ? 0
				 : error_at(err, EX_DATAERR, experiment->path, 0, 0,
					   "its name is none for a folder of results; name one with -o");
}

int experiment_read(struct experiment *experiment, const char *path, const char *folder,
	const char *const *overrides, int count, struct error *err)
{
	struct reader reader = {path, err};
	struct form form = {.experiment = experiment};

	*experiment = (struct experiment){
		.title = "", .source = "", .repeat = 1, .slurm = {.partition = "", .grace = SLURM_GRACE}};
	experiment->path = strdup(path);
	experiment->root = calloc(1, sizeof *experiment->root);
	if (!experiment->path || !experiment->root)
		return error_memory(err, strlen(path) + sizeof *experiment->root);
	TRY(name_folder(experiment, folder, err));
	TRY(yaml_load(experiment->root, path, err));
	TRY(read_form(&reader, &form));
	TRY(load_base(&reader, experiment, form.base));
	TRY(keep_overrides(experiment, overrides, count, err));
	return experiment_expand(experiment, form.runs, err);
}

static void table_clean(struct experiment_table *table)
{
	free(table->rows.items);
	free(table->columns.items);
	free(table->metrics.items);
	free(table->at.items);
	free(table->at_x.items);
	setting_list_clean(&table->baseline);
	setting_list_clean(&table->reference);
	setting_list_clean(&table->only);
}

void experiment_clean(struct experiment *experiment)
{
	for (size_t i = 0; i < experiment->run_count; i++) {
		free(experiment->runs[i].id);
		free(experiment->runs[i].folder);
		setting_list_clean(&experiment->runs[i].settings);
	}
	for (size_t i = 0; i < experiment->table_count; i++)
		table_clean(&experiment->tables[i]);
	free(experiment->runs);
	free(experiment->tables);
	experiment_plots_clean(experiment);
	experiment_observations_clean(experiment);
	free(experiment->path);
	free(experiment->folder);
	free(experiment->base);
	if (experiment->base_root)
		node_clean(experiment->base_root);
	free(experiment->base_root);
	free(experiment->keys);
	setting_list_clean(&experiment->slurm.directives);
	setting_list_clean(&experiment->set);
	setting_list_clean(&experiment->overrides);
	if (experiment->root)
		node_clean(experiment->root);
	free(experiment->root);
	*experiment = (struct experiment){0};
}
