/* A figure as a script for gnuplot. */
#ifndef TALUS_SCRIPT_H
#define TALUS_SCRIPT_H

#include "plots/figure.h"

/* A way to draw, and the file that gnuplot writes to. */
struct script_output {
	const char *format; /* "svg", "png", "pdf" */
	const char *file;   /* letters, digits and -._/ only */
};

/* Everything that is not this program's own is quoted so that gnuplot shows it and does nothing else. */
void script_write(const struct figure *figure, const struct script_output *outputs, size_t count,
	struct text *out);

#endif
