#include "cli/command.h"

#include <stdarg.h>
#include <stdio.h>

int command_fail(const struct error *err)
{
	char message[sizeof err->text + sizeof err->file + 32];

	(void)fflush(stdout);
	(void)fprintf(stderr, "talus: %s\n", error_format(err, message, sizeof message));
	return err->code ? err->code : EX_SOFTWARE;
}

int command_usage(const char *command, const char *format, ...)
{
	va_list args;

	(void)fprintf(stderr, "talus %s: ", command);
	va_start(args, format);
	(void)vfprintf(stderr, format, args);
	va_end(args);
	(void)fprintf(stderr, "; see `talus %s --help`\n", command);
	return EX_USAGE;
}
