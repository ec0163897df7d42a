#include "plots/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

/* The script as a file that has no name: a pipe could block, and break. */
static int write_script(int fd, const struct text *script, struct error *err)
{
	size_t done = 0;

	while (done < script->length) {
		ssize_t count = write(fd, script->data + done, script->length - done);

		if (count < 0 && errno == EINTR)
			continue;
		if (count <= 0)
			return error_set(
				err, EX_SOFTWARE, "the script of a figure cannot be kept: %s", strerror(errno));
		done += (size_t)count;
	}
	(void)lseek(fd, 0, SEEK_SET);
	return 0;
}

static int start(int input, int output, pid_t *pid, struct error *err)
{
	/* -d: the settings of whoever runs it would change the figure, or do something else */
	char *const arguments[] = {"gnuplot", "-d", "-", NULL};
	posix_spawn_file_actions_t actions;
	int failure = posix_spawn_file_actions_init(&actions);

	if (failure)
		return error_memory(err, sizeof actions);
	if (posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO) ||
		posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO) ||
		posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO)) {
		error_memory(err, sizeof actions);
		failure = -1;
	} else {
		failure = posix_spawnp(pid, "gnuplot", &actions, NULL, arguments, environ);
	}
	(void)posix_spawn_file_actions_destroy(&actions);
	if (failure > 0)
		return error_set(err, EX_UNAVAILABLE,
			"figures are drawn by gnuplot, which cannot be started: %s; "
			"`scripts/deps plot` installs it (Debian: gnuplot-nox)",
			strerror(failure));
	return failure;
}

/* Its first words that say what is wrong, in one line. */
static void read_complaint(int fd, char *complaint, size_t size)
{
	char text[4096], *at;
	ssize_t count = pread(fd, text, sizeof text - 1, 0);

	text[count > 0 ? count : 0] = '\0';
	/* it shows the line, points at it, and then tells why */
	at = strstr(text, "line ");
	(void)text_excerpt(at ? at : text + strspn(text, " \n"), complaint, size);
}

static int judge(int status, int output, struct error *err)
{
	char complaint[300];

	if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
		return 0;
	if (WIFSIGNALED(status))
		return error_set(err, EX_SOFTWARE, "gnuplot was ended by signal %d", WTERMSIG(status));
	read_complaint(output, complaint, sizeof complaint);
	if (WEXITSTATUS(status) == 127 || strstr(complaint, "terminal"))
		return error_set(err, EX_UNAVAILABLE,
			"this gnuplot cannot draw SVG, PNG and PDF (%s); Debian's gnuplot-nox can", complaint);
	return error_set(err, EX_SOFTWARE, "gnuplot failed: %s", complaint);
}

int gnuplot_run(const struct text *script, struct error *err)
{
	int input = memfd_create("talus-figure", MFD_CLOEXEC);
	int output = memfd_create("talus-gnuplot", MFD_CLOEXEC);
	int status = 0, result = -1;
	pid_t pid = -1;

	if (input < 0 || output < 0) {
		error_set(err, EX_SOFTWARE, "no file in memory: %s", strerror(errno));
		goto done;
	}
	(void)fflush(NULL);
	if (write_script(input, script, err) || start(input, output, &pid, err))
		goto done;
	while (waitpid(pid, &status, 0) < 0)
		if (errno != EINTR) {
			error_set(err, EX_SOFTWARE, "gnuplot is lost: %s", strerror(errno));
			goto done;
		}
	result = judge(status, output, err);
done:
	if (input >= 0)
		(void)close(input);
	if (output >= 0)
		(void)close(output);
	return result;
}
