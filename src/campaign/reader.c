#include "campaign/reader.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/setting.h"
#include "talus/text.h"

enum { EXCERPT = 80 }; /* bytes of a value shown in a message */

int reader_fail(const struct reader *reader, const struct node *node, const char *format, ...)
{
	char message[1024];
	va_list args;

	va_start(args, format);
	(void)vsnprintf(message, sizeof message, format, args);
	va_end(args);
	return error_at(reader->err, EX_DATAERR, reader->path, node->line, node->column, "%s%s%s",
		node->key ? node->key : "", node->key ? ": " : "", message);
}

static int unknown_key(const struct reader *reader, const struct node *item,
	const struct reader_key *keys, size_t count)
{
	int best = (int)strlen(item->key) / 3 + 2;
	const char *nearest = NULL;
	struct text known = {0};
	char shown[EXCERPT];

	for (size_t i = 0; i < count; i++) {
		int distance = text_distance(item->key, keys[i].name);

		text_addf(&known, "%s%s", i ? ", " : "", keys[i].name);
		if (distance < best) {
			best = distance;
			nearest = keys[i].name;
		}
	}
	(void)text_excerpt(item->key, shown, sizeof shown);
	if (nearest)
		error_at(reader->err, EX_DATAERR, reader->path, item->key_line, item->key_column,
			"unknown key '%s'; did you mean '%s'?", shown, nearest);
	else
		error_at(reader->err, EX_DATAERR, reader->path, item->key_line, item->key_column,
			"unknown key '%s'; known are: %s", shown, text_string(&known));
	text_clean(&known);
	return -1;
}

int reader_keys(const struct reader *reader, const struct node *node, const struct reader_key *keys,
	size_t count, void *target)
{
	if (node->kind != NODE_MAPPING)
		return reader_fail(reader, node, "a mapping of keys is wanted here");
	for (size_t i = 0; i < node->count; i++) {
		const struct node *item = &node->items[i];
		size_t k = 0;

		while (k < count && strcmp(item->key, keys[k].name) != 0)
			k++;
		if (k == count)
			return unknown_key(reader, item, keys, count);
		TRY(keys[k].read(reader, item, target));
	}
	return 0;
}

void reader_reference(
	struct text *out, const char *title, const struct reader_key *keys, size_t count)
{
	text_addf(out, "\n## %s\n\n| key | meaning |\n| --- | --- |\n", title);
	for (size_t i = 0; i < count; i++)
		text_addf(out, "| `%s` | %s |\n", keys[i].name, keys[i].meaning);
}

int reader_text(const struct reader *reader, const struct node *node, const char **out)
{
	if (node->kind != NODE_SCALAR || !node->text[0])
		return reader_fail(reader, node, "one text is wanted here");
	for (size_t i = strlen(node->text); i > 1 && strchr(" \t\n", node->text[i - 1]); i--)
		node->text[i - 1] = '\0';
	for (char *c = node->text; *c; c++)
		if (*c == '\n' || *c == '\t')
			*c = ' ';
		else if ((unsigned char)*c < ' ' || *c == 0x7F)
			return reader_fail(reader, node, "a control character does not belong here");
	*out = node->text;
	return 0;
}

static const char *excerpt(const struct node *node, char shown[EXCERPT])
{
	return node->kind == NODE_SCALAR ? text_excerpt(node->text, shown, EXCERPT)
									 : node_kind_name(node);
}

int reader_integer(const struct reader *reader, const struct node *node, int min, int max, int *out)
{
	char shown[EXCERPT];

	if (node->kind != NODE_SCALAR || !text_to_integer(node->text, out) || *out < min || *out > max)
		return reader_fail(
			reader, node, "%s is not a whole number from %d to %d", excerpt(node, shown), min, max);
	return 0;
}

int reader_choice(
	const struct reader *reader, const struct node *node, const char *const *choices, int *out)
{
	struct text known = {0};
	char shown[EXCERPT];
	int result = 0, i = 0;

	while (choices[i] && (node->kind != NODE_SCALAR || strcmp(node->text, choices[i]) != 0)) {
		text_addf(&known, "%s%s", i ? ", " : "", choices[i]);
		i++;
	}
	*out = i;
	if (!choices[i])
		result = reader_fail(
			reader, node, "%s is not one of %s", excerpt(node, shown), text_string(&known));
	text_clean(&known);
	return result;
}

int reader_bool(const struct reader *reader, const struct node *node, bool *out)
{
	char shown[EXCERPT];
	bool yes = node->kind == NODE_SCALAR && !strcmp(node->text, "true");

	if (!yes && (node->kind != NODE_SCALAR || strcmp(node->text, "false") != 0))
		return reader_fail(reader, node, "%s is neither true nor false", excerpt(node, shown));
	*out = yes;
	return 0;
}

char *reader_file(const struct reader *reader, const char *name)
{
	const char *slash = strrchr(reader->path, '/');
	int folder = name[0] != '/' && slash ? (int)(slash + 1 - reader->path) : 0;
	char *path;

	return asprintf(&path, "%.*s%s", folder, reader->path, name) < 0 ? NULL : path;
}

int reader_terms(const struct reader *reader, const struct node *node, struct term_list *out)
{
	const struct node *items = node->kind == NODE_SEQUENCE ? node->items : node;
	size_t count = node->kind == NODE_SEQUENCE ? node->count : 1;

	out->items = calloc(count ? count : 1, sizeof *out->items);
	if (!out->items)
		return error_memory(reader->err, count * sizeof *out->items);
	for (size_t i = 0; i < count; i++) {
		struct term *term = &out->items[i];

		if (items[i].kind != NODE_SCALAR || !items[i].text[0])
			return reader_fail(reader, node, "one text or a list of them is wanted here");
		*term = (struct term){items[i].text, items[i].line, items[i].column};
		for (size_t k = 0; k < i; k++)
			if (!strcmp(out->items[k].text, term->text))
				return reader_fail(reader, node, "%s stands here twice", term->text);
	}
	out->count = count;
	return 0;
}

/* Refuse a key that no config has, or that the list has already. */
static int check_key(const struct reader *reader, const struct leaf_list *list, const char *key,
	const struct node *node)
{
	struct error refusal = {0};

	if (config_check_key(key, &refusal))
		return error_at(reader->err, refusal.code, reader->path, node->key_line, node->key_column,
			"%s", refusal.text);
	for (size_t i = 0; i < list->count; i++)
		if (!strcmp(list->items[i].key, key))
			return error_at(reader->err, EX_DATAERR, reader->path, node->key_line, node->key_column,
				"duplicate key '%s'", key);
	return 0;
}

/* A value, a mapping that says how values are made, or a list of values or of lists of them (several values
 * of a key that is a list itself, such as of points). */
static int check_value(const struct reader *reader, const struct node *node, int depth)
{
	if (node->kind == NODE_MAPPING && !depth)
		return 0;
	if (node->kind == NODE_MAPPING || (node->kind == NODE_SEQUENCE && depth == 3))
		return reader_fail(reader, node, "a value is wanted here, not %s", node_kind_name(node));
	for (size_t i = 0; i < node->count; i++)
		TRY(check_value(reader, &node->items[i], depth + 1));
	return 0;
}

/* Takes `key` over. */
static int leaf_add(
	const struct reader *reader, struct leaf_list *list, char *key, const struct node *node)
{
	struct leaf *items;

	if (check_key(reader, list, key, node) || check_value(reader, node, 0)) {
		free(key);
		return -1;
	}
	items = realloc(list->items, (list->count + 1) * sizeof *items);
	if (!items) {
		free(key);
		return error_memory(reader->err, (list->count + 1) * sizeof *items);
	}
	list->items = items;
	items[list->count++] = (struct leaf){key, node};
	return 0;
}

static int add_leaves(
	const struct reader *reader, const struct node *node, const char *prefix, struct leaf_list *out)
{
	for (size_t i = 0; i < node->count; i++) {
		const struct node *item = &node->items[i];
		char *key;
		int result;

		if (asprintf(&key, "%s%s%s", prefix, *prefix ? "." : "", item->key) < 0)
			return error_memory(reader->err, strlen(prefix) + strlen(item->key));
		if (item->kind != NODE_MAPPING || config_is_key(key)) {
			TRY(leaf_add(reader, out, key, item));
			continue;
		}
		result = add_leaves(reader, item, key, out);
		free(key);
		TRY(result);
	}
	return 0;
}

int reader_leaves(const struct reader *reader, const struct node *node, struct leaf_list *out)
{
	if (node->kind != NODE_MAPPING)
		return reader_fail(reader, node, "a mapping of config keys is wanted here");
	return add_leaves(reader, node, "", out);
}

void reader_leaves_clean(struct leaf_list *list)
{
	for (size_t i = 0; i < list->count; i++)
		free(list->items[i].key);
	free(list->items);
	*list = (struct leaf_list){0};
}

int reader_settings(const struct reader *reader, const struct node *node, struct setting_list *out)
{
	struct leaf_list leaves = {0};
	int result = -1;

	if (reader_leaves(reader, node, &leaves))
		goto done;
	for (size_t i = 0; i < leaves.count; i++) {
		const struct leaf *leaf = &leaves.items[i];

		if (leaf->node->kind == NODE_MAPPING) {
			reader_fail(reader, leaf->node, "one value is wanted here; ranges belong into runs");
			goto done;
		}
		if (setting_list_add(out, leaf->key, leaf->node, reader->err))
			goto done;
	}
	result = 0;
done:
	reader_leaves_clean(&leaves);
	return result;
}
