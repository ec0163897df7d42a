/* A table for LaTeX, with the rules of package booktabs. */
#include <ctype.h>
#include <string.h>

#include "tables/format.h"

/* What TeX gives a meaning, as itself. A bracket could be taken for the argument of the row before. */
static void add_escaped(struct text *out, const char *string)
{
	static const struct {
		const char *from, *to;
	} marks[] = {
		{"\\", "\\textbackslash{}"},
		{"^", "\\textasciicircum{}"},
		{"~", "\\textasciitilde{}"},
		{"[", "{[}"},
		{"]", "{]}"},
		{"<", "\\textless{}"},
		{">", "\\textgreater{}"},
		{"|", "\\textbar{}"},
		{"\u00b1", "$\\pm$"},
		{"\u00b0", "\\textdegree{}"},
		{"\n", " "},
		{"\r", " "},
	};
	enum { MARKS = sizeof marks / sizeof *marks };

	while (*string) {
		size_t i = 0;

		while (i < MARKS && strncmp(string, marks[i].from, strlen(marks[i].from)) != 0)
			i++;
		if (i < MARKS) {
			text_add(out, marks[i].to);
			string += strlen(marks[i].from);
			continue;
		}
		if (strchr("#$%&_{}", *string))
			text_add(out, "\\");
		text_add_bytes(out, string++, 1);
	}
}

/* Heads that columns share stand once, over a rule. */
static void add_heads(const struct table *table, size_t lines, struct text *out)
{
	for (size_t line = 0; line < lines; line++) {
		struct text rules = {0};

		for (size_t c = 0, end; c < table->column_count; c = end) {
			const char *head = format_head_at(table, c, line, lines);

			end = format_group_end(table, c, line);
			text_add(out, c ? " & " : "");
			if (end > c + 1) {
				text_addf(out, "\\multicolumn{%zu}{c}{", end - c);
				text_addf(&rules, "\\cmidrule(lr){%zu-%zu}", c + 1, end);
			}
			add_escaped(out, head);
			text_add(out, end > c + 1 ? "}" : "");
		}
		text_addf(out, " \\\\\n%s%s", text_string(&rules), rules.length ? "\n" : "");
		text_clean(&rules);
	}
}

static void add_row(const struct table *table, size_t row, struct text *out)
{
	for (size_t c = 0; c < table->column_count; c++) {
		const struct table_cell *cell = &table->cells[row * table->column_count + c];
		struct text words = {0};

		format_cell(&table->columns[c], cell, &words);
		text_add(out, c ? " & " : "");
		text_add(out, cell->kind == CELL_MISSING ? "\\emph{" : "");
		add_escaped(out, text_string(&words));
		text_add(out, cell->kind == CELL_MISSING ? "}" : "");
		text_clean(&words);
	}
	text_add(out, " \\\\\n");
}

/* A label names, it is not shown: letters, digits and -. */
static void add_label(const char *name, struct text *out)
{
	text_add(out, "\\label{tab:");
	for (; *name; name++)
		text_addf(
			out, "%c", isalnum((unsigned char)*name) && (unsigned char)*name < 0x80 ? *name : '-');
	text_add(out, "}\n");
}

void format_latex(const struct table *table, struct text *out)
{
	size_t lines = format_head_lines(table);

	text_add(out, "% \\usepackage{booktabs}\n\\begin{table}\n\\centering\n\\caption{");
	add_escaped(out, text_string(&table->title));
	text_add(out, "}\n");
	add_label(table->name, out);
	text_add(out, "\\begin{tabular}{");
	for (size_t c = 0; c < table->column_count; c++)
		text_add(out, table->columns[c].label ? "l" : "r");
	text_add(out, "}\n\\toprule\n");
	add_heads(table, lines, out);
	text_add(out, "\\midrule\n");
	for (size_t row = 0; row < table->row_count; row++)
		add_row(table, row, out);
	text_add(out, "\\bottomrule\n\\end{tabular}\n\\end{table}\n");
	format_note_lines(table, "% ", out);
}
