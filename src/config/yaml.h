/* YAML as a tree with places (node.c). The only file that calls libyaml is yaml.c. */
#ifndef TALUS_YAML_H
#define TALUS_YAML_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"

enum node_kind { NODE_SCALAR, NODE_SEQUENCE, NODE_MAPPING };

/* A node owns everything below it. Lines and columns count from 1 and point at the value. */
struct node {
	enum node_kind kind;
	int line, column;
	char *text;  /* scalar: its text (a plain empty scalar is ""); else NULL */
	bool quoted; /* scalar: written in quotes or as a block */
	char *key;   /* of this node within its mapping, else NULL */
	int key_line, key_column;
	struct node *items; /* of a sequence or mapping, in order, [count] */
	size_t count;
};

/* Parse one YAML document. `name` stands for the file in messages. Refused (EX_DATAERR with the
 * place): syntax errors, invalid UTF-8, NUL bytes, more than one document, an empty document,
 * anchors, aliases, tags, keys that are not scalars, duplicate keys, nesting deeper than 16, more
 * than 1 MiB of text or 100,000 nodes. Clean with node_clean in every case. */
int yaml_parse(
	struct node *root, const char *text, size_t length, const char *name, struct error *err);

/* The same from a file; a file that cannot be read is EX_DATAERR with the reason. */
int yaml_load(struct node *root, const char *path, struct error *err);

void node_clean(struct node *node);

/* The value of `key` in a mapping, NULL if absent. */
const struct node *node_find(const struct node *mapping, const char *key);

/* "a single value", "a list" or "a group of keys" */
const char *node_kind_name(const struct node *node);

#endif
