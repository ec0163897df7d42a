/* The subcommands of `talus`: one row and one file each. */
#ifndef TALUS_COMMAND_H
#define TALUS_COMMAND_H

#include <stdbool.h>

#include "talus/error.h"
#include "talus/text.h"

struct command {
	const char *name;
	const char *summary;                /* one line for `talus help` */
	int (*main)(int argc, char **argv); /* argv[0] is the subcommand; returns the exit code */
};

/* Print "talus: message" to stderr and return the exit code of `err`. */
int command_fail(const struct error *err);

/* The same for a config at `path` that cannot be read: one that is an experiment is called so. */
int command_config_fail(const char *path, const struct error *err);

/* Print "talus COMMAND: message" and the way out to stderr; return EX_USAGE. */
int command_usage(const char *command, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* Long options in the manner of getopt_long; start the short ones with ":" and leave the messages to
 * command_option_error, which takes getopt_long's ':' or '?' and returns EX_USAGE. */
int command_option_error(const char *command, int option, char **argv);

/* The texts of a repeated --set, in order. Empty is all zeros; the texts belong to argv. */
struct command_settings {
	const char **list;
	int count;
};

/* Add one; EX_SOFTWARE out of memory. `list` is freed by command_settings_clean. */
int command_settings_add(struct command_settings *settings, const char *text, struct error *err);
void command_settings_clean(struct command_settings *settings);

/* Is the text among them? Of names to choose from none means all. */
bool command_settings_choose(const struct command_settings *settings, const char *text);

/* Open a run folder or run file for a command, with its warning on stderr. EX_DATAERR, EX_SOFTWARE. */
struct run_file;
int command_open_run(const char *path, struct run_file **file, struct error *err);

/* The exit code of a command that ended with `code` once what it printed is out: EX_IOERR after a message
 * where that fails and nothing else did. */
int command_flush(int code);

/* Write `text` to stdout now and empty it. Returns 0, or the exit code after a message: EX_IOERR where
 * stdout cannot be written, EX_SOFTWARE where the text ran out of memory. */
int command_print(struct text *text);

#endif
