/* One builder for every table: gather the repeats of a cell, lay the cells out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tables/measured.h"
#include "tables/scale.h"
#include "talus/tables.h"

struct builder {
	const struct experiment *experiment;
	const struct layout *layout;
	struct table *table;
	struct measured measured;
};

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
		double value = builder->measured.values[i * layout->measure_count + m];

		if (layout->places[i].row != row || layout->places[i].column != column)
			continue;
		asked |= layout_asks(layout, i, layout->measures[m].metric);
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

/* "runout m", or "runout /h0" in a table without dimensions. */
static int add_metric_head(const struct builder *builder, const struct metric *metric,
	struct table_column *out, struct error *err)
{
	const struct scale *scale =
		builder->layout->wanted->dimensionless ? scale_find(metric->name, metric->unit) : NULL;
	char unit[32];

	(void)snprintf(unit, sizeof unit, "%s%s", scale ? "/" : "", scale ? scale->name : metric->unit);
	return *unit ? add_head(out, metric->header, unit, err)
				 : add_head(out, "", metric->header, err);
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
	TRY(add_metric_head(builder, measure->metric, out, err));
	if (measure->at_text)
		TRY(add_head(out, "at", measure->at_text, err));
	if (measure->x_text)
		TRY(add_head(out, "at_x", measure->x_text, err));
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

	text_add(notes, text_string(&builder->measured.warnings));
	provenance_print(&builder->measured.provenance, builder->experiment->timing, notes);
	text_addf(notes, "Again with: %s\n", command);
}

int table_build(struct table *table, const struct experiment *experiment,
	const struct experiment_table *wanted, const char *command, struct error *err)
{
	struct layout layout = {0};
	struct builder builder = {.experiment = experiment, .layout = &layout, .table = table};
	int result = -1;

	*table = (struct table){.name = wanted->name.text};
	if (layout_create(&layout, experiment, wanted, "table", err) ||
		measured_make(&builder.measured, &layout, err) || add_columns(&builder, err) ||
		fill_cells(&builder, err))
		goto done;
	table->missing = builder.measured.missing;
	builder.measured.missing = (struct text){0};
	write_title(&builder);
	write_notes(&builder, command);
	if (table->title.failed || table->notes.failed || table->missing.failed)
		error_memory(err, table->notes.length);
	else
		result = 0;
done:
	measured_clean(&builder.measured);
	layout_clean(&layout);
	return result;
}

int table_check(const struct experiment *experiment, struct error *err)
{
	for (size_t i = 0; i < experiment->table_count; i++) {
		struct layout layout;
		int result = layout_create(&layout, experiment, &experiment->tables[i], "table", err);

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
