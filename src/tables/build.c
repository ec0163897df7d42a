/* One builder for every table: measure each run, gather the repeats of a cell, lay the cells out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tables/layout.h"
#include "tables/provenance.h"
#include "talus/run.h"
#include "talus/run_file.h"
#include "talus/tables.h"

struct builder {
	const struct experiment *experiment;
	const struct layout *layout;
	struct table *table;
	double *values; /* [runs][measures], NaN: missing */
	struct provenance provenance;
	/* the partner opened last: neighbouring runs share it as a rule */
	struct run_file *partner;
	size_t partner_index;
};

static void tell_missing(
	struct builder *builder, const struct experiment_run *run, const char *why, const char *reason)
{
	text_addf(&builder->table->missing, "table '%s': run %s: %s%s%s\n", builder->table->name,
		run->id, why, *reason ? ": " : "", reason);
}

/* Open a run's file if the run is complete; NULL if not, and `tell` says whether to say so. EX_SOFTWARE
 * out of memory, which says nothing about the run. */
static int open_run(struct builder *builder, const struct experiment_run *run, bool tell,
	struct run_file **out, struct error *fatal)
{
	struct run_report report;
	struct run_file *file = NULL;
	struct text warning = {0};
	struct error err = {0};

	run_report_read(run->folder, &report);
	if (report.unknown)
		return error_memory(fatal, sizeof report);
	if (report.state != RUN_STATE_COMPLETE) {
		if (tell)
			tell_missing(builder, run, run_state_name(report.state), report.reason);
		return 0;
	}
	if (run_file_open_newest(run->folder, &file, &warning, &err) && tell &&
		err.code != EX_SOFTWARE) {
		char message[sizeof err.text + sizeof err.file + 32];

		tell_missing(builder, run, "damaged", error_format(&err, message, sizeof message));
	}
	if (file && warning.length)
		text_addf(&builder->table->notes, "%s: %s\n", run->id, text_string(&warning));
	text_clean(&warning);
	*out = file;
	if (err.code != EX_SOFTWARE)
		return 0;
	*fatal = err;
	return -1;
}

static int open_partner(
	struct builder *builder, size_t index, struct run_file **out, struct error *fatal)
{
	if (!builder->partner || builder->partner_index != index) {
		run_file_close(builder->partner);
		builder->partner = NULL;
		builder->partner_index = index;
		TRY(open_run(builder, &builder->experiment->runs[index], false, &builder->partner, fatal));
	}
	*out = builder->partner;
	return 0;
}

static int measure(struct builder *builder, size_t index, struct run_file *file,
	const struct measure *measure, double *value, struct error *fatal)
{
	const struct experiment_run *run = &builder->experiment->runs[index];
	const struct metric *metric = measure->metric;
	struct sample sample = {file, &run->config, NULL, measure->at};
	struct error err = {0};

	if (isnan(sample.at))
		sample.at = run->config.time.end;
	if (metric->partner != PARTNER_NONE) {
		size_t partner = builder->layout->places[index].partner[metric->partner];

		if (partner == index)
			sample.partner = file;
		else
			TRY(open_partner(builder, partner, &sample.partner, fatal));
		if (!sample.partner) {
			tell_missing(builder, run, "lacks the run it is compared with",
				builder->experiment->runs[partner].id);
			return 0;
		}
	}
	if (metric->value(&sample, value, &err)) {
		*value = NAN;
		if (err.code == EX_SOFTWARE) {
			*fatal = err;
			return -1;
		}
		tell_missing(builder, run, metric->name, err.text);
	} else if (!isfinite(*value)) {
		*value = NAN;
		tell_missing(builder, run, metric->name, "is not a number");
	}
	return 0;
}

static int measure_runs(struct builder *builder, struct error *err)
{
	const struct layout *layout = builder->layout;
	size_t runs = builder->experiment->run_count, measures = layout->measure_count;

	builder->values = calloc(runs * measures, sizeof *builder->values);
	if (!builder->values)
		return error_memory(err, runs * measures * sizeof *builder->values);
	for (size_t i = 0; i < runs * measures; i++)
		builder->values[i] = NAN;
	for (size_t i = 0; i < runs; i++) {
		struct run_file *file = NULL;

		if (layout->places[i].row == LAYOUT_NOWHERE)
			continue;
		TRY(open_run(builder, &builder->experiment->runs[i], true, &file, err));
		if (!file)
			continue;
		for (size_t m = 0; m < measures && !err->code; m++)
			(void)measure(
				builder, i, file, &layout->measures[m], &builder->values[i * measures + m], err);
		provenance_add(&builder->provenance, file);
		run_file_close(file);
		if (err->code)
			return -1;
	}
	return 0;
}

static int compare(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

/* Median and half the range of the repeats in a cell; `samples` has room for all of them. */
static struct table_cell gather(
	const struct builder *builder, long row, long column, size_t m, double *samples)
{
	const struct layout *layout = builder->layout;
	size_t count = 0;
	bool asked = false;

	for (size_t i = 0; i < builder->experiment->run_count; i++) {
		double value = builder->values[i * layout->measure_count + m];

		if (layout->places[i].row != row || layout->places[i].column != column)
			continue;
		asked = true;
		if (!isnan(value))
			samples[count++] = value;
	}
	if (!count)
		return (struct table_cell){.kind = asked ? CELL_MISSING : CELL_BLANK};
	qsort(samples, count, sizeof *samples, compare);
	return (struct table_cell){.kind = CELL_NUMBER,
		.value = (samples[(count - 1) / 2] + samples[count / 2]) / 2,
		.spread = (samples[count - 1] - samples[0]) / 2};
}

static int add_head(
	struct table_column *column, const char *prefix, const char *text, struct error *err)
{
	struct text head = {0};

	if (column->head_count == TABLE_HEADS_MAX)
		return 0;
	text_addf(&head, "%s%s%s", prefix, *prefix ? " " : "", text);
	column->heads[column->head_count++] = head.data;
	return head.failed ? error_memory(err, strlen(prefix) + strlen(text)) : 0;
}

static const char *last_part(const char *key)
{
	const char *dot = strrchr(key, '.');

	return dot ? dot + 1 : key;
}

/* The heads of a column of numbers: its key values, the metric, the profile time, who says so. */
static int add_number_column(
	const struct builder *builder, size_t column, size_t m, const char *source, struct error *err)
{
	const struct layout *layout = builder->layout;
	const struct measure *measure = &layout->measures[m];
	struct table_column *out = &builder->table->columns[builder->table->column_count++];

	out->decimals = measure->metric->decimals;
	for (size_t k = 0; k < layout->columns.keys; k++)
		TRY(add_head(out, last_part(layout->wanted->columns.items[k].text),
			layout->columns.items[column].parts[k], err));
	TRY(add_head(out, "", measure->metric->header, err));
	if (measure->at_text)
		TRY(add_head(out, "at", measure->at_text, err));
	return *source ? add_head(out, "", source, err) : 0;
}

static struct table_cell *cell_at(const struct table *table, size_t row, size_t column)
{
	return &table->cells[row * table->column_count + column];
}

static int set_text(struct table_cell *cell, const char *text, struct error *err)
{
	*cell = (struct table_cell){.kind = CELL_TEXT, .text = strdup(text)};
	return cell->text ? 0 : error_memory(err, strlen(text));
}

static const char *published_value(const struct layout *layout, size_t row, size_t column, size_t m)
{
	size_t index = (row * layout->columns.count + column) * layout->measure_count + m;

	return layout->published ? layout->published[index] : NULL;
}

static bool any_published(const struct layout *layout, size_t column, size_t m)
{
	for (size_t row = 0; row < layout->rows.count; row++)
		if (published_value(layout, row, column, m))
			return true;
	return false;
}

static int add_columns(const struct builder *builder, struct error *err)
{
	const struct layout *layout = builder->layout;
	struct table *table = builder->table;
	char source[32]; /* "P1" of "P1 Table 4"; the title has all of it */
	size_t most = layout->rows.keys + 2 * layout->columns.count * layout->measure_count;

	(void)snprintf(source, sizeof source, "%.*s", (int)strcspn(builder->experiment->source, " "),
		builder->experiment->source);
	table->columns = calloc(most, sizeof *table->columns);
	if (!table->columns)
		return error_memory(err, most * sizeof *table->columns);
	for (size_t k = 0; k < layout->rows.keys; k++) {
		struct table_column *column = &table->columns[table->column_count++];

		column->label = true;
		TRY(add_head(column, "", last_part(layout->wanted->rows.items[k].text), err));
	}
	for (size_t c = 0; c < layout->columns.count; c++)
		for (size_t m = 0; m < layout->measure_count; m++) {
			bool published = any_published(layout, c, m);

			TRY(add_number_column(builder, c, m, published ? "ours" : "", err));
			if (published)
				TRY(add_number_column(builder, c, m, *source ? source : "published", err));
		}
	return 0;
}

/* Fill one row, in the order in which add_columns made the columns. */
static int fill_row(const struct builder *builder, size_t row, double *samples, struct error *err)
{
	const struct layout *layout = builder->layout;
	struct table *table = builder->table;
	size_t at = 0;

	for (size_t k = 0; k < layout->rows.keys; k++)
		TRY(set_text(cell_at(table, row, at++), layout->rows.items[row].parts[k], err));
	for (size_t c = 0; c < layout->columns.count; c++)
		for (size_t m = 0; m < layout->measure_count; m++) {
			const char *published = published_value(layout, row, c, m);
			struct table_cell cell = gather(builder, (long)row, (long)c, m, samples);

			/* a count that is the same in every repeat needs no spread */
			if (cell.kind == CELL_NUMBER && cell.spread > 0)
				table->columns[at].spread = true;
			*cell_at(table, row, at++) = cell;
			if (published)
				TRY(set_text(cell_at(table, row, at), published, err));
			at += any_published(layout, c, m);
		}
	return 0;
}

static int fill_cells(const struct builder *builder, struct error *err)
{
	struct table *table = builder->table;
	size_t rows = builder->layout->rows.count;
	double *samples = malloc(builder->experiment->run_count * sizeof *samples);
	int result = -1;

	table->cells = calloc(rows * table->column_count, sizeof *table->cells);
	if (!samples || !table->cells) {
		error_memory(err, rows * table->column_count * sizeof *table->cells);
		goto done;
	}
	table->row_count = rows;
	for (size_t row = 0; row < rows; row++)
		if (fill_row(builder, row, samples, err))
			goto done;
	result = 0;
done:
	free(samples);
	return result;
}

static void write_title(const struct builder *builder)
{
	const struct experiment *experiment = builder->experiment;
	const char *title = builder->layout->wanted->title;
	struct text *out = &builder->table->title;

	if (!*title)
		title = experiment->title;
	text_addf(out, "%s%s%s", builder->table->name, *title ? ": " : "", title);
	if (*experiment->source)
		text_addf(out, " (%s)", experiment->source);
	if (experiment->repeat > 1)
		text_addf(out, ", median of %d repeats \u00b1 half their range", experiment->repeat);
}

static void write_notes(const struct builder *builder, const char *command)
{
	struct text *notes = &builder->table->notes;

	provenance_print(&builder->provenance, builder->experiment->timing, notes);
	text_addf(notes, "Again with: %s\n", command);
}

int table_build(struct table *table, const struct experiment *experiment,
	const struct experiment_table *wanted, const char *command, struct error *err)
{
	struct layout layout = {0};
	struct builder builder = {.experiment = experiment, .layout = &layout, .table = table};
	int result = -1;

	*table = (struct table){.name = wanted->name.text};
	if (layout_create(&layout, experiment, wanted, err) || measure_runs(&builder, err) ||
		add_columns(&builder, err) || fill_cells(&builder, err))
		goto done;
	write_title(&builder);
	write_notes(&builder, command);
	if (table->title.failed || table->notes.failed || table->missing.failed)
		error_memory(err, table->notes.length);
	else
		result = 0;
done:
	run_file_close(builder.partner);
	free(builder.values);
	provenance_clean(&builder.provenance);
	layout_clean(&layout);
	return result;
}

int table_check(const struct experiment *experiment, struct error *err)
{
	for (size_t i = 0; i < experiment->table_count; i++) {
		struct layout layout;
		int result = layout_create(&layout, experiment, &experiment->tables[i], err);

		layout_clean(&layout);
		TRY(result);
	}
	return 0;
}

void table_clean(struct table *table)
{
	for (size_t i = 0; i < table->column_count; i++)
		for (size_t k = 0; k < table->columns[i].head_count; k++)
			free(table->columns[i].heads[k]);
	for (size_t i = 0; i < table->row_count * table->column_count; i++)
		free(table->cells[i].text);
	free(table->columns);
	free(table->cells);
	text_clean(&table->title);
	text_clean(&table->notes);
	text_clean(&table->missing);
	*table = (struct table){0};
}
