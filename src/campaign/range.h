/* A range of values: {from: 20 deg, to: 24 deg, steps: 5}, in steps or to be sampled. */
#ifndef TALUS_RANGE_H
#define TALUS_RANGE_H

#include "campaign/reader.h"

struct range {
	double from, to;  /* in the unit */
	const char *unit; /* as written, owned by the node: "" or "deg" */
	int steps;        /* values, both ends among them; 0: to be sampled */
	int scale;        /* enum range_scale */
	bool whole;       /* of a key with whole numbers */
};

enum range_scale { RANGE_LINEAR, RANGE_LOG };

int range_read(const struct reader *reader, const struct leaf *leaf, struct range *out);

/* The value at `share` of the way, 0 to 1, as a scalar at the place of `node` (node_clean); twelve digits,
 * so that 0.1 and 0.2 have 0.3 behind them. */
int range_value(const struct range *range, double share, const struct node *node, struct node *out,
	struct error *err);

/* The keys, for the reference. */
enum { RANGE_KEYS = 4 };
extern const struct reader_key range_keys[RANGE_KEYS];

#endif
