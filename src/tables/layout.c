#include "tables/layout.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "talus/config.h"

int layout_fail(const struct layout *layout, const struct term *term, struct error *err,
	const char *format, ...)
{
	char message[1024];
	va_list args;

	va_start(args, format);
	(void)vsnprintf(message, sizeof message, format, args);
	va_end(args);
	return error_at(err, EX_DATAERR, layout->experiment->path, term->line, term->column, "%s: %s",
		layout->what, message);
}

int layout_place_error(const struct layout *layout, const struct term *term, struct error *err)
{
	if (err->code == EX_DATAERR && !err->file[0])
		(void)error_context(err, "%s", layout->what);
	return error_place(err, layout->experiment->path, term->line, term->column);
}

/* The value of a key: its author's text where the run has one that is in force. */
static int part_text(
	const struct layout *layout, const struct experiment_run *run, const char *key, char **out)
{
	const struct setting_list *overrides = &layout->experiment->overrides;
	const char *text = NULL;

	for (size_t i = 0; i < run->settings.count; i++)
		if (!strcmp(run->settings.items[i].key, key))
			text = run->settings.items[i].value;
	for (size_t i = 0; i < overrides->count; i++)
		if (!strcmp(overrides->items[i].key, key))
			text = NULL;
	*out = text ? strdup(text) : NULL;
	return text && !*out ? -1 : 0;
}

static void label_clean(struct label *label, size_t keys)
{
	for (size_t i = 0; label->parts && i < keys; i++)
		free(label->parts[i]);
	free(label->parts);
	free(label->identity);
}

static int label_make(const struct layout *layout, const struct experiment_run *run,
	const struct term_list *keys, struct label *label, struct error *err)
{
	struct text identity = {0};

	label->parts = calloc(keys->count + 1, sizeof *label->parts);
	if (!label->parts) {
		(void)error_memory(err, (keys->count + 1) * sizeof *label->parts);
		return -1;
	}
	text_add(&identity, "");
	for (size_t i = 0; i < keys->count; i++) {
		struct text value = {0};

		if (config_value(&run->config, keys->items[i].text, &value, err)) {
			text_clean(&value);
			text_clean(&identity);
			(void)layout_place_error(layout, &keys->items[i], err);
			return -1;
		}
		text_addf(&identity, "%s\n", text_string(&value));
		if (part_text(layout, run, keys->items[i].text, &label->parts[i]))
			value.failed = true;
		if (!label->parts[i])
			label->parts[i] = strdup(text_string(&value));
		identity.failed |= value.failed || !label->parts[i];
		text_clean(&value);
	}
	label->identity = identity.data;
	if (identity.data && !identity.failed)
		return 0;
	(void)error_memory(err, identity.length);
	return -1;
}

/* The index of the run's label, added when it is new. */
static int label_index(const struct layout *layout, const struct experiment_run *run,
	const struct term_list *keys, struct label_list *list, long *index, struct error *err)
{
	struct label label = {0}, *items;
	size_t i = 0;

	list->keys = keys->count;
	if (label_make(layout, run, keys, &label, err))
		goto refused;
	while (i < list->count && strcmp(list->items[i].identity, label.identity) != 0)
		i++;
	*index = (long)i;
	if (i < list->count) {
		label_clean(&label, keys->count);
		return 0;
	}
	items = realloc(list->items, (list->count + 1) * sizeof *items);
	if (!items) {
		error_memory(err, (list->count + 1) * sizeof *items);
		goto refused;
	}
	list->items = items;
	items[list->count++] = label;
	return 0;
refused:
	label_clean(&label, keys->count);
	return -1;
}

/* Nothing has the values of `only`: the reason is one that no run can have, or just that. */
static int fail_empty(const struct layout *layout, struct error *err)
{
	struct config config;

	for (size_t i = 0; i < layout->experiment->run_count; i++)
		TRY(experiment_vary(
			layout->experiment, &layout->experiment->runs[i], &layout->wanted->only, &config, err));
	return layout_fail(layout, &layout->wanted->name, err, "no run has the values of its 'only'");
}

static int place_runs(struct layout *layout, struct error *err)
{
	const struct experiment *experiment = layout->experiment;
	bool any = false;

	for (size_t i = 0; i < experiment->run_count; i++) {
		const struct experiment_run *run = &experiment->runs[i];
		struct place *place = &layout->places[i];
		bool wanted;

		*place = (struct place){.row = LAYOUT_NOWHERE, .column = LAYOUT_NOWHERE};
		TRY(experiment_has(experiment, run, &layout->wanted->only, &wanted, err));
		if (!wanted)
			continue;
		any = true;
		TRY(label_index(layout, run, &layout->wanted->rows, &layout->rows, &place->row, err));
		TRY(label_index(
			layout, run, &layout->wanted->columns, &layout->columns, &place->column, err));
	}
	return any ? 0 : fail_empty(layout, err);
}

/* Two different runs in one cell: the table lacks the key in which they differ. */
static int refuse_crowds(const struct layout *layout, struct error *err)
{
	const struct experiment_run *runs = layout->experiment->runs;
	size_t columns = layout->columns.count;
	long *first = malloc((layout->rows.count * columns + 1) * sizeof *first);
	int result = 0;

	if (!first)
		return error_memory(err, layout->rows.count * columns * sizeof *first);
	for (size_t i = 0; i < layout->rows.count * columns; i++)
		first[i] = LAYOUT_NOWHERE;
	for (size_t i = 0; !result && i < layout->experiment->run_count; i++) {
		const struct place *place = &layout->places[i];
		long *holder;

		if (place->row == LAYOUT_NOWHERE)
			continue;
		holder = &first[(size_t)place->row * columns + (size_t)place->column];
		if (*holder == LAYOUT_NOWHERE)
			*holder = (long)i;
		else if (strcmp(runs[*holder].hash, runs[i].hash) != 0)
			result = layout_fail(layout, &layout->wanted->name, err,
				"runs %s and %s fall into one %s or only must name what they differ in",
				runs[*holder].id, runs[i].id,
				layout->what[0] == 'p' ? "line; lines, split" : "cell; rows, columns");
	}
	free(first);
	return result;
}

static int find_partners(struct layout *layout, enum metric_partner kind, const char *noun,
	const struct setting_list *change, struct error *err)
{
	const struct experiment *experiment = layout->experiment;

	for (size_t i = 0; i < experiment->run_count; i++) {
		const struct experiment_run *run = &experiment->runs[i];
		struct config config;
		size_t *index = &layout->places[i].partner[kind];

		if (layout->places[i].row == LAYOUT_NOWHERE)
			continue;
		TRY(experiment_vary(experiment, run, change, &config, err));
		TRY(experiment_find(experiment, &config, run->repeat, index, err));
		if (*index == experiment->run_count)
			return layout_fail(layout, &layout->wanted->name, err,
				"the %s of run %s is not a run of this experiment", noun, run->id);
	}
	return 0;
}

/* The run of the row before, in the same column and repeat. */
static void find_previous(struct layout *layout)
{
	const struct experiment *experiment = layout->experiment;

	for (size_t i = 0; i < experiment->run_count; i++) {
		struct place *mine = &layout->places[i];

		mine->previous = LAYOUT_ALONE;
		for (size_t k = 0; mine->row > 0 && k < experiment->run_count; k++)
			if (layout->places[k].row == mine->row - 1 &&
				layout->places[k].column == mine->column &&
				experiment->runs[k].repeat == experiment->runs[i].repeat)
				mine->previous = k;
	}
}

bool layout_asks(const struct layout *layout, size_t run, const struct metric *metric)
{
	const struct place *place = &layout->places[run];
	size_t reference = place->partner[PARTNER_REFERENCE];

	if (!metric_is_order(metric))
		return true;
	return place->previous != LAYOUT_ALONE &&
		   (metric_partner(metric) != PARTNER_REFERENCE ||
			   (reference != run && reference != place->previous));
}

static int pair_runs(struct layout *layout, struct error *err)
{
	static const char *const nouns[] = {"", "baseline", "reference"};
	const struct setting_list *changes[] = {
		NULL, &layout->wanted->baseline, &layout->wanted->reference};
	bool needed[PARTNERS] = {false}, ordered = false;

	for (size_t i = 0; i < layout->measure_count; i++) {
		const struct metric *metric = layout->measures[i].metric;

		if (metric) {
			needed[metric_partner(metric)] = true;
			ordered |= metric_is_order(metric);
		}
	}
	if (ordered)
		find_previous(layout);
	for (int kind = PARTNER_BASELINE; kind <= PARTNER_REFERENCE; kind++) {
		if (!needed[kind])
			continue;
		if (!changes[kind]->count)
			return layout_fail(
				layout, &layout->wanted->name, err, "it lacks its '%s'", nouns[kind]);
		TRY(find_partners(layout, (enum metric_partner)kind, nouns[kind], changes[kind], err));
	}
	return 0;
}

int layout_observed(const struct layout *layout, const struct experiment_run *run, const char *name,
	bool over_x, const struct observed **out, struct error *err)
{
	const struct experiment *experiment = layout->experiment;

	*out = NULL;
	for (size_t i = 0; !*out && i < experiment->observation_count; i++) {
		bool has = observed_has(&layout->observed[i], name, over_x);

		if (has)
			TRY(experiment_has(experiment, run, &experiment->observations[i].only, &has, err));
		if (has)
			*out = &layout->observed[i];
	}
	return 0;
}

static int read_observations(struct layout *layout, struct error *err)
{
	const struct experiment *experiment = layout->experiment;

	layout->observed = calloc(experiment->observation_count + 1, sizeof *layout->observed);
	if (!layout->observed)
		return error_memory(err, (experiment->observation_count + 1) * sizeof *layout->observed);
	for (size_t i = 0; i < experiment->observation_count; i++)
		TRY(observed_read(&layout->observed[i], experiment->observations[i].path, err));
	return 0;
}

int layout_create(struct layout *layout, const struct experiment *experiment,
	const struct experiment_table *wanted, const char *noun, struct error *err)
{
	*layout = (struct layout){.experiment = experiment, .wanted = wanted};
	if (asprintf(&layout->what, "%s '%s'", noun, wanted->name.text) < 0) {
		layout->what = NULL;
		return error_memory(err, strlen(wanted->name.text));
	}
	layout->places = calloc(experiment->run_count, sizeof *layout->places);
	if (!layout->places)
		return error_memory(err, experiment->run_count * sizeof *layout->places);
	TRY(read_observations(layout, err));
	TRY(place_runs(layout, err));
	TRY(refuse_crowds(layout, err));
	TRY(layout_list_measures(layout, err));
	TRY(pair_runs(layout, err));
	return layout_read_published(layout, err);
}

static void label_list_clean(struct label_list *list)
{
	for (size_t i = 0; i < list->count; i++)
		label_clean(&list->items[i], list->keys);
	free(list->items);
}

void layout_clean(struct layout *layout)
{
	label_list_clean(&layout->rows);
	label_list_clean(&layout->columns);
	free(layout->measures);
	free(layout->places);
	free(layout->published);
	for (size_t i = 0; layout->observed && i < layout->experiment->observation_count; i++)
		observed_clean(&layout->observed[i]);
	free(layout->observed);
	free(layout->what);
	*layout = (struct layout){0};
}
