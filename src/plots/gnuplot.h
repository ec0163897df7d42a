/* The one place where gnuplot is started. */
#ifndef TALUS_GNUPLOT_H
#define TALUS_GNUPLOT_H

#include "talus/error.h"
#include "talus/text.h"

/* Run a script, without a shell, without init files and with nothing to read but the
 * script. EX_UNAVAILABLE: there is no gnuplot, or one without the output wanted; EX_SOFTWARE: it did
 * not like the script (says why). */
int gnuplot_run(const struct text *script, struct error *err);

#endif
