/* Run files -> figures, through gnuplot. Never calls the engine. */
#ifndef TALUS_PLOTS_H
#define TALUS_PLOTS_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"
#include "talus/experiment.h"
#include "talus/text.h"

enum plots_format { PLOTS_SVG = 1, PLOTS_PNG = 2, PLOTS_PDF = 4, PLOTS_ALL = 7 };

/* Where figures go. */
struct plots_output {
	const char *folder;  /* made when missing */
	unsigned formats;    /* enum plots_format, added up */
	bool dimensionless;  /* runs without units; of an experiment its plots say so */
	struct text written; /* the path of every file, one a line */
	struct text
		missing;       /* a line per thing that could not be drawn; empty: the figures are whole */
	struct text notes; /* a line per figure that was left out because nothing would be seen in it */
};

/* Draw a plot of an experiment into folder/NAME.svg and so on, each file replaced whole. EX_DATAERR
 * where the experiment asks for what it cannot have; EX_UNAVAILABLE without gnuplot; EX_CANTCREAT,
 * EX_IOERR, EX_SOFTWARE. */
int plots_draw(const struct experiment *experiment, const struct experiment_plot *plot,
	struct plots_output *output, struct error *err);

/* Draw what is worth seeing of any runs, their folders or files: fronts, profiles, deposit, space and
 * time. EX_DATAERR for a path that is no good run. */
int plots_draw_runs(
	const char *const *paths, size_t count, struct plots_output *output, struct error *err);

/* Is every plot of the experiment one that could be drawn once its runs are complete? */
int plots_check(const struct experiment *experiment, struct error *err);

void plots_output_clean(struct plots_output *output);

/* The format called `name`; 0: there is none. */
unsigned plots_format_find(const char *name);

#endif
