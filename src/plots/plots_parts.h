/* What the figures of experiments and of runs share. */
#ifndef TALUS_PLOTS_PARTS_H
#define TALUS_PLOTS_PARTS_H

#include "plots/figure.h"
#include "talus/plots.h"

/* Draw the figure in every format that is wanted. */
int plots_write(const struct figure *figure, struct plots_output *output, struct error *err);

#endif
