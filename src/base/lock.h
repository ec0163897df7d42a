/* Locks that die with the process that holds them. */
#ifndef TALUS_LOCK_H
#define TALUS_LOCK_H

#include <stdbool.h>

#include "talus/error.h"

struct lock {
	int fd; /* of the lock file, -1: not held */
};

/* Take the lock of file `path`, made when missing and never unlinked: a name that can vanish would
 * let two processes lock two files. EX_INTERRUPTED: held by another process (says which),
 * EX_CANTCREAT, EX_IOERR. */
int lock_take(struct lock *lock, const char *path, struct error *err);

void lock_release(struct lock *lock);

/* Whether `path` still names the file whose lock is held: not where somebody removed or replaced it, so
 * that another process could take a lock of its own. */
bool lock_is_named(const struct lock *lock, const char *path);

/* Whether some process holds the lock of `path`. Never takes it, never makes the file. */
bool lock_is_held(const char *path);

/* Who took the lock of `path` last: "process 4711 on host", "" if unknown. Returns `buffer`. */
enum { LOCK_HOLDER_SIZE = 128 };
char *lock_holder(const char *path, char buffer[LOCK_HOLDER_SIZE]);

#endif
