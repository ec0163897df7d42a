/* Which allocation of a process fails. $FAIL_ALLOC is its number from 1, with a '+' behind it for all from
 * there on. $COUNT_ALLOC names a file that gets the number of allocations at the end. Children are left in
 * peace. */
#ifndef TALUS_TESTS_FAIL_ALLOC_H
#define TALUS_TESTS_FAIL_ALLOC_H

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static long count, fail_at;
static bool armed, stays;
static const char *count_file;

/* Is it the turn of this one? Counts it. */
static bool fails(void)
{
	if (!armed)
		return false;
	count++;
	if (!fail_at || (stays ? count < fail_at : count != fail_at))
		return false;
	errno = ENOMEM;
	return true;
}

__attribute__((constructor)) static void arm(void)
{
	const char *wanted = getenv("FAIL_ALLOC");

	count_file = getenv("COUNT_ALLOC");
	fail_at = wanted ? strtol(wanted, NULL, 10) : 0;
	stays = wanted && strchr(wanted, '+');
	(void)unsetenv("LD_PRELOAD");
	(void)unsetenv("FAIL_ALLOC");
	armed = true;
}

/* Not in a child that was forked and has not become another program. */
__attribute__((destructor)) static void tell(void)
{
	char text[32];
	int fd, length;

	armed = false;
	fd = count_file ? open(count_file, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
	if (fd < 0)
		return;
	length = snprintf(text, sizeof text, "%ld\n", count);
	(void)!write(fd, text, (size_t)length);
	(void)close(fd);
}

#endif
