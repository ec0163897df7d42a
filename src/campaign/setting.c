#include "campaign/setting.h"

#include <stdlib.h>
#include <string.h>

#include "talus/text.h"

/* The text that config_parse reads after "key=". */
static void add_value(struct text *out, const struct node *node)
{
	if (node->kind == NODE_SCALAR) {
		text_add(out, node->text);
		return;
	}
	text_add(out, "[");
	for (size_t i = 0; i < node->count; i++) {
		text_add(out, i ? ", " : "");
		add_value(out, &node->items[i]);
	}
	text_add(out, "]");
}

int setting_list_add(
	struct setting_list *list, const char *key, const struct node *node, struct error *err)
{
	struct setting *items = realloc(list->items, (list->count + 1) * sizeof *items);
	struct text value = {0};

	if (!items)
		return error_memory(err, (list->count + 1) * sizeof *items);
	list->items = items;
	text_add(&value, "");
	add_value(&value, node);
	items += list->count;
	*items = (struct setting){strdup(key), value.data, node->line, node->column};
	list->count++;
	return items->key && !value.failed ? 0 : error_memory(err, strlen(key) + value.length);
}

void setting_list_clean(struct setting_list *list)
{
	for (size_t i = 0; i < list->count; i++) {
		free(list->items[i].key);
		free(list->items[i].value);
	}
	free(list->items);
	*list = (struct setting_list){0};
}
