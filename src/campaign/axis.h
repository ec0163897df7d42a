/* The axes of an entry of `runs`: what each stands for is multiplied by the others. */
#ifndef TALUS_AXIS_H
#define TALUS_AXIS_H

#include "campaign/reader.h"

/* Keys that change together: one key with a list or range of values, a zip, or a sampled design. */
struct axis {
	struct leaf *leaves; /* [width] */
	size_t width;
	struct node *values; /* [count][width], scalars or lists; cleaned with the axis */
	size_t count, chosen;
	bool sampled;
};

struct axis_list {
	struct axis *items; /* [count], in order: the last is the fastest */
	size_t count;
	struct leaf_list leaves;
};

/* The axes of `entry`: config keys with a value, a list of values or a range {from, to, steps}; `zip`, a
 * mapping of such keys that run in step; `sample`, a design for the ranges without steps. Clean in every
 * case. EX_DATAERR with the place. */
int axis_list_read(const struct reader *reader, const struct node *entry, struct axis_list *out);
void axis_list_clean(struct axis_list *list);

#endif
