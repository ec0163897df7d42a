#include "base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"

/* A child: what it prints comes through a pipe, what it complains of lies in a file in memory. */
struct child {
	pid_t pid;
	int out, complaints;
};

static int spawn(struct child *child, const char *const *arguments, int out)
{
	posix_spawn_file_actions_t actions;
	posix_spawnattr_t attributes;
	sigset_t none;
	int failed;

	(void)sigemptyset(&none);
	if (posix_spawn_file_actions_init(&actions) != 0)
		return ENOMEM;
	if (posix_spawnattr_init(&attributes) != 0) {
		(void)posix_spawn_file_actions_destroy(&actions);
		return ENOMEM;
	}
	(void)posix_spawnattr_setsigmask(&attributes, &none);
	(void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
	failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0) ||
			 posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO) ||
			 posix_spawn_file_actions_adddup2(&actions, child->complaints, STDERR_FILENO);
	/* posix_spawnp takes what execv takes: strings that it does not change */
	failed = failed ? ENOMEM
					: posix_spawnp(&child->pid, arguments[0], &actions, &attributes,
						  (char *const *)arguments, environ);
	(void)posix_spawn_file_actions_destroy(&actions);
	(void)posix_spawnattr_destroy(&attributes);
	return failed;
}

static int start(struct child *child, const char *const *arguments, struct error *err)
{
	int ends[2], failed;

	child->out = -1;
	child->complaints = memfd_create("complaints", MFD_CLOEXEC);
	if (child->complaints < 0 || pipe2(ends, O_CLOEXEC) != 0)
		return error_set(err, EX_SOFTWARE, "cannot start %s: %s", arguments[0], strerror(errno));
	child->out = ends[0];
	failed = spawn(child, arguments, ends[1]);
	(void)close(ends[1]);
	if (failed == ENOENT)
		return error_set(err, EX_UNAVAILABLE, "%s is needed and is not on PATH", arguments[0]);
	if (failed)
		return error_set(
			err, EX_UNAVAILABLE, "cannot start %s: %s", arguments[0], strerror(failed));
	return 0;
}

/* All that the child prints until it closes its output. False: it takes longer than that. */
static bool read_all(const struct child *child, int seconds, struct text *out)
{
	struct pollfd wait = {.fd = child->out, .events = POLLIN};
	double end = clock_wall() + seconds, left;
	char bytes[4096];
	ssize_t n = 1;

	while (n != 0 && (left = end - clock_wall()) > 0) {
		if (poll(&wait, 1, (int)(left * 1e3) + 1) <= 0)
			continue;
		n = read(child->out, bytes, sizeof bytes);
		if (n > 0)
			text_add_bytes(out, bytes, (size_t)n);
	}
	return n == 0;
}

/* The last line of the complaints: where programs say what it was. */
static void add_complaint(const struct child *child, struct text *out)
{
	char bytes[1024], shown[512], *line;
	off_t size = lseek(child->complaints, 0, SEEK_END);
	off_t from = size >= (off_t)sizeof bytes ? size - (off_t)sizeof bytes + 1 : 0;
	ssize_t n = pread(child->complaints, bytes, sizeof bytes - 1, from);

	while (n > 0 && bytes[n - 1] == '\n')
		n--;
	if (n <= 0)
		return;
	bytes[n] = '\0';
	line = strrchr(bytes, '\n');
	text_addf(out, ": %s", text_excerpt(line ? line + 1 : bytes, shown, sizeof shown));
}

/* Wait for a child that has closed its output, or is to be ended. */
static int finish(
	const struct child *child, const char *name, bool told, int seconds, struct error *err)
{
	struct text complaint = {0};
	int status = 0;

	if (!told)
		(void)kill(child->pid, SIGKILL);
	while (waitpid(child->pid, &status, 0) < 0 && errno == EINTR)
		;
	if (!told)
		return error_set(err, EX_UNAVAILABLE, "%s did not answer in %d s", name, seconds);
	if (status == 0)
		return 0;
	add_complaint(child, &complaint);
	if (WIFSIGNALED(status))
		error_set(err, EX_UNAVAILABLE, "%s was ended by signal %d%s", name, WTERMSIG(status),
			text_string(&complaint));
	else
		error_set(err, EX_UNAVAILABLE, "%s ended with code %d%s", name, WEXITSTATUS(status),
			text_string(&complaint));
	text_clean(&complaint);
	return -1;
}

int process_run(const char *const *arguments, int seconds, struct text *out, struct error *err)
{
	struct child child;
	int result = start(&child, arguments, err);

	if (result == 0)
		result = finish(&child, arguments[0], read_all(&child, seconds, out), seconds, err);
	if (child.out >= 0)
		(void)close(child.out);
	if (child.complaints >= 0)
		(void)close(child.complaints);
	if (result == 0 && out->failed)
		return error_memory(err, out->capacity);
	return result;
}
