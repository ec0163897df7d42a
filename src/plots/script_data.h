/* The numbers of a figure as gnuplot's data blocks. */
#ifndef TALUS_SCRIPT_DATA_H
#define TALUS_SCRIPT_DATA_H

#include "plots/figure.h"

/* Block $pP_L for line L of panel P, in columns x, y and spread, and $mP for its map: x, y, value. Lines
 * that cannot be drawn have none. */
void script_data_add(struct text *out, const struct figure *figure);

/* A number behind a blank; NaN where it is none. */
void script_data_add_number(struct text *out, double value);

#endif
