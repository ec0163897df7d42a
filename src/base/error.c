#include "talus/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void set(struct error *err, int code, const char *format, va_list args)
{
	err->code = code;
	err->file[0] = '\0';
	err->line = err->column = 0;
	(void)vsnprintf(err->text, sizeof err->text, format, args);
}

static void set_place(struct error *err, const char *file, int line, int column)
{
	(void)snprintf(err->file, sizeof err->file, "%s", file);
	err->line = line;
	err->column = column;
}

int error_set(struct error *err, int code, const char *format, ...)
{
	va_list args;

	if (err->code)
		return -1;
	va_start(args, format);
	set(err, code, format, args);
	va_end(args);
	return -1;
}

int error_at(
	struct error *err, int code, const char *file, int line, int column, const char *format, ...)
{
	va_list args;

	if (err->code)
		return -1;
	va_start(args, format);
	set(err, code, format, args);
	va_end(args);
	set_place(err, file, line, column);
	return -1;
}

int error_place(struct error *err, const char *file, int line, int column)
{
	if (err->code != EX_DATAERR || err->file[0])
		return -1;
	set_place(err, file, line, column);
	return -1;
}

int error_context(struct error *err, const char *format, ...)
{
	char lower[sizeof err->text];
	va_list args;
	size_t used;

	memcpy(lower, err->text, sizeof lower);
	va_start(args, format);
	(void)vsnprintf(err->text, sizeof err->text, format, args);
	va_end(args);
	used = strlen(err->text);
	(void)snprintf(err->text + used, sizeof err->text - used, ": %s", lower);
	return -1;
}

int error_memory(struct error *err, size_t bytes)
{
	return error_set(err, EX_SOFTWARE, "out of memory (%zu bytes asked for)", bytes);
}

char *error_format(const struct error *err, char *buffer, size_t size)
{
	if (!err->file[0])
		(void)snprintf(buffer, size, "%s", err->text);
	else if (!err->line)
		(void)snprintf(buffer, size, "%s: %s", err->file, err->text);
	else
		(void)snprintf(buffer, size, "%s:%d:%d: %s", err->file, err->line, err->column, err->text);
	/* names of files and texts of strangers do not speak to the terminal */
	for (char *c = buffer; *c; c++)
		if ((unsigned char)*c < ' ' || *c == 0x7F)
			*c = '?';
	return buffer;
}
