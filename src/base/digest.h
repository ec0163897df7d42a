/* A digest that tells damaged bytes from good ones (not one against forgery). */
#ifndef TALUS_DIGEST_H
#define TALUS_DIGEST_H

#include <stddef.h>

enum { DIGEST_SIZE = 16 };

/* XXH3-128, in its canonical byte order, of `a` followed by `b`. */
void digest_of_two(
	const void *a, size_t a_size, const void *b, size_t b_size, unsigned char digest[DIGEST_SIZE]);

#endif
