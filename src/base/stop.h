/* Being asked to stop by a signal. */
#ifndef TALUS_STOP_H
#define TALUS_STOP_H

#include <stdbool.h>

/* From now on SIGINT, SIGTERM and SIGUSR1 are remembered instead of ending the process; a second
 * SIGINT ends it at once with EX_INTERRUPTED. For programs: a library does not install handlers. */
void stop_install(void);

/* The signal that asked to stop, 0: none yet. */
int stop_signal(void);

#endif
