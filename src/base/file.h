/* Files read whole and replaced whole. */
#ifndef TALUS_FILE_H
#define TALUS_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/error.h"
#include "talus/text.h"

/* Read all of `path` into `*bytes` (free). EX_NOINPUT: absent; EX_IOERR: cannot be read. */
int file_read(const char *path, unsigned char **bytes, size_t *size, struct error *err);

/* Read the last `count` bytes of `path`, and tell its size. EX_DATAERR when it is shorter. */
int file_read_end(
	const char *path, unsigned char *bytes, size_t count, size_t *size, struct error *err);

/* Make folder `path` and those above it where they are missing. EX_CANTCREAT. */
int file_make_folders(const char *path, struct error *err);

/* Consecutive pieces of a file. */
struct file_part {
	const void *bytes;
	size_t size;
};

struct file_place {
	const char *folder, *name;
	const char *previous; /* name under which the present file is kept; NULL: it is not */
	bool durable;         /* on disk before the call returns */
};

/* Replace a file so that a reader, or a crash at any moment, finds the old one or the new one whole;
 * with `previous` there is in every moment at least one whole file under one of the two names.
 * EX_CANTCREAT: cannot be created; EX_IOERR: anything later. What was there stays on failure. */
int file_replace(
	const struct file_place *place, const struct file_part *parts, size_t count, struct error *err);

/* Add `text` to the end of `path`, made when missing. EX_CANTCREAT, EX_IOERR. */
int file_append(const char *path, const char *text, struct error *err);

/* "folder/name" in `out`, which is cleaned first. EX_SOFTWARE out of memory. */
int file_path(struct text *out, const char *folder, const char *name, struct error *err);

bool file_exists(const char *path);
bool file_is_folder(const char *path);

/* A byte count for people: "512 bytes", "26.5 MB". Returns `buffer`. */
enum { FILE_SIZE_TEXT = 32 };
char *file_size_text(double bytes, char buffer[FILE_SIZE_TEXT]);

#endif
