/* Finding the runs of an experiment by hash, among thousands. */
#ifndef TALUS_RUN_KEY_H
#define TALUS_RUN_KEY_H

#include "talus/experiment.h"

struct run_key {
	const char *hash; /* of the run */
	int repeat;
	size_t index;
};

/* Fill experiment->keys. EX_SOFTWARE. */
int run_key_sort(struct experiment *experiment, struct error *err);

/* The index of the run whose hash begins so; run_count if there is none. */
size_t run_key_find(const struct experiment *experiment, const char *hash, int repeat);

/* How many digits of the hashes tell all runs apart: `few` if those do, else all. */
int run_key_digits(const struct experiment *experiment, int few);

#endif
