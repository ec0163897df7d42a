/* Sampled designs: points spread over the unit cube, the same ones for the same seed on every machine. */
#ifndef TALUS_SAMPLE_H
#define TALUS_SAMPLE_H

#include "campaign/reader.h"

struct sample {
	int method; /* enum sample_method */
	int points, seed;
};

enum sample_method { SAMPLE_LATIN_HYPERCUBE, SAMPLE_SOBOL };

int sample_read(const struct reader *reader, const struct node *node, struct sample *out);

/* Fill values[points][dimensions], each in [0, 1). EX_SOFTWARE; EX_DATAERR at the place of `node` where the
 * method has not so many dimensions. */
int sample_draw(const struct reader *reader, const struct node *node, const struct sample *sample,
	size_t dimensions, double *values);

/* The keys, for the reference. */
enum { SAMPLE_KEYS = 3 };
extern const struct reader_key sample_keys[SAMPLE_KEYS];

#endif
