/* Points of a profile, such as a bed: pairs with x rising, in the config itself or in a file of two columns.
 * Once read they are part of the config: it can be repeated, and tells by its hash, without the file. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "config/field_parts.h"
#include "config/quantity.h"

enum { BYTES_MAX = 1 << 20 };

/* Points on their way, as x, value, x, value. */
struct points {
	const struct field *field;
	double *values; /* [2 POINTS_MAX] */
	int count;      /* of values */
	int column;     /* of the line of a file that is being read */
};

static int check_order(const struct points *points, struct error *err)
{
	const double *last = points->values + points->count;
	char shown[TEXT_REAL_SIZE];

	if (points->count < 4 || last[-2] > last[-4])
		return 0;
	return error_set(err, EX_DATAERR, "x = %s is not beyond that of the point before",
		text_real(last[-2], shown));
}

static int check_room(const struct points *points, struct error *err)
{
	if (points->count < 2 * POINTS_MAX)
		return 0;
	return error_set(err, EX_DATAERR, "more than %d points", POINTS_MAX);
}

/* "0.5 1.25" or "0.5, 1.25"; the error has no place. */
static int read_line(struct points *points, char *line, struct error *err)
{
	static const char blanks[] = " \t,;";
	char shown[EXCERPT], *rest = NULL, *word = strtok_r(line, blanks, &rest);
	int words = 0;

	if (!word || *word == '#')
		return 0;
	TRY(check_room(points, err));
	for (; word && *word != '#'; word = strtok_r(NULL, blanks, &rest), words++) {
		double *value = &points->values[points->count];

		points->column = (int)(word - line) + 1;
		if (words == 2)
			return error_set(err, EX_DATAERR, "a third value: a line holds x and one value");
		(void)text_excerpt(word, shown, sizeof shown);
		if (!text_to_real(word, value))
			return error_set(err, EX_DATAERR,
				"'%s' is not a number; a line holds x and one value in m, or begins with #", shown);
		TRY(field_check_range(points->field, shown, *value, err));
		points->count++;
	}
	points->column = 1;
	if (words == 1)
		return error_set(err, EX_DATAERR, "a value is missing: a line holds x and one value");
	return check_order(points, err);
}

/* Lines end as those of configs do: with LF, CR LF, or CR alone. */
static int read_text(struct points *points, const char *path, char *text, struct error *err)
{
	int number = 1;

	if (!strncmp(text, "\xEF\xBB\xBF", 3))
		text += 3; /* the mark that some editors put before UTF-8 */
	for (char *line = text, *next; line; line = next, number++) {
		char *end = line + strcspn(line, "\r\n");
		struct error here = {0};

		next = *end ? end + (end[0] == '\r' && end[1] == '\n' ? 2 : 1) : NULL;
		*end = '\0';
		points->column = 1;
		if (read_line(points, line, &here) != 0)
			return error_at(err, EX_DATAERR, path, number, points->column, "%s", here.text);
	}
	return 0;
}

/* `name` is relative to the folder of `beside`, the config file. */
static int read_file(struct points *points, const char *beside, const char *name, struct error *err)
{
	const char *slash = strrchr(beside, '/');
	size_t folder = *name == '/' || !slash ? 0 : (size_t)(slash - beside) + 1;
	char *text = malloc(BYTES_MAX + 2), shown[EXCERPT];
	struct text path = {0};
	ssize_t length = -1;
	int status = -1;

	text_add_bytes(&path, beside, folder);
	text_add(&path, name);
	if (!text || path.failed)
		(void)error_memory(err, BYTES_MAX + 2);
	else if ((length = file_read_text(text_string(&path), text, BYTES_MAX + 1)) < 0)
		(void)error_set(err, EX_DATAERR, "the file '%s' cannot be read: %s",
			text_excerpt(text_string(&path), shown, sizeof shown), strerror(errno));
	else if (length > BYTES_MAX)
		(void)error_at(err, EX_DATAERR, text_string(&path), 0, 0, "more than 1 MiB of text");
	else if (memchr(text, '\0', (size_t)length))
		(void)error_at(err, EX_DATAERR, text_string(&path), 0, 0, "this is no text");
	else {
		text[length] = '\0';
		status = read_text(points, text_string(&path), text, err);
		if (!status && points->count < 4)
			status = error_at(err, EX_DATAERR, text_string(&path), 0, 0,
				"%s; a profile has two points at least",
				points->count ? "one point" : "nothing in it");
	}
	text_clean(&path);
	free(text);
	return status;
}

static int read_pair(const struct node *pair, struct points *points, struct error *err)
{
	char shown[EXCERPT];

	if (pair->kind != NODE_SEQUENCE || pair->count != 2)
		return error_set(err, EX_DATAERR, "expected a point [x, value] here");
	TRY(check_room(points, err));
	for (size_t i = 0; i < 2; i++) {
		const struct node *item = &pair->items[i];
		double *value = &points->values[points->count++];

		if (item->kind != NODE_SCALAR)
			return error_set(
				err, EX_DATAERR, "expected a single value, not %s", node_kind_name(item));
		TRY(quantity_read(item->text, points->field->unit, value, err));
		TRY(field_check_range(
			points->field, text_excerpt(item->text, shown, sizeof shown), *value, err));
	}
	return check_order(points, err);
}

static int read_list(const struct field_place *place, struct points *points, struct error *err)
{
	const struct node *node = place->node;

	for (size_t i = 0; i < node->count; i++)
		if (read_pair(&node->items[i], points, err) != 0)
			return field_set_place(place->source, &node->items[i], err);
	if (node->count == 1)
		return error_set(err, EX_DATAERR, "one point; a profile has two points at least");
	return 0;
}

int points_convert(const struct field *field, const struct field_place *place, const char *beside,
	struct real_list *list, struct error *err)
{
	const size_t bytes = sizeof(double) * 2 * POINTS_MAX;
	struct points points = {.field = field};
	int status = -1;

	if (place->node->kind == NODE_SEQUENCE && !place->node->count)
		return real_list_keep(list, NULL, 0, err);
	points.values = malloc(bytes);
	if (!points.values)
		return error_memory(err, bytes);
	if (place->node->kind == NODE_MAPPING)
		(void)error_set(err, EX_DATAERR,
			"expected the name of a file, or points such as [[0, 0], [1, 0.1]], not %s",
			node_kind_name(place->node));
	else if (place->node->kind == NODE_SCALAR && !*place->node->text)
		(void)error_set(err, EX_DATAERR, "the value is missing");
	else if (place->node->kind == NODE_SCALAR)
		status = read_file(&points, beside, place->node->text, err);
	else
		status = read_list(place, &points, err);
	if (!status)
		status = real_list_keep(list, points.values, points.count, err);
	free(points.values);
	return status;
}

void points_print(const struct real_list *list, struct text *out)
{
	char x[TEXT_REAL_SIZE], value[TEXT_REAL_SIZE];

	text_add(out, "[");
	for (int i = 0; i + 1 < list->count; i += 2)
		text_addf(out, "%s[%s, %s]", i ? ", " : "", text_real(list->values[i], x),
			text_real(list->values[i + 1], value));
	text_add(out, "]");
}
