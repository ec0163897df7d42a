/* The 64 bytes behind the HDF5 image of a run file: what a reader asks first, and the digest. */
#ifndef TALUS_TRAILER_H
#define TALUS_TRAILER_H

#include "talus/run_file.h"

enum { TRAILER_SIZE = 64 };

/* The trailer of an image, its digest included. */
void trailer_write(const struct run_summary *summary, const void *image, size_t image_size,
	unsigned char trailer[TRAILER_SIZE]);

/* Read a trailer. False when these bytes are no trailer of a version that is known. */
bool trailer_read(
	const unsigned char trailer[TRAILER_SIZE], struct run_summary *summary, uint64_t *image_size);

/* Whether the digest in the trailer is that of image and trailer. */
bool trailer_matches(
	const unsigned char trailer[TRAILER_SIZE], const void *image, size_t image_size);

#endif
