/* How a table is written down: a row of `formats` per way. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tables/format.h"

/* Values below 10^SMALL are written as 3.05e-05 where significant digits count. */
enum { SMALL = -3, EXPONENT = -1 };

/* Enough decimals for three significant digits, or EXPONENT. */
static int decimals_of(const struct table_column *column, double value)
{
	int whole;

	if (column->decimals >= 0)
		return column->decimals;
	if (value == 0 || !isfinite(value))
		return 2;
	whole = (int)floor(log10(fabs(value))) + 1;
	return whole >= 3 ? 0 : whole < SMALL ? EXPONENT : 3 - whole;
}

static void add_number(double value, int decimals, struct text *out)
{
	if (decimals == EXPONENT)
		text_addf(out, "%.2e", value);
	else
		text_addf(out, "%.*f", decimals, value);
}

void format_cell(const struct table_column *column, const struct table_cell *cell, struct text *out)
{
	int decimals = decimals_of(column, cell->value);

	switch (cell->kind) {
	case CELL_BLANK:
		break;
	case CELL_TEXT:
		text_add(out, cell->text);
		break;
	case CELL_MISSING:
		text_add(out, "missing");
		break;
	case CELL_NUMBER:
		add_number(cell->value, decimals, out);
		if (column->spread) {
			text_add(out, " \u00b1 ");
			add_number(cell->spread, decimals, out);
		}
		break;
	}
}

/* "1.82 mm": the number, and what is behind it; false for words. */
static bool split_label(const char *label, double *number, const char **unit)
{
	char digits[TEXT_REAL_SIZE];
	size_t length = strcspn(label, " ");

	*unit = label[length] ? label + length + 1 : "";
	if (length >= sizeof digits)
		return false;
	(void)snprintf(digits, sizeof digits, "%.*s", (int)length, label);
	return text_to_real(digits, number);
}

const char *format_label_unit(const struct table *table, size_t c)
{
	const char *shared = NULL, *unit;
	double number;

	for (size_t row = 0; table->columns[c].label && row < table->row_count; row++) {
		const struct table_cell *cell = &table->cells[row * table->column_count + c];

		if (cell->kind != CELL_TEXT || !split_label(cell->text, &number, &unit) ||
			(shared && strcmp(unit, shared) != 0))
			return NULL;
		shared = unit;
	}
	return shared;
}

double format_label_number(const struct table_cell *cell)
{
	const char *unit;
	double number = NAN;

	(void)split_label(cell->text, &number, &unit);
	return number;
}

/* All heads of a column in one line. */
static void join_heads(const struct table_column *column, struct text *out)
{
	for (size_t k = 0; k < column->head_count; k++)
		text_addf(out, "%s%s", k ? ", " : "", column->heads[k]);
}

static void add_markdown(struct text *out, const char *string)
{
	text_add(out, " ");
	for (; *string; string++) {
		if (strchr("|\\`*_<", *string))
			text_add(out, "\\");
		text_add_bytes(out, *string == '\n' ? " " : string, 1);
	}
	text_add(out, " |");
}

void format_note_lines(const struct table *table, const char *mark, struct text *out)
{
	for (const char *line = text_string(&table->notes); *line;) {
		size_t length = strcspn(line, "\n");

		text_addf(out, "%s%.*s\n", mark, (int)length, line);
		line += length + (line[length] == '\n');
	}
}

static void print_markdown(const struct table *table, struct text *out)
{
	text_addf(out, "**%s**\n\n|", text_string(&table->title));
	for (size_t c = 0; c < table->column_count; c++) {
		struct text heads = {0};

		join_heads(&table->columns[c], &heads);
		add_markdown(out, text_string(&heads));
		out->failed |= heads.failed;
		text_clean(&heads);
	}
	text_add(out, "\n|");
	for (size_t c = 0; c < table->column_count; c++)
		text_add(out, table->columns[c].label ? " :-- |" : " --: |");
	for (size_t row = 0; row < table->row_count; row++) {
		text_add(out, "\n|");
		for (size_t c = 0; c < table->column_count; c++) {
			struct text cell = {0};

			format_cell(&table->columns[c], &table->cells[row * table->column_count + c], &cell);
			add_markdown(out, text_string(&cell));
			out->failed |= cell.failed;
			text_clean(&cell);
		}
	}
	text_add(out, "\n\n");
	format_note_lines(table, "- ", out);
}

/* RFC 4180: quotes where a field holds a comma, a quote or a line end; lines end in CR LF. */
static void add_field(struct text *out, const char *string, bool first)
{
	if (!first)
		text_add(out, ",");
	if (!strpbrk(string, ",\"\r\n")) {
		text_add(out, string);
		return;
	}
	text_add(out, "\"");
	for (; *string; string++) {
		if (*string == '"')
			text_add(out, "\"");
		text_add_bytes(out, string, 1);
	}
	text_add(out, "\"");
}

static void add_csv_heads(const struct table *table, struct text *out)
{
	for (size_t c = 0; c < table->column_count; c++) {
		struct text heads = {0};
		const char *unit = format_label_unit(table, c);

		join_heads(&table->columns[c], &heads);
		text_addf(&heads, "%s%s", unit && *unit ? " " : "", unit ? unit : "");
		add_field(out, text_string(&heads), c == 0);
		text_add(&heads, ", \u00b1");
		if (table->columns[c].spread)
			add_field(out, text_string(&heads), false);
		out->failed |= heads.failed;
		text_clean(&heads);
	}
	text_add(out, "\r\n");
}

/* Numbers in full and without units: a CSV file is read by programs. */
static void add_csv_cell(const struct table *table, size_t c, const struct table_cell *cell,
	bool first, struct text *out)
{
	const struct table_column *column = &table->columns[c];
	bool number = cell->kind == CELL_NUMBER;
	char buffer[TEXT_REAL_SIZE];
	struct text words = {0};

	if (number) {
		add_field(out, text_real(cell->value, buffer), first);
	} else if (format_label_unit(table, c)) {
		add_field(out, text_real(format_label_number(cell), buffer), first);
	} else {
		format_cell(column, cell, &words);
		add_field(out, text_string(&words), first);
		out->failed |= words.failed;
		text_clean(&words);
	}
	if (column->spread)
		add_field(out, number ? text_real(cell->spread, buffer) : "", false);
}

static void print_csv(const struct table *table, struct text *out)
{
	add_csv_heads(table, out);
	for (size_t row = 0; row < table->row_count; row++) {
		for (size_t c = 0; c < table->column_count; c++)
			add_csv_cell(table, c, &table->cells[row * table->column_count + c], c == 0, out);
		text_add(out, "\r\n");
	}
}

static const struct table_format formats[] = {
	{"text", false, format_text},
	{"markdown", false, print_markdown},
	{"csv", true, print_csv},
	{"latex", false, format_latex},
	{"json", true, format_json},
};

const struct table_format *table_format_find(const char *name)
{
	for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
		if (!strcmp(name, formats[i].name))
			return &formats[i];
	return NULL;
}

void table_format_names(struct text *out)
{
	for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
		text_addf(out, "%s%s", i ? ", " : "", formats[i].name);
}
