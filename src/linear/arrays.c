#include "linear/arrays.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { LINE = 64 }; /* bytes of a cache line */

static size_t whole_lines(size_t bytes)
{
	return (bytes + LINE - 1) / LINE * LINE;
}

/* calloc, not aligned_alloc: what is never used is then never had. */
int arrays_allocate(const struct arrays_part *arrays, void **block, struct error *err)
{
	size_t total = LINE;
	char *next;

	for (const struct arrays_part *array = arrays; array->pointer; array++)
		total += whole_lines(array->bytes);
	TRY(memory_check(total, err));
	*block = calloc(total, 1);
	if (!*block)
		return error_memory(err, total);
	next = *block;
	next += whole_lines((uintptr_t)next) - (uintptr_t)next;
	for (const struct arrays_part *array = arrays; array->pointer; array++) {
		memcpy(array->pointer, &next, sizeof next);
		next += whole_lines(array->bytes);
	}
	return 0;
}
