/* Whichever allocation of a command fails, in our code, HDF5, libyaml or libc: an error that says so, or
 * the right result; nothing crashes, leaks (in the build for that) or is lost on disk. Each trial is a
 * process with fail_alloc.so preloaded. Some n of each command are tried; all of them with
 * $TALUS_EVERY_ALLOCATION (`make faults-long`). In the build that sees leaks only our own allocations fail:
 * HDF5 leaks its own when they do. */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"

/* Trials of a command: of our own allocations, and of those of the libraries as well. */
enum { OURS = 12, ALL = 12 };

static char preload[1024]; /* path of fail_alloc.so */

/* Commands of the shell, each in a folder with small.yaml, study.yaml and what `prepare` makes. */
static const struct command {
	const char *name, *prepare, *command;
	const char *after; /* must succeed after every trial, in the same folder */
} commands[] = {
	{"check", "true", "talus check small.yaml", "true"},
	{"start", "rm -rf run", "talus run small.yaml -o run",
		"talus run -q small.yaml -o run && talus diff run straight && talus verify run"},
	{"resume", "rm -rf run; cp -r stopped run", "talus run small.yaml -o run",
		"talus run -q small.yaml -o run && talus diff run straight && "
		"! grep -q started run/run.log"},
	{"info", "true", "talus info straight", "true"},
	{"verify", "true", "talus verify straight", "true"},
	{"diff", "true", "talus diff straight stopped", "true"},
	{"dry-run", "true", "talus campaign run --dry-run study.yaml", "true"},
	{"status", "true", "talus campaign status --json study.yaml", "true"},
	{"tables", "true", "talus-tables study.yaml", "true"},
	{"campaign", "rm -rf c", "talus campaign run -j 1 -o c study.yaml | sed 's/[0-9.]* s CPU//'",
		"talus campaign run -o c study.yaml && talus diff c/layers-2* results/study/layers-2*"},
};

static const char setup[] =
	"cat >small.yaml <<END\n"
	"slope: 22 deg\n"
	"erodible_bed_thickness: 2 mm\n"
	"layers: 2\n"
	"domain: {x_min: -0.1 m, x_max: 0.3 m, cells: 20}\n"
	"initial: {height: 0.05 m, front: 0 m}\n"
	"time: {end: 0.1 s}\n"
	"output: {profiles_at: [0.05 s, 0.1 s]}\n"
	"checkpoint: {every_steps: 2}\n"
	"END\n"
	"cat >study.yaml <<END\n"
	"base: small.yaml\n"
	"runs: [{layers: [2, 3]}]\n"
	"tables: [{name: t, rows: layers, metric: [steps, runout, l2-difference],\n"
	"          reference: {layers: 3}}]\n"
	"END\n"
	"talus run -q small.yaml -o straight\n"
	"mkdir stopped && cp straight/run.previous.h5 stopped/run.h5\n"
	"talus campaign run study.yaml >/dev/null\n";

static int run(const char *command)
{
	int status = system(command); /* NOLINT(cert-env33-c): a shell is what is wanted */

	return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static char *contents(const char *name)
{
	struct error err = {0};
	unsigned char *bytes;
	size_t size;

	if (file_read(name, &bytes, &size, &err) != 0)
		fail_msg("%s: %s", name, err.text);
	return (char *)bytes;
}

/* One trial: $FAIL_ALLOC is `n`, "" for none. Leaves stdout and stderr in files. */
static int attempt(const struct command *c, const char *n)
{
	char line[8192];

	(void)snprintf(line, sizeof line,
		"{ %s; } >/dev/null 2>&1; set -o pipefail; "
		"talus() { LD_PRELOAD=%s COUNT_ALLOC=$PWD/count FAIL_ALLOC=%s command talus \"$@\"; }; "
		"talus-tables() { LD_PRELOAD=%s COUNT_ALLOC=$PWD/count FAIL_ALLOC=%s command talus-tables "
		"\"$@\"; }; "
		"{ %s; } >stdout 2>stderr",
		c->prepare, preload, n, preload, n, c->command);
	assert_int_equal(setenv("LINE", line, 1), 0);
	return run("exec bash -c \"$LINE\"");
}

/* Is what the command did with this allocation failing what it may do? */
static void judge(const struct command *c, const char *n, int code, const char *reference)
{
	char *out = contents("stdout"), *err = contents("stderr");

	if (code != EX_SOFTWARE && code != 0)
		fail_msg("%s, allocation %s: exit code %d: %s", c->name, n, code, err);
	if (code == EX_SOFTWARE && !strstr(err, "memory"))
		fail_msg("%s, allocation %s: no word of memory: %s", c->name, n, err);
	if (code == 0 && strcmp(out, reference) != 0)
		fail_msg(
			"%s, allocation %s: exit code 0 and\n%s instead of\n%s", c->name, n, out, reference);
	if (setenv("LINE", c->after, 1) != 0 ||
		run("exec bash -c \"{ $LINE; } >stdout 2>stderr\"") != 0)
		fail_msg("%s, allocation %s: afterwards: %s", c->name, n, contents("stderr"));
	free(out);
	free(err);
}

static void try_command(const struct command *c, long trials)
{
	bool every = getenv("TALUS_EVERY_ALLOCATION") != NULL;
	int expected = attempt(c, "");
	char *reference = contents("stdout"), *counted = contents("count"), n[32];
	long count = strtol(counted, NULL, 10), told = 0;
	long stride = every ? 1 : 1 + count / trials;

	/* two runs that differ are 1, for which no trial can stand */
	assert_in_range(expected, 0, 1);
	assert_in_range(count, OURS, 1000000);
	for (long i = 1 + stride / 2; i <= count; i += stride) {
		(void)snprintf(n, sizeof n, "%ld%s", i, i / stride % 4 == 3 ? "+" : "");
		int code = attempt(c, n);

		if (code != 1 || expected != 1)
			judge(c, n, code, reference);
		told += code == EX_SOFTWARE;
	}
	print_message("# %s: %ld allocations%s, %ld errors told\n", c->name, count,
		getenv("FAIL_OURS") ? " of ours" : "", told);
	assert_true(told > 0);
	free(counted);
	free(reference);
}

static bool sees_leaks(void)
{
	const char *sanitizer = getenv("SANITIZER");

	return sanitizer && !strcmp(sanitizer, "asan");
}

static void any_allocation_may_fail(void **state)
{
	(void)state;
	for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
		const char *only = getenv("TALUS_ONLY");

		if (only && strcmp(only, commands[i].name) != 0)
			continue;
		assert_int_equal(setenv("FAIL_OURS", "1", 1), 0);
		try_command(&commands[i], OURS);
		assert_int_equal(unsetenv("FAIL_OURS"), 0);
		if (!sees_leaks())
			try_command(&commands[i], ALL);
	}
}

static int enter_folder(void **state)
{
	static char folder[] = "/tmp/talus-test-XXXXXX";
	ssize_t length = readlink("/proc/self/exe", preload, sizeof preload - 32);
	char *slash;

	if (length < 0 || !mkdtemp(folder) || chdir(folder))
		return -1;
	preload[length] = '\0';
	slash = strrchr(preload, '/');
	memcpy(slash + 1, "fail_alloc.so", sizeof "fail_alloc.so");
	*state = folder;
	return setenv("LINE", setup, 1) || run("exec bash -ec \"$LINE\"");
}

static int leave_folder(void **state)
{
	char command[64];

	(void)snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
	return chdir("/") || run(command);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(any_allocation_may_fail, enter_folder, leave_folder)};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
