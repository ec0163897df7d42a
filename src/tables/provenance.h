/* Which builds and machines made the runs of a table. */
#ifndef TALUS_PROVENANCE_H
#define TALUS_PROVENANCE_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/run_file.h"
#include "talus/text.h"

/* The different values of one thing, in the order in which they were met. */
struct variants {
	char **items; /* [count] */
	size_t count;
};

struct provenance {
	struct variants builds, hosts;
	bool failed; /* out of memory */
};

/* Note what the attributes of a run file say. */
void provenance_add(struct provenance *provenance, struct run_file *file);

/* Lines for below the table; where times are compared, more than one build or machine is flagged. */
void provenance_print(const struct provenance *provenance, bool timing, struct text *out);

void provenance_clean(struct provenance *provenance);

#endif
