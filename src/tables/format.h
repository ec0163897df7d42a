/* What the ways to write a table down share. */
#ifndef TALUS_FORMAT_H
#define TALUS_FORMAT_H

#include "talus/tables.h"

/* A cell for people. */
void format_cell(
	const struct table_column *column, const struct table_cell *cell, struct text *out);

/* Aligned columns under heads that are written once for all the columns which share them. */
void format_text(const struct table *table, struct text *out);

#endif
