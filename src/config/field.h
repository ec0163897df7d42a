/* Field tables: one row per parameter of a struct feeds reading, range checks, messages, settings,
 * printing, reference, hash and differences. A new parameter is one new row. */
#ifndef TALUS_FIELD_H
#define TALUS_FIELD_H

#include <stdbool.h>
#include <stddef.h>

#include "config/yaml.h"
#include "talus/error.h"
#include "talus/text.h"

enum field_kind {
	FIELD_GROUP,   /* no member: the mapping that holds the keys "NAME.x", which follow at once */
	FIELD_REAL,    /* double */
	FIELD_INTEGER, /* int */
	FIELD_CHOICE,  /* int: index in `choices` */
	FIELD_REALS,   /* struct real_list, strictly increasing */
	FIELD_POINTS,  /* struct real_list of x, value, x, value, x strictly increasing */
};

enum {
	FIELD_REQUIRED = 1, /* without a default */
	FIELD_PASSIVE = 2,  /* cannot change numbers: outside hash and differences */
	FIELD_LEADING = 4,  /* of the keys that tell a reader at once what this is */
	FIELD_UNSORTED = 8, /* of reals: in any order */
};

/* A row that applies only where the table's selector has choice `i`, or one of several, or-ed. */
#define FIELD_ONLY(i) (1 << (8 + (i)))

struct field {
	const char *name; /* dotted key, "domain.cells" */
	enum field_kind kind;
	int flags;
	size_t offset;     /* of the member within the struct */
	const char *unit;  /* of reals: SI unit (quantity.h), "1" for a plain number */
	const char *value; /* default, as in YAML; of a required key an example; of lists "[]" */
	const char *range; /* "[0 deg, 90 deg)", "(0, inf)", NULL: any; of reals each value */
	const char *const *choices; /* names, closed by NULL */
	const char *meaning;        /* one line */
	/* Defaults by choice of the table's selector, where they differ; NULL: `value` is that of all. */
	const char *const *values;
};

struct field_table {
	const struct field *fields;
	size_t count; /* at most FIELDS_MAX */
	/* The choice whose value says which rows apply; NULL: all do. A row that does not apply takes its
	 * default, is refused where it is given, and is neither printed nor compared. */
	const char *selector;
};

enum { FIELDS_MAX = 128 };

/* A YAML tree that values come from. */
struct field_source {
	const char *name; /* file, or "--set key=value" */
	bool setting;     /* its lines and columns mean nothing to the user */
	struct node root;
};

/* Reading happens in two steps: field_collect finds the node of every key, over any number of
 * sources of which a later one wins; field_convert turns the nodes into values. */
struct field_reader {
	const struct field_table *table;
	struct field_place {
		const struct field_source *source; /* NULL: the default holds */
		const struct node *node;
		size_t order; /* counts up with the reading */
	} places[FIELDS_MAX];
	struct field_place all; /* the mapping first collected: where a key is missing */
	size_t order;
};

/* Note the keys of `mapping`, a node of `source`. A dotted key stands for nested ones. Sources must live
 * as long as the reader. EX_DATAERR: not a mapping, unknown or repeated key, a group that is no mapping. */
int field_collect(struct field_reader *reader, const struct field_source *source,
	const struct node *mapping, struct error *err);

/* Note one value of the dotted `key`, as field_collect does. */
int field_collect_key(struct field_reader *reader, const struct field_source *source,
	const char *key, const struct node *value, struct error *err);

/* Fill the struct at `target`; keys that were not collected take their defaults. EX_DATAERR with the
 * place: missing required key, wrong kind of node, bad number or unit, out of range, unknown choice. */
int field_convert(const struct field_reader *reader, void *target, struct error *err);

/* Give an error that is set the place of that of two keys which was read later (`other` may be NULL).
 * `item` >= 0 points into a list. Returns -1. */
int field_blame(const struct field_reader *reader, const char *key, const char *other, int item,
	struct error *err);

/* The row of a dotted key, NULL if there is none. */
const struct field *field_find(const struct field_table *table, const char *key);

/* Does the row apply to the struct at `target`? */
bool field_applies(const struct field_table *table, const struct field *field, const void *target);

/* "domain.cells is a key of model: dry, and here model is immersed" as EX_DATAERR without a place.
 * Returns -1. */
int field_inapplicable(const struct field_table *table, const struct field *field,
	const void *target, struct error *err);

/* "unknown key 'layer'; did you mean 'layers'?" as EX_DATAERR without a place. Returns -1. */
int field_unknown(const struct field_table *table, const char *key, struct error *err);

/* One value as YAML in SI, as field_convert reads it back to the same bits. */
void field_print_value(const struct field *field, const void *target, struct text *out);

/* Every key that applies as nested YAML, without the passive ones where `active_only`. */
void field_print(
	const struct field_table *table, const void *target, bool active_only, struct text *out);

/* Every key that applies to the defaults at `target` with meaning, unit, range or choices, and
 * default: YAML that reads as the defaults. */
void field_print_reference(const struct field_table *table, const void *target, struct text *out);

/* One line per active key of both that differs: "layers: 10 -> 20". */
void field_differences(
	const struct field_table *table, const void *a, const void *b, struct text *out);

#endif
