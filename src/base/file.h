/* Files read whole and replaced whole. */
#ifndef TALUS_FILE_H
#define TALUS_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "talus/error.h"
#include "talus/text.h"

/* Read all of `path` into `*bytes` (free). EX_NOINPUT: absent; EX_IOERR: cannot be read, or is no
 * regular file: a pipe is not waited for. */
int file_read(const char *path, unsigned char **bytes, size_t *size, struct error *err);

/* Read the last `count` bytes of `path`, and tell its size. EX_DATAERR when it is shorter. */
int file_read_end(
	const char *path, unsigned char *bytes, size_t count, size_t *size, struct error *err);

/* Read up to `size` bytes from whatever `path` is, also a pipe; what does not end within some seconds
 * is ETIMEDOUT. Returns how many came, or -1 with errno. */
enum { FILE_PATIENCE = 10 /* s */ };
ssize_t file_read_text(const char *path, char *buffer, size_t size);

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

/* Give a file of `folder` another name there; one that is absent is no error. EX_IOERR. */
int file_rename(const char *folder, const char *name, const char *other, struct error *err);

/* Open `path` to write at its end, made when missing; not through a symbolic link, which could lead
 * out of the run's folder, and not waiting for the reader of a pipe. -1 with errno. */
int file_open_log(const char *path);

/* Add `text` to the end of `path`, made when missing. EX_CANTCREAT, EX_IOERR. */
int file_append(const char *path, const char *text, struct error *err);

/* "folder/name" in `out`, which is cleaned first. EX_SOFTWARE out of memory. */
int file_path(struct text *out, const char *folder, const char *name, struct error *err);

/* The name of `path` without folder and extension. False when it names no folder of its own: "", "."
 * and "..". */
bool file_stem(const char *path, struct text *out);

/* Can `folder` hold another file of `size` bytes? If not, `err` says why (EX_IOERR, EX_CANTCREAT). */
bool file_has_room(const char *folder, size_t size, struct error *err);

bool file_size(const char *path, size_t *size);
bool file_exists(const char *path);
bool file_is_folder(const char *path);

/* A byte count for people: "512 bytes", "26.5 MB". Returns `buffer`. */
enum { FILE_SIZE_TEXT = 32 };
char *file_size_text(double bytes, char buffer[FILE_SIZE_TEXT]);

#endif
