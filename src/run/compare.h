/* Whether two run files hold the same bits. */
#ifndef TALUS_COMPARE_H
#define TALUS_COMPARE_H

#include "talus/run_file.h"

/* Add a line to `out` for every difference: attributes that say what the numbers are, and datasets by
 * shape and bit by bit (a NaN equals the same NaN), but for those whose names begin with cpu_ or
 * wall_. Without differences `out` stays empty. EX_DATAERR, EX_SOFTWARE. */
int compare_run_files(struct run_file *a, struct run_file *b, struct text *out, struct error *err);

#endif
