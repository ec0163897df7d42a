/* The rows of struct config: every key of a config file. */
#ifndef TALUS_CONFIG_TABLE_H
#define TALUS_CONFIG_TABLE_H

#include "config/field.h"

extern const struct field_table config_table;

#endif
