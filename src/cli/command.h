/* The subcommands of `talus`: one row and one file each. */
#ifndef TALUS_COMMAND_H
#define TALUS_COMMAND_H

#include "talus/error.h"

struct command {
	const char *name;
	const char *summary;                /* one line for `talus help` */
	int (*main)(int argc, char **argv); /* argv[0] is the subcommand; returns the exit code */
};

/* Print "talus: message" to stderr and return the exit code of `err`. */
int command_fail(const struct error *err);

/* Print "talus COMMAND: message" and the way out to stderr; return EX_USAGE. */
int command_usage(const char *command, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
