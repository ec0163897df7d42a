#include "tables/observed.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "config/quantity.h"
#include "talus/text.h"

enum { COLUMNS_MAX = 64, BYTES_MAX = 16 << 20, EXCERPT = 60 };

/* A file on its way: lines are cut into fields where they stand. */
struct csv {
	const char *path;
	char *rest;       /* what comes after the line, NULL: nothing */
	char *line, *end; /* the line without its end */
	int number;       /* of the line, from 1 */
	struct error *err;
};

struct csv_field {
	char *text;
	int column; /* from 1 */
};

static int fail(const struct csv *csv, int column, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

static int fail(const struct csv *csv, int column, const char *format, ...)
{
	char message[512];
	va_list args;

	va_start(args, format);
	(void)vsnprintf(message, sizeof message, format, args);
	va_end(args);
	return error_at(csv->err, EX_DATAERR, csv->path, csv->number, column, "%s", message);
}

static bool is_blank(char c)
{
	return c == ' ' || c == '\t';
}

/* The next line that is neither blank nor a comment. */
static bool next_line(struct csv *csv)
{
	while (csv->rest) {
		char *end = csv->rest + strcspn(csv->rest, "\r\n"), *at = csv->rest;

		csv->line = csv->rest;
		csv->number++;
		csv->rest = *end ? end + (end[0] == '\r' && end[1] == '\n' ? 2 : 1) : NULL;
		*end = '\0';
		csv->end = end;
		while (is_blank(*at))
			at++;
		if (*at && *at != '#')
			return true;
	}
	return false;
}

/* A field in quotes ends at its closing quote; two of them within it are one. `*at` moves behind it. */
static int unquote(const struct csv *csv, char **at, struct csv_field *field)
{
	char *from = *at + 1, *to = from;

	field->text = from;
	for (; *from; from++) {
		if (*from != '"')
			*to++ = *from;
		else if (from[1] == '"')
			*to++ = *from++;
		else
			break;
	}
	if (!*from)
		return fail(csv, field->column, "the quote that opens here is not closed in this line");
	*to = '\0';
	for (from++; is_blank(*from);)
		from++;
	if (*from && *from != ',')
		return fail(csv, (int)(from - csv->line) + 1, "a comma is wanted behind the quote");
	*at = from;
	return 0;
}

/* Cut the field at `*at` out, and move on to the next; `*at` is NULL after the last. */
static int next_field(const struct csv *csv, char **at, struct csv_field *field)
{
	char *start = *at, *end;

	while (is_blank(*start))
		start++;
	field->column = (int)(start - csv->line) + 1;
	field->text = start;
	if (*start == '"') {
		*at = start;
		TRY(unquote(csv, at, field));
		end = *at;
	} else {
		end = start + strcspn(start, ",");
	}
	*at = *end ? end + 1 : NULL;
	if (*start != '"')
		while (end > start && is_blank(end[-1]))
			end--;
	*end = '\0';
	return 0;
}

/* "h [mm]" -> "h", and what a value of the column is multiplied by. */
static int read_unit(const struct csv *csv, struct csv_field *field, double *factor)
{
	char *open = strchr(field->text, '['), *close = open ? strchr(open, ']') : NULL, *end = open;
	char shown[EXCERPT], one[EXCERPT];
	const char *si;
	struct error refusal = {0};

	*factor = 1;
	if (!open)
		return 0;
	if (!close || close[1])
		return fail(csv, field->column, "a unit stands in brackets at the end: h [mm]");
	*close = '\0';
	si = quantity_si(open + 1);
	(void)snprintf(one, sizeof one, "1 %s", open + 1);
	if (!si || !*(open + 1) || quantity_read(one, si, factor, &refusal))
		return fail(csv, field->column + (int)(open + 1 - field->text), "unknown unit '%s'",
			text_excerpt(open + 1, shown, sizeof shown));
	while (end > field->text && is_blank(end[-1]))
		end--;
	*end = '\0';
	return 0;
}

static size_t find_column(const struct observed *observed, const char *name)
{
	for (size_t i = 0; i < observed->columns; i++)
		if (!strcmp(observed->names[i], name))
			return i;
	return OBSERVED_NONE;
}

static int read_header(const struct csv *csv, struct observed *observed, double *factors)
{
	char *at = csv->line, shown[EXCERPT];

	while (at) {
		struct csv_field field;

		TRY(next_field(csv, &at, &field));
		if (observed->columns == COLUMNS_MAX)
			return fail(csv, field.column, "more than %d columns", COLUMNS_MAX);
		TRY(read_unit(csv, &field, &factors[observed->columns]));
		(void)text_excerpt(field.text, shown, sizeof shown);
		if (!*field.text)
			return fail(csv, field.column, "the name of a column is wanted here");
		if (find_column(observed, field.text) != OBSERVED_NONE)
			return fail(csv, field.column, "column '%s' stands here twice", shown);
		observed->names[observed->columns++] = field.text;
	}
	observed->time = find_column(observed, "time");
	observed->x = find_column(observed, "x");
	if (observed->time == OBSERVED_NONE)
		return fail(csv, 1, "a column 'time' is wanted: the first line names the columns");
	if (observed->columns == 1 + (observed->x != OBSERVED_NONE))
		return fail(csv, 1,
			"a column of values is wanted beside time%s, "
			"named like a dataset of the run files: h, front_position",
			observed->x != OBSERVED_NONE ? " and x" : "");
	return 0;
}

/* Rows go up in time, and in x within a time. */
static int check_order(const struct csv *csv, const struct observed *observed, const int *columns)
{
	const double *now = &observed->values[observed->rows * observed->columns];
	const double *before = now - observed->columns;
	size_t t = observed->time, x = observed->x;

	if (isnan(now[t]) || (x != OBSERVED_NONE && isnan(now[x])))
		return fail(csv, columns[isnan(now[t]) ? t : x], "%s is wanted in every row",
			isnan(now[t]) ? "time" : "x");
	if (!observed->rows)
		return 0;
	if (now[t] < before[t])
		return fail(csv, columns[t], "time goes back from %g s to %g s", before[t], now[t]);
	if (now[t] > before[t])
		return 0;
	if (x == OBSERVED_NONE)
		return fail(csv, columns[t], "time %g s stands here twice", now[t]);
	if (now[x] <= before[x])
		return fail(csv, columns[x], "x goes from %g m to %g m at one time; it must go up",
			before[x], now[x]);
	return 0;
}

static int read_row(const struct csv *csv, struct observed *observed, const double *factors)
{
	double *row = &observed->values[observed->rows * observed->columns];
	int columns[COLUMNS_MAX];
	char *at = csv->line, shown[EXCERPT];

	for (size_t i = 0; i < observed->columns; i++) {
		struct csv_field field;
		double value = NAN;

		if (!at)
			return fail(csv, (int)(csv->end - csv->line) + 1, "this row has %zu of %zu fields", i,
				observed->columns);
		TRY(next_field(csv, &at, &field));
		columns[i] = field.column;
		if (*field.text && !text_to_real(field.text, &value))
			return fail(csv, field.column, "%s: '%s' is not a number", observed->names[i],
				text_excerpt(field.text, shown, sizeof shown));
		row[i] = value * factors[i];
	}
	if (at)
		return fail(
			csv, (int)(at - csv->line) + 1, "this row has more than %zu fields", observed->columns);
	TRY(check_order(csv, observed, columns));
	observed->rows++;
	return 0;
}

static int read_rows(struct csv *csv, struct observed *observed)
{
	double factors[COLUMNS_MAX];
	size_t lines = 2, bytes;

	for (const char *at = csv->rest; *at; at++)
		lines += *at == '\n' || *at == '\r';
	if (!next_line(csv))
		return fail(csv, 1, "holds no values: a line that names its columns is wanted first");
	TRY(read_header(csv, observed, factors));
	bytes = lines * observed->columns * sizeof *observed->values;
	observed->values = malloc(bytes);
	if (!observed->values)
		return error_memory(csv->err, bytes);
	while (next_line(csv))
		TRY(read_row(csv, observed, factors));
	return observed->rows ? 0 : fail(csv, 1, "holds no values below the names of its columns");
}

int observed_read(struct observed *observed, const char *path, struct error *err)
{
	struct csv csv = {.path = path, .err = err};
	unsigned char *bytes = NULL;
	size_t size;

	*observed = (struct observed){0};
	if (file_read(path, &bytes, &size, err)) {
		if (err->code == EX_NOINPUT || err->code == EX_IOERR)
			err->code = EX_DATAERR;
		return -1;
	}
	observed->text = malloc(size + 1);
	observed->names = calloc(COLUMNS_MAX, sizeof *observed->names);
	if (!observed->text || !observed->names) {
		free(bytes);
		return error_memory(err, size);
	}
	memcpy(observed->text, bytes, size);
	observed->text[size] = '\0';
	free(bytes);
	if (size > BYTES_MAX)
		return error_at(err, EX_DATAERR, path, 0, 0, "is larger than 16 MiB");
	if (strlen(observed->text) != size)
		return error_at(err, EX_DATAERR, path, 0, 0, "is no text: it holds a NUL byte");
	csv.rest = observed->text + (strncmp(observed->text, "\xEF\xBB\xBF", 3) ? 0 : 3);
	return read_rows(&csv, observed);
}

void observed_clean(struct observed *observed)
{
	free(observed->text);
	free(observed->names);
	free(observed->values);
	*observed = (struct observed){0};
}

bool observed_has(const struct observed *observed, const char *name, bool over_x)
{
	size_t column = find_column(observed, name);

	return column != OBSERVED_NONE && column != observed->time && column != observed->x &&
		   over_x == (observed->x != OBSERVED_NONE);
}

int observed_line(const struct observed *observed, const char *name, double time,
	struct observed_line *line, struct error *err)
{
	size_t column = find_column(observed, name);
	bool over_x = observed->x != OBSERVED_NONE;

	line->count = 0;
	line->at = malloc((observed->rows + 1) * sizeof *line->at);
	line->values = malloc((observed->rows + 1) * sizeof *line->values);
	if (!line->at || !line->values)
		return error_memory(err, observed->rows * sizeof *line->at);
	for (size_t i = 0; i < observed->rows; i++) {
		const double *row = &observed->values[i * observed->columns];

		if (isnan(row[column]) ||
			(over_x && fabs(row[observed->time] - time) > 1e-9 * fmax(1, fabs(time))))
			continue;
		line->at[line->count] = row[over_x ? observed->x : observed->time];
		line->values[line->count++] = row[column];
	}
	return 0;
}

void observed_line_clean(struct observed_line *line)
{
	free(line->at);
	free(line->values);
	*line = (struct observed_line){0};
}
