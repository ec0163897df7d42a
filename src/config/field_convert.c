#include <assert.h>
#include <string.h>

#include "config/field_parts.h"
#include "config/quantity.h"
#include "talus/config.h"

static int convert_real(
	const struct field *field, const char *text, double *value, struct error *err)
{
	char shown[EXCERPT];

	TRY(quantity_read(text, field->unit, value, err));
	return field_check_range(field, text_excerpt(text, shown, sizeof shown), *value, err);
}

static int convert_integer(
	const struct field *field, const char *text, int *value, struct error *err)
{
	char shown[EXCERPT];
	size_t sign = *text == '-' || *text == '+';

	(void)text_excerpt(text, shown, sizeof shown);
	if (!*text)
		return error_set(err, EX_DATAERR, "the value is missing");
	if (text_to_integer(text, value))
		return field_check_range(field, shown, *value, err);
	if (text[sign] && !text[sign + strspn(text + sign, "0123456789")])
		return error_set(err, EX_DATAERR, "%s is beyond what an integer can hold", shown);
	return error_set(err, EX_DATAERR, "%s is not a whole number", shown);
}

static int convert_choice(
	const struct field *field, const char *text, int *value, struct error *err)
{
	struct text hint = {0};
	char shown[EXCERPT];
	const char *nearest = NULL;
	int best = (int)strlen(text) / 3 + 2;

	if (!*text)
		return error_set(err, EX_DATAERR, "the value is missing");
	for (int i = 0; field->choices[i]; i++) {
		int distance = text_distance(text, field->choices[i]);

		if (distance == 0) {
			*value = i;
			return 0;
		}
		if (distance < best) {
			best = distance;
			nearest = field->choices[i];
		}
	}
	field_list_choices(field, &hint);
	if (nearest)
		text_addf(&hint, "; did you mean '%s'?", nearest);
	(void)error_set(err, EX_DATAERR, "'%s' is not one of %s",
		text_excerpt(text, shown, sizeof shown), text_string(&hint));
	text_clean(&hint);
	return -1;
}

static int convert_list(const struct field *field, const struct field_place *place,
	struct real_list *list, struct error *err)
{
	const struct node *node = place->node;
	double values[REAL_LIST_MAX] = {0};

	if (node->kind != NODE_SEQUENCE)
		return error_set(
			err, EX_DATAERR, "expected a list such as [1, 2], not %s", node_kind_name(node));
	if (node->count > REAL_LIST_MAX)
		return error_set(
			err, EX_DATAERR, "a list of %zu values; at most %d fit", node->count, REAL_LIST_MAX);
	for (size_t i = 0; i < node->count; i++) {
		const struct node *item = &node->items[i];
		char shown[EXCERPT];

		if (item->kind != NODE_SCALAR)
			(void)error_set(
				err, EX_DATAERR, "expected a single value, not %s", node_kind_name(item));
		else if (convert_real(field, item->text, &values[i], err) == 0 && i > 0 &&
				 !(field->flags & FIELD_UNSORTED) && values[i] <= values[i - 1])
			(void)error_set(err, EX_DATAERR, "%s is not above the value before it",
				text_excerpt(item->text, shown, sizeof shown));
		if (err->code)
			return field_set_place(place->source, item, err);
	}
	return real_list_keep(list, values, (int)node->count, err);
}

/* `file` is the config file. */
static int convert_value(const struct field *field, const struct field_place *place,
	const char *file, void *member, struct error *err)
{
	const struct node *node = place->node;

	if (field->kind == FIELD_REALS)
		return convert_list(field, place, member, err);
	if (field->kind == FIELD_POINTS)
		return points_convert(field, place, file, member, err);
	if (node->kind != NODE_SCALAR)
		return error_set(err, EX_DATAERR, "expected a single value, not %s", node_kind_name(node));
	switch (field->kind) {
	case FIELD_REAL:
		return convert_real(field, node->text, member, err);
	case FIELD_INTEGER:
		return convert_integer(field, node->text, member, err);
	default:
		return convert_choice(field, node->text, member, err);
	}
}

/* The default of a row as the node that a file would hold. */
static int convert_default(
	const struct field_table *table, const struct field *field, void *target, struct error *err)
{
	struct node node = {.kind = NODE_SCALAR, .text = (char *)field_default(table, field, target)};
	struct field_place place = {.node = &node};

	if (field->kind == FIELD_REALS || field->kind == FIELD_POINTS) {
		assert(!strcmp(field->value, "[]"));
		node = (struct node){.kind = NODE_SEQUENCE};
	}
	return convert_value(field, &place, "", (char *)target + field->offset, err);
}

/* One row: from its place, or its default. */
static int convert_field(
	const struct field_reader *reader, const struct field *field, void *target, struct error *err)
{
	const struct field_place *place = &reader->places[field - reader->table->fields];

	if (!place->source)
		return convert_default(reader->table, field, target, err);
	if (convert_value(
			field, place, reader->all.source->name, (char *)target + field->offset, err) == 0)
		return 0;
	(void)error_context(err, "%s", field->name);
	return err->file[0] ? -1 : field_set_place(place->source, place->node, err);
}

/* Refuse a key that is given and does not apply, and miss one that is required and does. */
static int check_presence(const struct field_reader *reader, const struct field *field,
	const void *target, struct error *err)
{
	const struct field_place *place = &reader->places[field - reader->table->fields];
	bool applies = field_applies(reader->table, field, target);

	if (place->source && !applies) {
		(void)field_inapplicable(reader->table, field, target, err);
		return field_set_key_place(place->source, place->node, err);
	}
	if (!place->source && applies && field->flags & FIELD_REQUIRED) {
		(void)error_set(err, EX_DATAERR, "missing key '%s'; for example `%s: %s`", field->name,
			field->name, field->value);
		return field_set_place(reader->all.source, reader->all.node, err);
	}
	return 0;
}

int field_convert(const struct field_reader *reader, void *target, struct error *err)
{
	const struct field_table *table = reader->table;

	if (table->selector)
		TRY(convert_field(reader, field_find(table, table->selector), target, err));
	for (size_t i = 0; i < table->count; i++) {
		if (table->fields[i].kind == FIELD_GROUP)
			continue;
		TRY(check_presence(reader, &table->fields[i], target, err));
		TRY(convert_field(reader, &table->fields[i], target, err));
	}
	return 0;
}
