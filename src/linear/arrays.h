/* The arrays that a method works with, in one block of memory, each from a cache line on: a vector of eight
 * is then never spread over two. */
#ifndef TALUS_ARRAYS_H
#define TALUS_ARRAYS_H

#include <stddef.h>

#include "talus/error.h"

struct arrays_part {
	void *pointer; /* the address of a pointer to its first element */
	size_t bytes;
};

/* An array of `count` elements at `pointer`, as part of a list that ends with {0}. */
#define ARRAY(pointer, count)                                                                      \
	{                                                                                              \
		&(pointer), (count) * sizeof *(pointer)                                                    \
	}

/* Allocate arrays of zeros. `block` is what the caller frees. EX_SOFTWARE out of memory, which
 * leaves *block NULL. */
int arrays_allocate(const struct arrays_part *arrays, void **block, struct error *err);

#endif
