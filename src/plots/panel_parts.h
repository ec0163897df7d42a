/* What the files about panels share. */
#ifndef TALUS_PANEL_PARTS_H
#define TALUS_PANEL_PARTS_H

#include "plots/kind.h"
#include "plots/panel.h"
#include "tables/layout.h"

/* A panel on its way. */
struct panel {
	const struct experiment *experiment;
	const struct experiment_panel *wanted;
	const struct kind *kind;
	struct experiment_table table; /* the runs of the panel laid out: panels by lines (and x) */
	struct layout layout;
	struct kind_cuts cuts;
	struct curves curves;
};

/* Is the metric drawn over a key of the config, rather than over the profile times? */
bool panel_over_key(const struct panel *panel);

/* The texts of a run in the dimensions of keys; the panel's come first. Room for CURVES_PARTS_MAX. */
size_t panel_parts(const struct panel *panel, size_t run, const char **parts);

/* The number that the key `x` has in a run, in SI, and its unit. EX_DATAERR: it has none. */
int panel_key_number(const struct panel *panel, const struct experiment_run *run, double *value,
	struct text *unit, struct error *err);

/* Metrics of every run, over a key or over the profile times: panel_metric.c. */
int panel_add_metrics(struct panel *panel, struct figure *figure, struct error *err);

/* What was observed of the runs of the panel: over x at the times that are shown, or over time. The
 * curves of ours are there already: panel_observed.c. */
int panel_add_observed(struct panel *panel, const struct kind_request *request, struct error *err);

#endif
