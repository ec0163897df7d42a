/* Being asked to stop by a signal. */
#ifndef TALUS_STOP_H
#define TALUS_STOP_H

/* From now on SIGINT, SIGTERM, SIGUSR1 and SIGHUP (unless ignored already) are remembered instead of ending the process; a second
 * SIGINT ends it at once with EX_INTERRUPTED. SIGXFSZ is ignored, so that a file over the quota is an
 * error of the write. For programs: a library does not install handlers. */
void stop_install(void);

/* The signal that asked to stop, 0: none yet. */
int stop_signal(void);

#endif
