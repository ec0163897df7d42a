/* What the numbers along an axis are: words, symbol, unit, and the scale that takes the unit away. */
#ifndef TALUS_MEANING_H
#define TALUS_MEANING_H

#include <stdbool.h>

#include "plots/figure.h"
#include "talus/config.h"

/* How an axis is written. */
struct meaning {
	const char *name;  /* of the dataset, axis or metric */
	const char *words; /* what it is, where the table does not know the name */
	const char *unit;  /* as the run file writes it, "m s-1"; "": none */
	const char *shown; /* unit of its own, as the experiment wrote it; NULL: `unit` */
	bool dimensionless;
};

/* What a value is divided by when axes are dimensionless (tables/scale.h); 1: nothing. */
double meaning_scale(const char *name, const char *unit, const struct config *config);

/* "thickness h (mm)", "front velocity v/v_0". */
void meaning_label(const struct meaning *meaning, struct figure_text *out);

/* What a dataset is in a few words; NULL: the table does not know it. */
const char *meaning_words(const char *name);

/* Simulated time before which a series says nothing, s. */
double meaning_settles(const char *name);

/* "m s-1" -> "m/s" */
void meaning_unit(const char *unit, struct text *out);

#endif
