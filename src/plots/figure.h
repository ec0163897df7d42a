/* A figure before it is drawn: panels with lines of numbers in the units of their axes. */
#ifndef TALUS_FIGURE_H
#define TALUS_FIGURE_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"
#include "talus/text.h"

/* Text in a figure. Only what this program writes itself is `marked`: then gnuplot's marks for
 * italics and subscripts mean something. Everything else is shown as it stands. */
struct figure_text {
	struct text text;
	bool marked;
};

enum figure_mark { FIGURE_LINE, FIGURE_POINTS, FIGURE_LINE_POINTS };

struct figure_line {
	char *title; /* in the legend; NULL: not there */
	enum figure_mark mark;
	unsigned colour; /* 0xRRGGBB */
	int dash;        /* 0: solid; the same number is the shape of its points */
	bool hollow;     /* points of others than us */
	double *x, *y;   /* [count]; NaN: a gap */
	double *spread;  /* half the range of y, [count]; NULL: none */
	size_t count;
};

/* A field over x and y in colours. */
struct figure_map {
	double *x, *y;        /* [columns], [rows] */
	double *values;       /* [rows][columns] */
	size_t columns, rows; /* 0: none */
	struct figure_text label;
};

struct figure_axis {
	struct figure_text label;
	bool log;
	double from, to; /* NaN: as the data ask for */
};

struct figure_panel {
	struct text title;
	struct figure_axis x, y;
	struct figure_line *lines; /* [line_count] */
	size_t line_count;
	struct figure_map map;
};

struct figure {
	const char *name;
	struct text title;
	int columns;                 /* panels beside one another; 0: as fits */
	struct figure_panel *panels; /* [panel_count] */
	size_t panel_count;
	struct text missing; /* a line per thing that could not be drawn; empty: the figure is whole */
};

/* A new panel, or line of a panel, at the end; NULL out of memory. */
struct figure_panel *figure_add_panel(struct figure *figure, struct error *err);
struct figure_line *figure_add_line(struct figure_panel *panel, struct error *err);

/* Has the line a point that its panel's axes can show? */
bool figure_can_be_drawn(const struct figure_panel *panel, const struct figure_line *line);

void figure_clean(struct figure *figure);

#endif
