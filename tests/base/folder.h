/* A folder of its own for each test, entered by the setup and removed by the teardown. */
#ifndef TALUS_TEST_FOLDER_H
#define TALUS_TEST_FOLDER_H

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <setjmp.h> /* what cmocka needs */
#include <stddef.h>

#include <cmocka.h>

static inline void write_file(const char *name, const char *text)
{
	FILE *file = fopen(name, "w");

	assert_non_null(file);
	assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
	assert_int_equal(fclose(file), 0);
}

/* `*state` is its path. */
static inline int enter_folder(void **state)
{
	char name[] = "/tmp/talus-test-XXXXXX";

	if (!mkdtemp(name) || chdir(name))
		return -1;
	*state = strdup(name);
	return 0;
}

static inline int leave_folder(void **state)
{
	char command[256];
	int result;

	(void)snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
	result = chdir("/") || system(command); /* NOLINT(cert-env33-c): a folder of our own */
	free(*state);
	return result;
}

#endif
