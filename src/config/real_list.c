/* Lists of configs. Thousands of configs of a campaign share a few lists: each distinct one is kept once,
 * for the life of the process, so that a config is small and still a plain value. */
#include <search.h>
#include <stdlib.h>
#include <string.h>

#include "config/field_parts.h"

static void *kept; /* tree of struct real_list */

static int compare(const void *a, const void *b)
{
	const struct real_list *x = a, *y = b;

	if (x->count != y->count)
		return (x->count > y->count) - (x->count < y->count);
	return x->count ? memcmp(x->values, y->values, (size_t)x->count * sizeof *x->values) : 0;
}

int real_list_keep(struct real_list *list, const double *values, int count, struct error *err)
{
	const struct real_list wanted = {count, values};
	struct real_list **found = tfind(&wanted, &kept, compare);
	size_t bytes = sizeof wanted + (size_t)count * sizeof *values;
	struct real_list *fresh;
	double *copy;

	if (!found) {
		fresh = malloc(bytes);
		if (!fresh)
			return error_memory(err, bytes);
		copy = (double *)(fresh + 1);
		if (count)
			memcpy(copy, values, (size_t)count * sizeof *values);
		*fresh = (struct real_list){count, copy};
		found = tsearch(fresh, &kept, compare);
		if (!found) {
			free(fresh);
			return error_memory(err, bytes);
		}
	}
	*list = **found;
	return 0;
}
