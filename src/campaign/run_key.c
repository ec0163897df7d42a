#include "campaign/run_key.h"

#include <stdlib.h>
#include <string.h>

static int compare(const void *a, const void *b)
{
	const struct run_key *x = a, *y = b;
	int order = strcmp(x->hash, y->hash);

	return order ? order : (x->repeat > y->repeat) - (x->repeat < y->repeat);
}

int run_key_sort(struct experiment *experiment, struct error *err)
{
	free(experiment->keys);
	experiment->keys = calloc(experiment->run_count, sizeof *experiment->keys);
	if (!experiment->keys)
		return error_memory(err, experiment->run_count * sizeof *experiment->keys);
	for (size_t i = 0; i < experiment->run_count; i++)
		experiment->keys[i] =
			(struct run_key){experiment->runs[i].hash, experiment->runs[i].repeat, i};
	qsort(experiment->keys, experiment->run_count, sizeof *experiment->keys, compare);
	return 0;
}

size_t run_key_find(const struct experiment *experiment, const char *hash, int repeat)
{
	const struct run_key *keys = experiment->keys;
	size_t low = 0, high = experiment->run_count, length = strlen(hash);

	while (low < high) { /* the first that does not come before */
		size_t middle = low + (high - low) / 2;
		int order = strncmp(keys[middle].hash, hash, length);

		if (order < 0 || (order == 0 && keys[middle].repeat < repeat))
			low = middle + 1;
		else
			high = middle;
	}
	if (low < experiment->run_count && !strncmp(keys[low].hash, hash, length) &&
		keys[low].repeat == repeat)
		return keys[low].index;
	return experiment->run_count;
}

int run_key_digits(const struct experiment *experiment, int few)
{
	const struct run_key *keys = experiment->keys;

	for (size_t i = 1; i < experiment->run_count; i++)
		if (!strncmp(keys[i - 1].hash, keys[i].hash, (size_t)few) &&
			strcmp(keys[i - 1].hash, keys[i].hash) != 0)
			return CONFIG_HASH_SIZE - 1;
	return few;
}
