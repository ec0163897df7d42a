#include "linear/modes.h"

#include <math.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>

/* B^T L B, and what it and D^T L^-1 D add up to: both tridiagonal. */
static void fill(const double *shares, size_t n, gsl_matrix *stretch, gsl_matrix *both)
{
	for (size_t a = 0; a < n; a++) {
		double own = shares[a], below = a > 0 ? shares[a - 1] : 0;

		gsl_matrix_set(stretch, a, a, own + below);
		gsl_matrix_set(both, a, a, own + 1 / own + (a > 0 ? below + 1 / below : 0));
		if (a == 0)
			continue;
		gsl_matrix_set(stretch, a, a - 1, below);
		gsl_matrix_set(both, a, a - 1, below - 1 / below);
	}
}

/* v both v of a column, by the lower half of the matrix. */
static double square(const gsl_matrix *both, const gsl_matrix *vectors, size_t m)
{
	double sum = 0;

	for (size_t a = 0; a < both->size1; a++) {
		double v = gsl_matrix_get(vectors, a, m);

		sum += gsl_matrix_get(both, a, a) * v * v;
		if (a > 0)
			sum += 2 * gsl_matrix_get(both, a, a - 1) * v * gsl_matrix_get(vectors, a - 1, m);
	}
	return sum;
}

/* By GSL and not LAPACK, of which there is one for every processor, with other bits. */
int modes_find(const double *shares, int layers, double *modes, double *stretch, struct error *err)
{
	size_t n = (size_t)layers;
	gsl_error_handler_t *handler = gsl_set_error_handler_off(); /* it would end the program */
	gsl_eigen_gensymmv_workspace *work = gsl_eigen_gensymmv_alloc(n);
	gsl_matrix *part = gsl_matrix_calloc(n, n), *both = gsl_matrix_calloc(n, n);
	gsl_matrix *spoiled = gsl_matrix_calloc(n, n), *vectors = gsl_matrix_calloc(n, n);
	gsl_vector *values = gsl_vector_calloc(n);
	int failed = -1;

	if (work && part && both && spoiled && vectors && values) {
		fill(shares, n, part, both);
		(void)gsl_matrix_memcpy(spoiled, both);
		failed = gsl_eigen_gensymmv(part, spoiled, values, vectors, work);
	}
	for (size_t m = 0; m < n && failed == 0; m++) {
		double scale = 1 / sqrt(square(both, vectors, m));

		stretch[m] = gsl_vector_get(values, m);
		for (size_t a = 0; a < n; a++)
			modes[m * n + a] = scale * gsl_matrix_get(vectors, a, m);
	}
	gsl_eigen_gensymmv_free(work);
	gsl_matrix_free(part);
	gsl_matrix_free(both);
	gsl_matrix_free(spoiled);
	gsl_matrix_free(vectors);
	gsl_vector_free(values);
	(void)gsl_set_error_handler(handler);
	return failed == 0 ? 0 : error_memory(err, 4 * n * n * sizeof(double));
}
