/* What went wrong, where, and the exit code that it deserves. */
#ifndef TALUS_ERROR_H
#define TALUS_ERROR_H

#include <stddef.h>
#include <sysexits.h> /* EX_USAGE 64, EX_DATAERR 65, EX_UNAVAILABLE 69, EX_SOFTWARE 70, ... */

/* Exit codes beside those of <sysexits.h>. */
enum {
	EX_FAILED = 1,               /* the simulation failed, or a table has missing cells */
	EX_INTERRUPTED = EX_TEMPFAIL /* 75: stopped, and the same command goes on from there */
};

/* An empty error is all zeros: `struct error err = {0};`. */
struct error {
	int code;        /* exit code of the programs; 0: no error */
	char file[512];  /* file that the message is about, "" if none */
	int line;        /* counted from 1, 0: none */
	int column;      /* counted from 1, 0: none */
	char text[2048]; /* one sentence with the offending value and what would be right */
};

/* Set `err` unless it already holds an error: the lowest message is the one to keep. Return -1. */
int error_set(struct error *err, int code, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

/* The same for a place in a file; line and column 0 are left out. */
int error_at(struct error *err, int code, const char *file, int line, int column,
	const char *format, ...) __attribute__((format(printf, 6, 7)));

/* Give an error of data that has no place yet this one. Return -1. */
int error_place(struct error *err, const char *file, int line, int column);

/* Put "context: " before the text of an error that is set. Return -1. */
int error_context(struct error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Out of memory, as every allocation reports it: code EX_SOFTWARE. Return -1. */
int error_memory(struct error *err, size_t bytes);

/* Write "file:line:column: text" to `buffer` (always terminated) in one line and return it. */
char *error_format(const struct error *err, char *buffer, size_t size);

/* Leave the calling function with -1 when `call` does not return 0. */
#define TRY(call)                                                                                  \
	do {                                                                                           \
		if ((call) != 0)                                                                           \
			return -1;                                                                             \
	} while (0)

#endif
