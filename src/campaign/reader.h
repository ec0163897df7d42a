/* The parts of an experiment file: nodes -> terms, settings, numbers, each refused with its place. */
#ifndef TALUS_READER_H
#define TALUS_READER_H

#include "config/yaml.h"
#include "talus/experiment.h"

struct reader {
	const char *path; /* for messages */
	struct error *err;
};

/* A key of a mapping: its node goes to `read` with the target of the mapping. */
struct reader_key {
	const char *name;
	int (*read)(const struct reader *reader, const struct node *node, void *target);
};

/* EX_DATAERR at the place of a node. Returns -1. */
int reader_fail(const struct reader *reader, const struct node *node, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

/* Every entry of a mapping by its row of `keys`; an unknown one is refused with the nearest. */
int reader_keys(const struct reader *reader, const struct node *node, const struct reader_key *keys,
	size_t count, void *target);

int reader_text(const struct reader *reader, const struct node *node, const char **out);
int reader_integer(
	const struct reader *reader, const struct node *node, int min, int max, int *out);
int reader_bool(const struct reader *reader, const struct node *node, bool *out);

/* The path of a file that the experiment names: a relative one starts at its folder. NULL out of memory. */
char *reader_file(const struct reader *reader, const char *name);

/* One scalar, or a list of them. */
int reader_terms(const struct reader *reader, const struct node *node, struct term_list *out);

/* A leaf of nested mappings with its dotted key. */
struct leaf {
	char *key;
	const struct node *node; /* a scalar or a sequence */
};

struct leaf_list {
	struct leaf *items; /* [count] */
	size_t count;
};

int reader_leaves(const struct reader *reader, const struct node *node, struct leaf_list *out);
void reader_leaves_clean(struct leaf_list *list);

/* A mapping of config keys, each with one value. */
int reader_settings(const struct reader *reader, const struct node *node, struct setting_list *out);

#endif
