/* An HDF5 image that is being written, in memory. Only image.c and run_file.c call HDF5. */
#ifndef TALUS_IMAGE_H
#define TALUS_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "talus/error.h"

struct image;

/* Begin an image that will hold about `payload` bytes of data. EX_SOFTWARE. */
int image_create(size_t payload, struct image **out, struct error *err);

/* Begin with a copy of the image of a run file, to change its attributes. EX_SOFTWARE. */
int image_reopen(unsigned char *bytes, size_t size, struct image **out, struct error *err);

/* Let HDF5 open a copy of an image. Returns its identifier (hid_t), negative when it is none; EX_SOFTWARE:
 * there is no memory to try. */
int64_t image_open(unsigned char *bytes, size_t size, bool writable, struct error *err);

/* After one of these fails the others do nothing, and image_finish says so. */

/* Attributes of the root; one that exists is replaced. */
void image_text(struct image *image, const char *name, const char *value);
void image_real(struct image *image, const char *name, double value);
void image_whole(struct image *image, const char *name, int value);

void image_group(struct image *image, const char *path);

/* A dataset of doubles. `scales[i]` is the path of the scale of axis i; NULL: a nameless index. */
struct image_data {
	const char *path, *units, *long_name, *standard_name; /* standard_name: NULL: none */
	bool whole;                                           /* stored as 64-bit integers */
	int rank;                                             /* 0: a scalar */
	size_t extent[3];
	const char *scales[3];
	const double *values;
};
void image_dataset(struct image *image, const struct image_data *data);

/* A dimension scale: an axis that datasets can name. */
void image_scale(struct image *image, const struct image_data *data);

/* End: `*bytes` (free) holds the image of `*size` bytes, with `room` more bytes behind it. The image
 * is freed in every case. */
int image_finish(
	struct image *image, size_t room, unsigned char **bytes, size_t *size, struct error *err);

#endif
