/* Finished run files -> tables. Never calls the engine. */
#ifndef TALUS_TABLES_H
#define TALUS_TABLES_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"
#include "talus/experiment.h"
#include "talus/text.h"

enum cell_kind {
	CELL_BLANK,   /* the experiment asks for no such run, or nothing was published */
	CELL_TEXT,    /* a label, or a published value as its author wrote it */
	CELL_NUMBER,  /* from our run files */
	CELL_MISSING, /* its runs are not complete */
};

struct table_cell {
	enum cell_kind kind;
	char *text;           /* of CELL_TEXT, else NULL */
	double value, spread; /* of CELL_NUMBER: median of the repeats, half their range */
};

enum { TABLE_HEADS_MAX = 12 };

struct table_column {
	char *heads[TABLE_HEADS_MAX]; /* [head_count], from the general to the particular */
	size_t head_count;
	bool label;   /* names the row; the others hold numbers */
	bool spread;  /* its cells have one */
	int decimals; /* -1: three significant digits */
};

struct table {
	const char *name;
	struct text title;
	struct table_column *columns; /* [column_count] */
	size_t column_count;
	struct table_cell *cells; /* [row_count][column_count] */
	size_t row_count;
	struct text notes;   /* lines below the table */
	struct text missing; /* a line per missing run: its name and why; empty: the table is whole */
};

/* A way to write a table down; a row of the table in format.c. */
struct table_format {
	const char *name;
	bool single; /* the text can hold one table only */
	void (*print)(const struct table *table, struct text *out);
};

/* Build the table that `wanted` asks for from the run files of its experiment. `command` is what
 * makes it again, for its notes. A missing run is no error: see `missing`. EX_DATAERR where the
 * experiment asks for what it cannot have, EX_SOFTWARE. Clean in every case. */
int table_build(struct table *table, const struct experiment *experiment,
	const struct experiment_table *wanted, const char *command, struct error *err);

void table_clean(struct table *table);

/* Is every table of the experiment one that could be built once its runs are complete? */
int table_check(const struct experiment *experiment, struct error *err);

/* NULL if there is none of that name. */
const struct table_format *table_format_find(const char *name);

/* "text, markdown, csv, ..." */
void table_format_names(struct text *out);

#endif
