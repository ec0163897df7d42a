/* Which allocation of a process fails. $FAIL_ALLOC is its number from 1, with a '+' behind it for all from
 * there on. With $FAIL_EVERY k the process forks at each k-th or so: in the child that one fails (and sometimes
 * all from there on), and trials/N.out, trials/N.err and a line "N+ CODE" of trials/codes tell what became
 * of it; the process itself goes on once the child has ended. $COUNT_ALLOC names a file that gets the number
 * of allocations at the end. Children that the program starts are left in peace. */
#ifndef TALUS_TESTS_FAIL_ALLOC_H
#define TALUS_TESTS_FAIL_ALLOC_H

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static long count, fail_at, every;
static bool armed, stays;
static const char *count_file;

static void redirect(int fd, const char *kind)
{
	char name[64];
	int file;

	(void)snprintf(name, sizeof name, "trials/%ld.%s", count, kind);
	file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
	if (file < 0 || dup2(file, fd) < 0 || close(file) != 0)
		_exit(125);
}

/* Returns twice: true in the child in which the present allocation fails, then false. */
static bool try_in_child(void)
{
	int number = errno, status = 0, codes;
	pid_t pid = fork();

	if (pid == 0) {
		fail_at = count;
		stays = count / every % 4 == 3;
		every = 0;
		count_file = NULL;
		redirect(STDOUT_FILENO, "out");
		redirect(STDERR_FILENO, "err");
		return true;
	}
	while (pid > 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR)
		;
	codes = open("trials/codes", O_WRONLY | O_CREAT | O_APPEND, 0666);
	if (pid < 0 || codes < 0)
		_exit(125);
	(void)dprintf(codes, "%ld%s %d\n", count, count / every % 4 == 3 ? "+" : "",
		WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
	(void)close(codes);
	errno = number;
	return false;
}

/* Is it the turn of this one? Counts it. */
static bool fails(void)
{
	bool child;

	if (!armed)
		return false;
	count++;
	if (every) {
		if ((count + every / 2) % every != 0)
			return false;
		armed = false; /* fork itself may allocate */
		child = try_in_child();
		armed = true;
		errno = child ? ENOMEM : errno;
		return child;
	}
	if (!fail_at || (stays ? count < fail_at : count != fail_at))
		return false;
	errno = ENOMEM;
	return true;
}

__attribute__((constructor)) static void arm(void)
{
	const char *wanted = getenv("FAIL_ALLOC"), *each = getenv("FAIL_EVERY");

	count_file = getenv("COUNT_ALLOC");
	fail_at = wanted ? strtol(wanted, NULL, 10) : 0;
	stays = wanted && strchr(wanted, '+');
	every = each ? strtol(each, NULL, 10) : 0;
	(void)unsetenv("LD_PRELOAD");
	(void)unsetenv("FAIL_ALLOC");
	(void)unsetenv("FAIL_EVERY");
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
