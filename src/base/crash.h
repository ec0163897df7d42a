/* The end of a process by a fault in it. */
#ifndef TALUS_CRASH_H
#define TALUS_CRASH_H

/* From now on a fault that would end the process by a signal, and an exit() that some library calls, end
 * it with a message and EX_SOFTWARE: HDF5 does such things where memory runs out. What is on disk is
 * whole at any moment. For programs: a library does not install handlers. */
void crash_install(void);

/* The end of main: flushes the standard streams and leaves with `code`. */
_Noreturn void crash_exit(int code);

#endif
