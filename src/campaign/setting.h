/* Lists of config keys and the values they get. */
#ifndef TALUS_SETTING_H
#define TALUS_SETTING_H

#include "config/yaml.h"
#include "talus/experiment.h"

/* Add a copy of `key` with the value that `node` writes, and its place. */
int setting_list_add(
	struct setting_list *list, const char *key, const struct node *node, struct error *err);

void setting_list_clean(struct setting_list *list);

#endif
