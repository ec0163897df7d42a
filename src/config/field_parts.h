/* What the files of the field tables share among themselves: field.c, field_convert.c, field_print.c, points.c,
 * real_list.c. */
#ifndef TALUS_FIELD_PARTS_H
#define TALUS_FIELD_PARTS_H

#include "config/field.h"
#include "talus/config.h"

enum { EXCERPT = 80 }; /* bytes of a user's text that a message shows */

/* The key without its groups, and how many groups it stands in. */
const char *field_leaf(const char *key);
int field_depth(const char *key);

/* The default of a row, by the selector's value in the struct at `target`. */
const char *field_default(
	const struct field_table *table, const struct field *field, const void *target);

/* Give an error that is set the place of a node. Returns -1. */
int field_set_place(const struct field_source *source, const struct node *node, struct error *err);

/* The same for the place of its key. */
int field_set_key_place(
	const struct field_source *source, const struct node *node, struct error *err);

/* "dry, immersed" */
void field_list_choices(const struct field *field, struct text *out);

/* Refuse a value that is outside the range of a row; `shown` is its text. */
int field_check_range(
	const struct field *field, const char *shown, double value, struct error *err);

/* "above 0 m and at most 1 m" */
void field_describe_range(const struct field *field, struct text *out);

/* real_list.c: make `list` these numbers, of which a copy is kept once for all lists. EX_SOFTWARE. */
int real_list_keep(struct real_list *list, const double *values, int count, struct error *err);

/* points.c: the points that a node lists, or that the file it names holds; `beside` is the config file, to
 * whose folder a name is relative. EX_DATAERR with the place in that file, or none. */
int points_convert(const struct field *field, const struct field_place *place, const char *beside,
	struct real_list *list, struct error *err);

/* "[[0, 1], [0.5, 2]]" */
void points_print(const struct real_list *list, struct text *out);

#endif
