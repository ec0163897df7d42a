/* The rows of struct config: every key of a config file. */
#ifndef TALUS_CONFIG_TABLE_H
#define TALUS_CONFIG_TABLE_H

#include "config/field.h"
#include "talus/config.h"

extern const struct field_table config_table;

/* config_check.c: what keys say together has to agree. EX_DATAERR with the place. */
int config_check(const struct config *config, const struct field_reader *reader, struct error *err);

#endif
