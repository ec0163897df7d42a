/* A panel of an experiment's plot, from its run files. */
#ifndef TALUS_PANEL_H
#define TALUS_PANEL_H

#include "plots/curves.h"
#include "talus/experiment.h"

/* Add to `figure` the panels that `wanted` asks for. EX_DATAERR where it cannot be; EX_SOFTWARE. */
int panel_build(const struct experiment *experiment, const struct experiment_plot *plot,
	const struct experiment_panel *wanted, struct figure *figure, struct error *err);

/* Could it be built once the runs are complete? */
int panel_check(const struct experiment *experiment, const struct experiment_plot *plot,
	const struct experiment_panel *wanted, struct error *err);

/* Axes and panels of curves that are there: scales, ranges, published points. */
int panel_finish(struct curves *curves, const struct experiment_panel *wanted, const char *source,
	struct figure *figure, struct error *err);

#endif
