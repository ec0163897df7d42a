/* A table for programs: a column with its values at a time, as data frames want them. */
#include <string.h>

#include "base/json.h"
#include "tables/format.h"

static void add_strings(struct text *out, char *const *strings, size_t count)
{
	text_add(out, "[");
	for (size_t i = 0; i < count; i++) {
		text_add(out, i ? ", " : "");
		json_add_string(out, strings[i]);
	}
	text_add(out, "]");
}

/* The lines of a text. */
static void add_lines(struct text *out, const char *lines)
{
	text_add(out, "[");
	for (size_t i = 0; *lines; i++) {
		size_t length = strcspn(lines, "\n");
		struct text line = {0};

		text_add_bytes(&line, lines, length);
		text_add(out, i ? ",\n    " : "\n    ");
		json_add_string(out, text_string(&line));
		out->failed |= line.failed;
		text_clean(&line);
		lines += length + (lines[length] == '\n');
	}
	text_add(out, "]");
}

/* A label that is no number is a string, and so is a published value that is no number; what is blank or missing is null. */
static void add_value(
	struct text *out, const struct table_column *column, const struct table_cell *cell, bool labels)
{
	double number;

	if (cell->kind == CELL_NUMBER)
		json_add_real(out, cell->value);
	else if (labels)
		json_add_real(out, format_label_number(cell));
	else if (cell->kind == CELL_TEXT && (column->label || !text_to_real(cell->text, &number)))
		json_add_string(out, cell->text);
	else if (cell->kind == CELL_TEXT)
		json_add_real(out, number);
	else
		text_add(out, "null");
}

static void add_spread(struct text *out, const struct table_cell *cell)
{
	if (cell->kind == CELL_NUMBER)
		json_add_real(out, cell->spread);
	else
		text_add(out, "null");
}

static void add_missing(struct text *out, const struct table_cell *cell)
{
	text_add(out, cell->kind == CELL_MISSING ? "true" : "false");
}

static void add_column(struct text *out, const struct table *table, size_t c)
{
	const struct table_column *column = &table->columns[c];
	const char *unit = format_label_unit(table, c);
	bool missing = false;

	text_addf(out, "%s\n    {\"heads\": ", c ? "," : "");
	add_strings(out, column->heads, column->head_count);
	text_addf(out, ", \"label\": %s,\n", column->label ? "true" : "false");
	if (unit && *unit) {
		text_add(out, "     \"unit\": ");
		json_add_string(out, unit);
		text_add(out, ",\n");
	}
	text_add(out, "     \"values\": [");
	for (size_t row = 0; row < table->row_count; row++) {
		const struct table_cell *cell = &table->cells[row * table->column_count + c];

		text_add(out, row ? ", " : "");
		add_value(out, column, cell, unit != NULL);
		missing |= cell->kind == CELL_MISSING;
	}
	text_add(out, "]");
	for (int which = 0; which < 2; which++) {
		if (which ? !missing : !column->spread)
			continue;
		text_addf(out, ",\n     \"%s\": [", which ? "missing" : "spreads");
		for (size_t row = 0; row < table->row_count; row++) {
			text_add(out, row ? ", " : "");
			(which ? add_missing : add_spread)(out, &table->cells[row * table->column_count + c]);
		}
		text_add(out, "]");
	}
	text_add(out, "}");
}

void format_json(const struct table *table, struct text *out)
{
	text_add(out, "{\n  \"name\": ");
	json_add_string(out, table->name);
	text_add(out, ",\n  \"title\": ");
	json_add_string(out, text_string(&table->title));
	text_add(out, ",\n  \"columns\": [");
	for (size_t c = 0; c < table->column_count; c++)
		add_column(out, table, c);
	text_add(out, "],\n  \"notes\": ");
	add_lines(out, text_string(&table->notes));
	text_add(out, ",\n  \"missing\": ");
	add_lines(out, text_string(&table->missing));
	text_add(out, "\n}\n");
}
