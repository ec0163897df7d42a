#include "config/field.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "config/field_parts.h"

const struct field *field_find(const struct field_table *table, const char *key)
{
	for (size_t i = 0; i < table->count; i++)
		if (!strcmp(table->fields[i].name, key))
			return &table->fields[i];
	return NULL;
}

/* The value of the selector. */
static int selected(const struct field_table *table, const void *target)
{
	return *(const int *)((const char *)target + field_find(table, table->selector)->offset);
}

bool field_applies(const struct field_table *table, const struct field *field, const void *target)
{
	return field->flags < FIELD_ONLY(0) || field->flags & FIELD_ONLY(selected(table, target));
}

const char *field_default(
	const struct field_table *table, const struct field *field, const void *target)
{
	return field->values ? field->values[selected(table, target)] : field->value;
}

int field_inapplicable(const struct field_table *table, const struct field *field,
	const void *target, struct error *err)
{
	const struct field *selector = field_find(table, table->selector);
	struct text owners = {0};

	for (int i = 0; selector->choices[i]; i++)
		if (field->flags & FIELD_ONLY(i))
			text_addf(&owners, "%s%s", owners.length ? ", " : "", selector->choices[i]);
	(void)error_set(err, EX_DATAERR, "'%s' is a key of %s: %s, and %s is %s here", field->name,
		selector->name, text_string(&owners), selector->name,
		selector->choices[selected(table, target)]);
	text_clean(&owners);
	return -1;
}

const char *field_leaf(const char *key)
{
	const char *dot = strrchr(key, '.');

	return dot ? dot + 1 : key;
}

int field_depth(const char *key)
{
	int count = 0;

	while ((key = strchr(key, '.')) != NULL) {
		count++;
		key++;
	}
	return count;
}

/* The key that was probably meant: one of the same name elsewhere, or one a few letters off at the same
 * depth; else NULL. */
static const struct field *nearest_key(const struct field_table *table, const char *key)
{
	const struct field *nearest = NULL;
	size_t length = strlen(field_leaf(key));
	int best = length < 6 ? 3 : (int)(length / 3) + 2;

	for (size_t i = 0; i < table->count; i++)
		if (!strcmp(field_leaf(table->fields[i].name), field_leaf(key)))
			return &table->fields[i];
	for (size_t i = 0; i < table->count; i++) {
		const char *name = table->fields[i].name;
		int distance = text_distance(key, name);

		if (field_depth(name) == field_depth(key) && distance < best) {
			best = distance;
			nearest = &table->fields[i];
		}
	}
	return nearest;
}

/* The keys beside `key`, for one that is like none of them. */
static void list_siblings(const struct field_table *table, const char *key, struct text *out)
{
	size_t prefix = (size_t)(field_leaf(key) - key), listed = out->length;

	for (size_t i = 0; i < table->count; i++) {
		const char *name = table->fields[i].name;

		if (field_depth(name) == field_depth(key) && !strncmp(name, key, prefix))
			text_addf(out, "%s%s", out->length > listed ? ", " : "", name + prefix);
	}
	if (out->length == listed && prefix > 0)
		list_siblings(table, "", out);
}

int field_unknown(const struct field_table *table, const char *key, struct error *err)
{
	const struct field *nearest = nearest_key(table, key);
	struct text known = {0};
	char shown[EXCERPT];

	(void)text_excerpt(key, shown, sizeof shown);
	if (nearest)
		return error_set(
			err, EX_DATAERR, "unknown key '%s'; did you mean '%s'?", shown, nearest->name);
	list_siblings(table, key, &known);
	(void)error_set(
		err, EX_DATAERR, "unknown key '%s'; known keys are %s", shown, text_string(&known));
	text_clean(&known);
	return -1;
}

static int set_place(const struct field_source *source, int line, int column, struct error *err)
{
	(void)snprintf(err->file, sizeof err->file, "%s", source->name);
	err->line = source->setting ? 0 : line;
	err->column = source->setting ? 0 : column;
	return -1;
}

int field_set_place(const struct field_source *source, const struct node *node, struct error *err)
{
	return set_place(source, node->line, node->column, err);
}

int field_set_key_place(
	const struct field_source *source, const struct node *node, struct error *err)
{
	return set_place(source, node->key_line, node->key_column, err);
}

static int collect_mapping(struct field_reader *reader, const struct field_source *source,
	const char *prefix, const struct node *mapping, struct error *err)
{
	char key[EXCERPT];

	for (size_t i = 0; i < mapping->count; i++) {
		const struct node *node = &mapping->items[i];

		(void)snprintf(key, sizeof key, "%s%s%s", prefix, *prefix ? "." : "", node->key);
		TRY(field_collect_key(reader, source, key, node, err));
	}
	return 0;
}

int field_collect_key(struct field_reader *reader, const struct field_source *source,
	const char *key, const struct node *value, struct error *err)
{
	const struct field *field = field_find(reader->table, key);
	struct field_place *place;

	if (!field) {
		(void)field_unknown(reader->table, key, err);
		return set_place(source, value->key_line, value->key_column, err);
	}
	if (field->kind == FIELD_GROUP && value->kind != NODE_MAPPING) {
		(void)error_set(
			err, EX_DATAERR, "%s: expected a group of keys, not %s", key, node_kind_name(value));
		return field_set_place(source, value, err);
	}
	if (field->kind == FIELD_GROUP)
		return collect_mapping(reader, source, key, value, err);
	place = &reader->places[field - reader->table->fields];
	if (place->source == source) {
		(void)error_set(err, EX_DATAERR, "duplicate key '%s'; it is already on line %d", key,
			place->node->key_line);
		return set_place(source, value->key_line, value->key_column, err);
	}
	*place = (struct field_place){source, value, ++reader->order};
	return 0;
}

int field_collect(struct field_reader *reader, const struct field_source *source,
	const struct node *mapping, struct error *err)
{
	assert(reader->table->count <= FIELDS_MAX);
	if (!reader->all.source)
		reader->all = (struct field_place){source, mapping, 0};
	if (mapping->kind != NODE_MAPPING) {
		(void)error_set(
			err, EX_DATAERR, "expected a group of keys, not %s", node_kind_name(mapping));
		return field_set_place(source, mapping, err);
	}
	return collect_mapping(reader, source, "", mapping, err);
}

int field_blame(const struct field_reader *reader, const char *key, const char *other, int item,
	struct error *err)
{
	const struct field_table *table = reader->table;
	const struct field_place *place = &reader->places[field_find(table, key) - table->fields];
	const struct node *node;

	if (other) {
		const struct field_place *second =
			&reader->places[field_find(table, other) - table->fields];

		if (second->order > place->order)
			place = second;
	}
	if (!place->source) /* defaults of ours that do not agree with each other */
		return -1;
	node = place->node;
	if (node->kind == NODE_SEQUENCE && item >= 0)
		node = &node->items[item];
	return field_set_place(place->source, node, err);
}
