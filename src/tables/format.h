/* What the ways to write a table down share. */
#ifndef TALUS_FORMAT_H
#define TALUS_FORMAT_H

#include "talus/tables.h"

/* A cell for people. */
void format_cell(
	const struct table_column *column, const struct table_cell *cell, struct text *out);

/* The unit, "" for none, of labels that are all numbers in one unit; NULL: they are words. The number of such
 * a label. */
const char *format_label_unit(const struct table *table, size_t c);
double format_label_number(const struct table_cell *cell);

/* How many lines the heads take; a head of column c in one of them, that of a label in the last; and the
 * column behind those that share all heads of c down to a line. */
size_t format_head_lines(const struct table *table);
const char *format_head_at(const struct table *table, size_t c, size_t line, size_t lines);
size_t format_group_end(const struct table *table, size_t c, size_t line);

/* The notes, each behind `mark`. */
void format_note_lines(const struct table *table, const char *mark, struct text *out);

/* Aligned columns under heads that are written once for all the columns which share them. */
void format_text(const struct table *table, struct text *out);

void format_latex(const struct table *table, struct text *out);
void format_json(const struct table *table, struct text *out);

#endif
