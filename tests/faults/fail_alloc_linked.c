/* To be linked in: the n-th allocation that the program asks for fails, and none of a library. The linker
 * sends the calls here (-Wl,--wrap), so that it works below valgrind too, which puts its own malloc in the
 * place of a preloaded one. */
#include <dirent.h>
#include <search.h>
#include <stdarg.h>

#include "fail_alloc.h"

#define WRAP(type, name, parameters, arguments, failure)                                           \
	type __real_##name parameters;                                                                 \
	type __wrap_##name parameters;                                                                 \
	type __wrap_##name parameters                                                                  \
	{                                                                                              \
		return fails() ? (failure) : __real_##name arguments;                                      \
	}

typedef int chooser(const struct dirent *);
typedef int order(const struct dirent **, const struct dirent **);

WRAP(void *, malloc, (size_t size), (size), NULL)
WRAP(void *, calloc, (size_t count_, size_t size), (count_, size), NULL)
WRAP(void *, realloc, (void *block, size_t size), (block, size), NULL)
WRAP(char *, strdup, (const char *text), (text), NULL)
WRAP(char *, strndup, (const char *text, size_t size), (text, size), NULL)
WRAP(void *, tsearch, (const void *key, void **root, __compar_fn_t compare), (key, root, compare),
	NULL)
WRAP(int, scandir, (const char *path, struct dirent ***out, chooser *choose, order *compare),
	(path, out, choose, compare), -1)

int __wrap_asprintf(char **out, const char *format, ...);
int __wrap_asprintf(char **out, const char *format, ...)
{
	va_list arguments;
	int length;

	if (fails())
		return -1;
	va_start(arguments, format);
	length = vasprintf(out, format, arguments);
	va_end(arguments);
	return length;
}
