#include "config/yaml.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "base/file.h"
#include "talus/text.h"

enum { DEPTH_MAX = 16, NODES_MAX = 100000, BYTES_MAX = 1 << 20, EXCERPT = 80 };

struct loader {
	yaml_parser_t parser;
	const char *name;
	size_t nodes;
	struct error *err;
};

static int refuse(struct loader *loader, yaml_mark_t mark, const char *what)
{
	return error_at(loader->err, EX_DATAERR, loader->name, (int)mark.line + 1, (int)mark.column + 1,
		"%s", what);
}

/* Bytes of the UTF-8 character at `s`, 0 if it is none (too long, a surrogate, beyond U+10FFFF). */
static size_t character_length(const unsigned char *s, size_t left)
{
	size_t count = s[0] < 0x80 ? 1 : s[0] < 0xC2 ? 0 : s[0] < 0xE0 ? 2 : s[0] < 0xF0 ? 3 : 4;

	if (s[0] > 0xF4 || count > left)
		return 0;
	for (size_t i = 1; i < count; i++)
		if ((s[i] & 0xC0) != 0x80)
			return 0;
	if ((s[0] == 0xE0 && s[1] < 0xA0) || (s[0] == 0xED && s[1] > 0x9F) ||
		(s[0] == 0xF0 && s[1] < 0x90) || (s[0] == 0xF4 && s[1] > 0x8F))
		return 0;
	return count;
}

/* libyaml finds bad bytes too, but cannot say where they are. */
static int check_characters(const char *text, size_t length, const char *name, struct error *err)
{
	const unsigned char *s = (const unsigned char *)text;
	int line = 1, column = 1;

	for (size_t i = 0, count; i < length; i += count) {
		count = character_length(s + i, length - i);
		if (!count)
			return error_at(
				err, EX_DATAERR, name, line, column, "byte 0x%02X is not valid UTF-8 text", s[i]);
		if ((s[i] < ' ' && !strchr("\t\n\r", s[i])) || s[i] == 0 || s[i] == 0x7F)
			return error_at(err, EX_DATAERR, name, line, column,
				"control character 0x%02X does not belong in a text file", s[i]);
		column++;
		if (s[i] == '\n' || (s[i] == '\r' && (i + 1 == length || s[i + 1] != '\n'))) {
			line++;
			column = 1;
		}
	}
	return 0;
}

static int parser_failure(struct loader *loader)
{
	const yaml_parser_t *parser = &loader->parser;
	char message[256];

	if (parser->error == YAML_MEMORY_ERROR)
		return error_memory(loader->err, 0);
	(void)snprintf(message, sizeof message, "not valid YAML: %s%s%s",
		parser->context ? parser->context : "", parser->context ? ", " : "",
		parser->problem ? parser->problem : "unknown fault");
	return refuse(loader, parser->problem_mark, message);
}

static int next_event(struct loader *loader, yaml_event_t *event)
{
	if (!yaml_parser_parse(&loader->parser, event))
		return parser_failure(loader);
	return 0;
}

static int copy_scalar(struct loader *loader, const yaml_event_t *event, char **out)
{
	const char *value = (const char *)event->data.scalar.value;

	if (event->data.scalar.anchor)
		return refuse(loader, event->start_mark, "anchors and aliases are not supported");
	if (event->data.scalar.tag)
		return refuse(loader, event->start_mark, "tags are not supported");
	if (strlen(value) != event->data.scalar.length)
		return refuse(loader, event->start_mark, "a NUL character in a text");
	*out = strdup(value);
	return *out ? 0 : error_memory(loader->err, event->data.scalar.length + 1);
}

/* A new last child. The capacity is the next power of two, so it needs no member. */
static struct node *append(struct loader *loader, struct node *parent, yaml_mark_t mark)
{
	struct node *items = parent->items;

	if (++loader->nodes > NODES_MAX) {
		(void)refuse(loader, mark, "more than 100000 values");
		return NULL;
	}
	if ((parent->count & (parent->count - 1)) == 0) {
		size_t bytes = (parent->count ? 2 * parent->count : 1) * sizeof *items;

		items = realloc(items, bytes);
		if (!items) {
			(void)error_memory(loader->err, bytes);
			return NULL;
		}
		parent->items = items;
	}
	items[parent->count] = (struct node){0};
	return &items[parent->count++];
}

struct key {
	const struct node *node;
};

static int compare_keys(const void *a, const void *b)
{
	const struct node *x = ((const struct key *)a)->node, *y = ((const struct key *)b)->node;
	int order = strcmp(x->key, y->key);

	return order ? order : (x > y) - (x < y);
}

/* Sorted, so that a file of 100,000 keys is no trap. The first repetition in the text is reported. */
static int check_duplicates(struct loader *loader, const struct node *mapping)
{
	const struct node *first = NULL, *again = NULL;
	struct key *sorted;
	char shown[EXCERPT];

	if (mapping->count < 2)
		return 0;
	sorted = malloc(mapping->count * sizeof *sorted);
	if (!sorted)
		return error_memory(loader->err, mapping->count * sizeof *sorted);
	for (size_t i = 0; i < mapping->count; i++)
		sorted[i].node = &mapping->items[i];
	qsort(sorted, mapping->count, sizeof *sorted, compare_keys);
	for (size_t i = 1; i < mapping->count; i++)
		if (!strcmp(sorted[i - 1].node->key, sorted[i].node->key) &&
			(!again || sorted[i].node < again)) {
			first = sorted[i - 1].node;
			again = sorted[i].node;
		}
	free(sorted);
	if (!again)
		return 0;
	return error_at(loader->err, EX_DATAERR, loader->name, again->key_line, again->key_column,
		"duplicate key '%s'; it is already on line %d",
		text_excerpt(again->key, shown, sizeof shown), first->key_line);
}

static int read_node(
	struct loader *loader, const yaml_event_t *event, struct node *node, int depth);

/* `event` is the key; the value follows. */
static int read_pair(struct loader *loader, const yaml_event_t *event, struct node *node, int depth)
{
	yaml_event_t value;
	int status;

	if (event->type == YAML_ALIAS_EVENT)
		return refuse(loader, event->start_mark, "anchors and aliases are not supported");
	if (event->type != YAML_SCALAR_EVENT)
		return refuse(loader, event->start_mark, "a key must be a plain word");
	node->key_line = (int)event->start_mark.line + 1;
	node->key_column = (int)event->start_mark.column + 1;
	TRY(copy_scalar(loader, event, &node->key));
	TRY(next_event(loader, &value));
	status = read_node(loader, &value, node, depth);
	yaml_event_delete(&value);
	return status;
}

static int read_children(struct loader *loader, struct node *parent, int depth)
{
	for (;;) {
		yaml_event_t event;
		struct node *child = NULL;
		int status = -1;
		bool end;

		TRY(next_event(loader, &event));
		end = event.type == YAML_SEQUENCE_END_EVENT || event.type == YAML_MAPPING_END_EVENT;
		if (!end)
			child = append(loader, parent, event.start_mark);
		if (child && parent->kind == NODE_MAPPING)
			status = read_pair(loader, &event, child, depth);
		else if (child)
			status = read_node(loader, &event, child, depth);
		yaml_event_delete(&event);
		if (end)
			return parent->kind == NODE_MAPPING ? check_duplicates(loader, parent) : 0;
		TRY(status);
	}
}

/* Fill `node`, whose first event is `event`. The caller deletes the event. */
static int read_node(struct loader *loader, const yaml_event_t *event, struct node *node, int depth)
{
	const yaml_char_t *anchor = NULL, *tag = NULL;

	node->line = (int)event->start_mark.line + 1;
	node->column = (int)event->start_mark.column + 1;
	switch (event->type) {
	case YAML_SCALAR_EVENT:
		node->kind = NODE_SCALAR;
		node->quoted = event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
		return copy_scalar(loader, event, &node->text);
	case YAML_SEQUENCE_START_EVENT:
		node->kind = NODE_SEQUENCE;
		anchor = event->data.sequence_start.anchor;
		tag = event->data.sequence_start.tag;
		break;
	case YAML_MAPPING_START_EVENT:
		node->kind = NODE_MAPPING;
		anchor = event->data.mapping_start.anchor;
		tag = event->data.mapping_start.tag;
		break;
	default:
		return refuse(loader, event->start_mark, "anchors and aliases are not supported");
	}
	if (anchor)
		return refuse(loader, event->start_mark, "anchors and aliases are not supported");
	if (tag)
		return refuse(loader, event->start_mark, "tags are not supported");
	if (depth == DEPTH_MAX)
		return refuse(loader, event->start_mark, "nested deeper than 16 levels");
	return read_children(loader, node, depth + 1);
}

/* The stream: start, one document, end. */
static int read_document(struct loader *loader, struct node *root)
{
	yaml_event_t event;
	yaml_event_type_t type = YAML_NO_EVENT;
	yaml_mark_t start;
	bool seen = false;
	int status = 0;

	while (status == 0 && type != YAML_STREAM_END_EVENT) {
		TRY(next_event(loader, &event));
		type = event.type;
		start = event.start_mark;
		if (type == YAML_DOCUMENT_START_EVENT && seen) {
			status = refuse(loader, start, "a second document; one file holds one");
		} else if (type != YAML_STREAM_START_EVENT && type != YAML_STREAM_END_EVENT &&
				   type != YAML_DOCUMENT_START_EVENT && type != YAML_DOCUMENT_END_EVENT) {
			seen = true;
			status = read_node(loader, &event, root, 0);
		}
		yaml_event_delete(&event);
	}
	if (status == 0 && (!seen || (root->kind == NODE_SCALAR && !root->quoted && !*root->text)))
		return error_at(loader->err, EX_DATAERR, loader->name, 1, 1, "the document is empty");
	return status;
}

int yaml_parse(
	struct node *root, const char *text, size_t length, const char *name, struct error *err)
{
	static const char mark[] = "\xEF\xBB\xBF"; /* which some editors put before UTF-8 */
	struct loader loader = {.name = name, .err = err};
	int status;

	*root = (struct node){0};
	if (length >= sizeof mark - 1 && !memcmp(text, mark, sizeof mark - 1)) {
		text += sizeof mark - 1;
		length -= sizeof mark - 1;
	}
	if (length > BYTES_MAX)
		return error_at(err, EX_DATAERR, name, 0, 0, "more than 1 MiB of text");
	TRY(check_characters(text, length, name, err));
	if (!yaml_parser_initialize(&loader.parser))
		return error_memory(err, 0);
	yaml_parser_set_encoding(&loader.parser, YAML_UTF8_ENCODING);
	yaml_parser_set_input_string(&loader.parser, (const unsigned char *)text, length);
	status = read_document(&loader, root);
	yaml_parser_delete(&loader.parser);
	return status;
}

int yaml_load(struct node *root, const char *path, struct error *err)
{
	char *text = malloc(BYTES_MAX + 1);
	ssize_t length;
	int status = -1;

	*root = (struct node){0};
	if (!text)
		return error_memory(err, BYTES_MAX + 1);
	length = file_read_text(path, text, BYTES_MAX + 1);
	if (length < 0)
		(void)error_at(err, EX_DATAERR, path, 0, 0, "cannot be read: %s", strerror(errno));
	else
		status = yaml_parse(root, text, (size_t)length, path, err);
	free(text);
	return status;
}
