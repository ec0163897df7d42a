/* How much memory can be had. */
#ifndef TALUS_MEMORY_H
#define TALUS_MEMORY_H

#include <stddef.h>

#include "talus/error.h"

/* Refuse what this machine has no room for now, before a use of it ends the process (Linux grants more
 * than it has). EX_SOFTWARE. Less than MEMORY_SMALL is not asked about. */
int memory_check(size_t bytes, struct error *err);

enum { MEMORY_SMALL = 256 << 20 };

#endif
