/* The symmetric pressure operator without its xi terms, solved directly: a preconditioner, in single
 * precision.
 *
 * Without xi the operator is B^T B (x) K + D^T D (x) M, where B q = q_a + q_{a+1} and
 * D q = q_a - q_{a+1} act over the layers, and K and M are tridiagonal along x. With
 * t_m = (m + 1/2) pi/N the vectors cos(a t_m), m = 0..N-1, diagonalise both, to 2 + 2 cos t_m and
 * 2 - 2 cos t_m (with half the weight at the bed), so that N tridiagonal systems along x are left. Unequal
 * layers have B^T L B and D^T L^-1 D, L their thicknesses, and modes of their own that diagonalise both.
 *
 * Modes m and N - 1 - m are the same at even a and opposite at odd a. A transform does half of the work
 * for both: a column of modes is its lower half, up to a multiple of MODES, and then the partners of
 * these in the same order (of the middle mode of an odd N, which has none, a zero). Modes of unequal layers
 * have no partners, and take the same places. */
#ifndef TALUS_FAST_DIAGONAL_H
#define TALUS_FAST_DIAGONAL_H

#include "linear/columns.h"

enum { MODES = 2 * LANES }; /* that a vector holds */

struct fast_diagonal {
	struct column_layout columns; /* of layers */
	size_t half;                  /* modes in half a column, a multiple of MODES */
	/* sqrt(2/N) cos(a t_m), for even and for odd a: [layers of that kind][half] with m along the row,
	 * and their transposes [lower modes][half] with the layers along the row. */
	float *to_modes[2], *to_layers[2];
	/* Of unequal layers, else without elements: [layers][2 half] and [2 half][stride]. */
	bool unequal;
	float *any_to_modes, *any_to_layers;
	double *of_stretch; /* [2 half], 2 + 2 cos t_m; 1 in the padding */
	double *of_mean;    /* [2 half], 2 - 2 cos t_m; 1 in the padding */
	double *kept;       /* [2 half], 1; 0 in the padding */
	float *multiplier;  /* columns of modes: L of the L D L^T of each tridiagonal system */
	float *inverse;     /* columns of modes: 1/D */
	double *bands[4]; /* [faces + 1]: diagonals of K and M, and their coupling to the face before */
	/* Of periodic ends, else without elements. With c = 1 at the first face and -1 at the last, the
	 * solution z of a right side between walls becomes that on the ring by z - y (c z)/(c y). */
	float *seam;       /* columns of modes: y, the solution for c */
	float *seam_scale; /* [2 half], 1/(c y); 0 in the padding */
	float *seam_jump;  /* [2 half], (c z)/(c y) of the solution at hand */
	void *memory;
};

/* How many modes half a column takes. */
static inline size_t fast_diagonal_half(int layers)
{
	return ((size_t)(layers + 1) / 2 + MODES - 1) / MODES * MODES;
}

/* `shares` as in pressure_options. EX_SOFTWARE out of memory. */
int fast_diagonal_init(struct fast_diagonal *fast, int layers, int faces, bool periodic,
	const double *shares, struct error *err);
void fast_diagonal_clean(struct fast_diagonal *fast);

/* How many numbers the columns of modes take, and vectors one of them. */
size_t fast_diagonal_count(const struct fast_diagonal *fast);
int fast_diagonal_blocks(const struct fast_diagonal *fast);

/* K and M of a system. Then, for blocks [first, last) of modes, the factors. */
void fast_diagonal_prepare(struct fast_diagonal *fast, const struct pressure_system *system);
void fast_diagonal_factor(struct fast_diagonal *fast, int first, int last);

/* Columns of layers into columns of modes, in groups [first, last). */
void fast_diagonal_to_modes(
	const struct fast_diagonal *fast, const double *from, float *modes, int first, int last);
/* And back, which spoils the modes. */
void fast_diagonal_to_layers(
	const struct fast_diagonal *fast, float *modes, double *to, int first, int last);

/* Solve the systems of blocks [first, last) of modes in place. Returns in `sums` [blocks] the product of
 * right side and solution, which the preconditioned residual norm is made of. */
void fast_diagonal_solve(
	const struct fast_diagonal *fast, float *modes, double *sums, int first, int last);

/* Periodic ends: the right side c into `modes`; then its solution, which is kept. */
void fast_diagonal_seam_side(const struct fast_diagonal *fast, float *modes);
void fast_diagonal_seam_keep(struct fast_diagonal *fast, const float *modes);

/* The jump of a solution at the seam. Returns how much less the sums are without. */
double fast_diagonal_seam_jump(struct fast_diagonal *fast, const float *modes);
/* Then, for groups [first, last), the solution without it; at last both sides the same in every bit. */
void fast_diagonal_seam_close(const struct fast_diagonal *fast, float *modes, int first, int last);
void fast_diagonal_seam_join(const struct fast_diagonal *fast, float *modes);

#endif
