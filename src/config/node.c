#include <stdlib.h>
#include <string.h>

#include "config/yaml.h"

void node_clean(struct node *node)
{
	for (size_t i = 0; i < node->count; i++)
		node_clean(&node->items[i]);
	free(node->items);
	free(node->text);
	free(node->key);
	*node = (struct node){0};
}

const struct node *node_find(const struct node *mapping, const char *key)
{
	for (size_t i = 0; i < mapping->count; i++)
		if (mapping->items[i].key && !strcmp(mapping->items[i].key, key))
			return &mapping->items[i];
	return NULL;
}

const char *node_kind_name(const struct node *node)
{
	static const char *const names[] = {
		[NODE_SCALAR] = "a single value",
		[NODE_SEQUENCE] = "a list",
		[NODE_MAPPING] = "a group of keys",
	};

	return names[node->kind];
}
