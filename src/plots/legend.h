/* The legend of a figure: lines with a title, each look and title once. */
#ifndef TALUS_LEGEND_H
#define TALUS_LEGEND_H

#include "plots/figure.h"

enum { LEGEND_MAX = 128 };

/* The entries of the legend of one panel, or of all of them. */
struct legend {
	const struct figure_line *items[LEGEND_MAX]; /* [count] */
	size_t count;
	size_t longest; /* letters of the longest title */
};

void legend_collect(const struct figure_panel *panel, struct legend *legend);

/* Does one look mean two things in two panels? Then every panel has a legend of its own. */
bool legend_is_ambiguous(const struct legend *legend);

#endif
