/* Curves that differ in named ways, and what becomes of them: panels, colours, dashes, a legend. */
#ifndef TALUS_CURVES_H
#define TALUS_CURVES_H

#include "plots/figure.h"
#include "talus/experiment.h"

enum { CURVES_PARTS_MAX = 24 };

/* A way in which curves differ: a key of the config, a dataset, a time, a position, a layer. */
struct curves_dimension {
	const char *name;
	bool split;   /* a panel for every value */
	bool ordered; /* its values have an order that colours can show */
};

struct curve {
	char *parts[CURVES_PARTS_MAX]; /* a value per dimension as text, NULL: does not matter */
	double *x, *y;                 /* [count] */
	double *spread;                /* of y, [count], NULL: none */
	size_t count;
	char *title;           /* of what was measured, NULL: made from the parts */
	struct figure_map map; /* instead of x and y */
};

struct curves {
	struct curves_dimension dimensions[CURVES_PARTS_MAX]; /* [dimension_count] */
	size_t dimension_count;
	struct curve *items; /* [count] */
	size_t count;
	enum figure_mark mark;
	struct figure_axis x, y;
	struct text units[2]; /* of x and y in the run files */
};

/* A new dimension; false if there are too many. */
bool curves_add_dimension(struct curves *curves, const char *name, bool split, bool ordered);

/* A new curve at the end, NULL out of memory. */
struct curve *curves_add(struct curves *curves, struct error *err);

/* Take the curve at the end away again. */
void curves_drop(struct curves *curves);

/* Set a part of a curve; NULL: does not matter. */
int curves_set_part(struct curve *curve, size_t dimension, const char *text, struct error *err);

/* Add the panels to a figure. The curves' numbers go over to it; so do the axes. */
int curves_draw(struct curves *curves, const struct experiment_panel *wanted, const char *source,
	struct figure *figure, struct error *err);

void curves_clean(struct curves *curves);

#endif
