#include "campaign/sample.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_qrng.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

static int read_method(const struct reader *reader, const struct node *node, void *target)
{
	static const char *const names[] = {
		[SAMPLE_LATIN_HYPERCUBE] = "latin-hypercube", [SAMPLE_SOBOL] = "sobol", NULL};

	return reader_choice(reader, node, names, &((struct sample *)target)->method);
}

static int read_points(const struct reader *reader, const struct node *node, void *target)
{
	return reader_integer(reader, node, 1, EXPERIMENT_RUNS_MAX, &((struct sample *)target)->points);
}

static int read_seed(const struct reader *reader, const struct node *node, void *target)
{
	return reader_integer(reader, node, 1, INT_MAX, &((struct sample *)target)->seed);
}

const struct reader_key sample_keys[SAMPLE_KEYS] = {
	{"method", read_method,
		"latin-hypercube: each of `points` equal parts of a range has one point; "
		"sobol: a sequence that goes on with more points (default: latin-hypercube)"},
	{"points", read_points, "how many; required"},
	{"seed", read_seed, "another whole number above 0, other points (default: 1)"},
};

int sample_read(const struct reader *reader, const struct node *node, struct sample *out)
{
	*out = (struct sample){.seed = 1};
	TRY(reader_keys(reader, node, sample_keys, SAMPLE_KEYS, out));
	if (!out->points)
		return reader_fail(reader, node, "a sample lacks its 'points'");
	return 0;
}

/* Each dimension on its own: a random order of the strata, and a random place in each. */
static int draw_hypercube(
	const struct sample *sample, gsl_rng *random, size_t dimensions, double *values)
{
	size_t points = (size_t)sample->points, *order = calloc(points, sizeof *order);

	if (!order)
		return -1;
	for (size_t d = 0; d < dimensions; d++) {
		for (size_t i = 0; i < points; i++)
			order[i] = i;
		gsl_ran_shuffle(random, order, points, sizeof *order);
		for (size_t i = 0; i < points; i++)
			values[i * dimensions + d] =
				((double)order[i] + gsl_rng_uniform(random)) / (double)points;
	}
	free(order);
	return 0;
}

/* The seed flips bits, the same ones of every point: the points stay spread as Sobol's. */
static int draw_sobol(
	const struct sample *sample, gsl_rng *random, size_t dimensions, double *values)
{
	enum { BITS = 30 }; /* of GSL's sequence */
	gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dimensions);
	unsigned long *flips = calloc(dimensions, sizeof *flips);
	int result = sequence && flips ? 0 : -1;

	for (size_t d = 0; !result && d < dimensions; d++)
		flips[d] = gsl_rng_uniform_int(random, 1UL << BITS);
	for (int i = 0; !result && i < sample->points; i++) {
		double *point = values + (size_t)i * dimensions;

		(void)gsl_qrng_get(sequence, point);
		for (size_t d = 0; d < dimensions; d++)
			point[d] =
				ldexp((double)((unsigned long)ldexp(point[d], BITS) ^ flips[d]) + 0.5, -BITS);
	}
	if (sequence)
		gsl_qrng_free(sequence);
	free(flips);
	return result;
}

int sample_draw(const struct reader *reader, const struct node *node, const struct sample *sample,
	size_t dimensions, double *values)
{
	gsl_error_handler_t *before = gsl_set_error_handler_off();
	gsl_rng *random = NULL;
	int result = -1;

	if (sample->method == SAMPLE_SOBOL && dimensions > gsl_qrng_sobol->max_dimension) {
		reader_fail(reader, node, "sobol has at most %u ranges, here are %zu",
			gsl_qrng_sobol->max_dimension, dimensions);
		goto done;
	}
	random = gsl_rng_alloc(gsl_rng_mt19937);
	if (random) {
		gsl_rng_set(random, (unsigned long)sample->seed);
		result = (sample->method == SAMPLE_SOBOL ? draw_sobol : draw_hypercube)(
			sample, random, dimensions, values);
		gsl_rng_free(random);
	}
	if (result)
		error_memory(reader->err, dimensions * sizeof *values);
done:
	(void)gsl_set_error_handler(before);
	return result;
}
