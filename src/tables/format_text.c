/* A table for the screen. */
#include <stdlib.h>
#include <string.h>

#include "tables/format.h"

enum { GAP = 2 }; /* blanks between columns */

/* Columns on the screen of UTF-8 text without wide or combining characters. */
static int width_of(const char *string)
{
	int width = 0;

	for (; *string; string++)
		width += ((unsigned char)*string & 0xC0) != 0x80;
	return width;
}

size_t format_head_lines(const struct table *table)
{
	size_t lines = 1;

	for (size_t c = 0; c < table->column_count; c++)
		if (table->columns[c].head_count > lines)
			lines = table->columns[c].head_count;
	return lines;
}

const char *format_head_at(const struct table *table, size_t c, size_t line, size_t lines)
{
	const struct table_column *column = &table->columns[c];
	size_t skipped = column->label ? lines - column->head_count : 0;

	return line < skipped || line - skipped >= column->head_count ? ""
																  : column->heads[line - skipped];
}

size_t format_group_end(const struct table *table, size_t c, size_t line)
{
	const struct table_column *first = &table->columns[c];
	size_t end = c + 1;

	if (first->label || line >= first->head_count)
		return end;
	for (; end < table->column_count; end++) {
		const struct table_column *other = &table->columns[end];

		if (other->head_count <= line)
			return end;
		for (size_t k = 0; k <= line; k++)
			if (strcmp(first->heads[k], other->heads[k]) != 0)
				return end;
	}
	return end;
}

static int group_width(const int *widths, size_t c, size_t end)
{
	int width = -GAP;

	for (; c < end; c++)
		width += widths[c] + GAP;
	return width;
}

static void fit_cells(const struct table *table, int *widths, struct text *out)
{
	for (size_t i = 0; i < table->row_count * table->column_count; i++) {
		size_t c = i % table->column_count;
		struct text cell = {0};

		format_cell(&table->columns[c], &table->cells[i], &cell);
		if (width_of(text_string(&cell)) > widths[c])
			widths[c] = width_of(text_string(&cell));
		out->failed |= cell.failed;
		text_clean(&cell);
	}
}

/* Widen the last column of a group whose head is wider than all of it. */
static void fit_heads(const struct table *table, size_t lines, int *widths)
{
	for (size_t line = lines; line-- > 0;)
		for (size_t c = 0, end; c < table->column_count; c = end) {
			int missing;

			end = format_group_end(table, c, line);
			missing = width_of(format_head_at(table, c, line, lines)) - group_width(widths, c, end);
			if (missing > 0)
				widths[end - 1] += missing;
		}
}

static void add_blanks(struct text *out, int count)
{
	text_addf(out, "%*s", count, "");
}

static void end_line(struct text *out)
{
	while (out->length && out->data[out->length - 1] == ' ')
		out->data[--out->length] = '\0';
	text_add(out, "\n");
}

/* Labels to the left, numbers to the right, shared heads in the middle. */
static void add_padded(struct text *out, const char *string, int width, bool left, bool middle)
{
	int blanks = width - width_of(string), before = left ? 0 : middle ? blanks / 2 : blanks;

	add_blanks(out, before);
	text_add(out, string);
	add_blanks(out, blanks - before + GAP);
}

static void print_heads(
	const struct table *table, size_t lines, const int *widths, struct text *out)
{
	for (size_t line = 0; line < lines; line++) {
		for (size_t c = 0, end; c < table->column_count; c = end) {
			end = format_group_end(table, c, line);
			add_padded(out, format_head_at(table, c, line, lines), group_width(widths, c, end),
				table->columns[c].label, end > c + 1);
		}
		end_line(out);
	}
	for (int i = group_width(widths, 0, table->column_count); i > 0; i--)
		text_add(out, "-");
	text_add(out, "\n");
}

static void print_rows(const struct table *table, const int *widths, struct text *out)
{
	for (size_t row = 0; row < table->row_count; row++) {
		for (size_t c = 0; c < table->column_count; c++) {
			struct text cell = {0};

			format_cell(&table->columns[c], &table->cells[row * table->column_count + c], &cell);
			add_padded(out, text_string(&cell), widths[c], table->columns[c].label, false);
			out->failed |= cell.failed;
			text_clean(&cell);
		}
		end_line(out);
	}
}

void format_text(const struct table *table, struct text *out)
{
	int *widths = calloc(table->column_count + 1, sizeof *widths);
	size_t lines = format_head_lines(table);

	if (!widths) {
		out->failed = true;
		return;
	}
	fit_cells(table, widths, out);
	fit_heads(table, lines, widths);
	text_addf(out, "%s\n\n", text_string(&table->title));
	print_heads(table, lines, widths, out);
	print_rows(table, widths, out);
	text_addf(out, "\n%s", text_string(&table->notes));
	free(widths);
}
