/* Other programs, called without a shell. */
#ifndef TALUS_PROCESS_H
#define TALUS_PROCESS_H

#include "talus/error.h"
#include "talus/text.h"

/* Run the program `arguments[0]` of PATH with `arguments` (NULL at the end) and nothing to read, and add
 * what it prints to `out`. EX_UNAVAILABLE: it cannot be started, does not end within `seconds`, or ends
 * with another code than 0, when the message has its words. */
int process_run(const char *const *arguments, int seconds, struct text *out, struct error *err);

#endif
