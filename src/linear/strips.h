/* Strips of columns where the terms of xi are large: at the face of a dam, at a front, over the edge of
 * a step of the bed. They are few, but they alone make a preconditioner that leaves xi out slow, the
 * more so the finer the grid.
 *
 * Their unknowns are eliminated: conjugate gradients start from a residual that is zero inside, and
 * keep it so by directions of which A p is zero inside. That is an iteration on the Schur complement
 * of the strips, for which the block outside of the inverse of a preconditioner is a preconditioner. */
#ifndef TALUS_STRIPS_H
#define TALUS_STRIPS_H

#include "linear/elimination.h"

struct strip {
	int first, last; /* groups of columns [first, last) */
	int at;          /* its first column in the elimination */
};

enum { STRIPS_LEVELS = 24 };

struct strips {
	struct column_layout columns;
	struct elimination elimination;
	struct strip *strips;
	int count;
	int room;   /* groups in all strips together */
	int *level; /* [groups], how steep the steepest interface is in a group and next to it */
	double iterations[STRIPS_LEVELS]; /* of conjugate gradients, with columns up to a level */
	double *given;                    /* columns of a strip */
	void *memory;
};

/* EX_SOFTWARE out of memory. */
int strips_init(struct strips *s, int layers, int faces, struct error *err);
void strips_clean(struct strips *s);

/* Find the strips of a system and factor them. */
void strips_factor(struct strips *s, const struct pressure_system *system);

/* Correct x inside of the strips such that `product` is zero there, which so far holds what it should not;
 * then the product beside them is that of the new x, and `sums` go with it, as columns_apply has them. */
void strips_correct(struct strips *s, const struct pressure_system *system, double *x,
	double *product, double *sums);

#endif
