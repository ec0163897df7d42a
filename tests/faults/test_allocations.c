/* Whichever allocation of a command fails, in our code, HDF5, libyaml or libc: an error that says so, or
 * the right result; nothing crashes, leaks or is lost on disk. Some n of each command are tried; all of
 * them with $TALUS_EVERY_ALLOCATION (`make faults-long`), of the command $TALUS_ONLY and in the way
 * $TALUS_WAY alone where those are set. With an argument the commands are printed by which env does each. */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"

/* How the n-th allocation is made to fail. Leaks are looked for where only our own fail: HDF5 leaks its
 * own when they do. */
static const struct way {
	const char *name, *builds; /* where it can be used */
	int trials;                /* of each command in `make check` */
	const char *all;           /* the command of which all are tried there: one tells by a width */
	bool ours;                 /* no library's: then a crash is our own */
	const char *talus;         /* in the place of the program's name */
} ways[] = {
	{"ours", "plain asan ubsan", 12, "tables", true,
		"FAIL_OURS=1 LD_PRELOAD=$TOOLS/fail_alloc.so command talus"},
	{"all", "plain ubsan", 12, "", false, "LD_PRELOAD=$TOOLS/fail_alloc.so command talus"},
	{"valgrind", "plain", 2, "", true,
		"valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=definite,indirect "
		"--errors-for-leak-kinds=definite,indirect $TOOLS/talus-failing"},
};

/* Commands of the shell, each in a folder with small.yaml, study.yaml and what `prepare` makes. Without
 * `prepare` a trial leaves nothing that another one minds: the command is given once and forks into all. */
static const struct command {
	const char *name, *prepare, *command;
	const char *after; /* must succeed afterwards, in the same folder */
} commands[] = {
	{"check", NULL, "talus check small.yaml", "true"},
	{"start", "rm -rf run", "talus run -q small.yaml -o run",
		"talus run -q small.yaml -o run && talus diff run straight && talus verify run"},
	{"resume", "rm -rf run; cp -r stopped run", "talus run -q small.yaml -o run",
		"talus run -q small.yaml -o run && talus diff run straight && "
		"! grep -q started run/run.log"},
	{"longer", "rm -rf run; cp -r straight run", "talus run -q small.yaml -s time.end=0.2 -o run",
		"talus run -q small.yaml -s time.end=0.2 -o run && talus diff run long && talus verify run "
		"&& "
		"test $(grep -c started run/run.log) = 1"},
	{"info", NULL, "talus info straight", "true"},
	{"verify", NULL, "talus verify straight", "true"},
	{"diff", NULL, "talus diff straight stopped", "true"},
	{"dry-run", NULL, "talus campaign run --dry-run study.yaml", "true"},
	{"status", NULL, "talus campaign status --json study.yaml", "true"},
	{"why", NULL, "talus campaign why study.yaml layers-3", "true"},
	{"watch", NULL, "talus campaign watch study.yaml", "true"},
	{"prune", NULL, "talus campaign prune study.yaml -s rheology.mu_s=0.47 </dev/null", "true"},
	{"tables", NULL, "talus tables study.yaml", "true"},
	{"plot", NULL, "talus plot -f svg -o drawn straight", "! ls -A drawn | grep '^[.]'"},
	{"figures", NULL, "talus plot -f svg -o drawn study.yaml", "! ls -A drawn | grep '^[.]'"},
	{"campaign", "rm -rf c", "talus campaign run -j 1 -o c study.yaml | sed 's/[0-9.]* s CPU//'",
		"talus campaign run -o c study.yaml && talus diff c/layers-2* results/study/layers-2*"},
};

static const char setup[] =
	"cat >small.yaml <<END\n"
	"slope: 0 rad\n" /* angles in degrees have other bits below valgrind, which has no long double */
	"rheology: {mu_s: 0.48, mu_2: 0.73}\n"
	"erodible_bed_thickness: 0.002 m\n"
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
	"tables: [{name: t, rows: pressure, columns: layers, metric: [steps, runout, l2-difference],\n"
	"          reference: {layers: 3}}]\n"
	"plots: [{name: p, panels: [{kind: metric, x: layers, y: runout}, {kind: profile, y: h, at: "
	"all, lines: [layers, at]}]}]\n"
	"END\n"
	"talus run -q small.yaml -o straight\n"
	"talus run -q small.yaml -o long -s time.end=0.2\n"
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

/* Which allocation failed, and what became of the command. */
struct trial {
	char n[32];
	int code;
	char out[64], err[64]; /* files */
};

/* Give the command once with `setting` in its environment. Its exit code; stdout and stderr in files. */
static int give(const struct command *c, const struct way *way, const char *setting)
{
	char line[8192];

	(void)snprintf(line, sizeof line,
		"{ %s; } >/dev/null 2>&1; set -o pipefail; "
		"talus() { COUNT_ALLOC=$PWD/count %s %s \"$@\"; }; { %s; } >stdout 2>stderr",
		c->prepare ? c->prepare : "rm -rf drawn trials && mkdir trials", setting, way->talus,
		c->command);
	assert_int_equal(setenv("LINE", line, 1), 0);
	return run("exec bash -c \"$LINE\"");
}

static bool is_well_after(const struct command *c)
{
	assert_int_equal(setenv("LINE", c->after, 1), 0);
	return !strcmp(c->after, "true") || run("exec bash -c \"{ $LINE; } >after 2>&1\"") == 0;
}

/* Is what the command did with this allocation failing what it may do? */
static bool judge(const struct command *c, const struct way *way, const struct trial *trial,
	const char *reference)
{
	char *out = contents(trial->out), *err = contents(trial->err);
	const char *fault = NULL;

	if (trial->code != EX_SOFTWARE && trial->code != 0)
		fault = "the exit code";
	else if (trial->code == EX_SOFTWARE && !strstr(err, "memory"))
		fault = "the message, without a word of memory,";
	else if (way->ours && (strstr(err, "ended by a fault") || strstr(err, "gave up")))
		fault = "a crash";
	else if (trial->code == 0 && strcmp(out, reference) != 0)
		fault = "the result";
	else if (c->prepare && !is_well_after(c))
		fault = "what is left";
	if (fault)
		print_message("# %s, %s, allocation %s: %s is wrong; exit code %d: %s\n", c->name,
			way->name, trial->n, fault, trial->code, err);
	free(out);
	free(err);
	return !fault;
}

struct tally {
	long trials, told, faults;
};

static void add_trial(const struct command *c, const struct way *way, const struct trial *trial,
	const char *reference, int expected, struct tally *tally)
{
	tally->trials++;
	tally->told += trial->code == EX_SOFTWARE;
	if (trial->code != 1 || expected != 1) /* two runs that differ are 1 */
		tally->faults += !judge(c, way, trial, reference);
}

/* Trials one by one. */
static void try_each(const struct command *c, const struct way *way, const char *reference,
	int expected, long count, long stride, struct tally *tally)
{
	for (long i = 1 + stride / 2; i <= count; i += stride) {
		struct trial trial = {.out = "stdout", .err = "stderr"};
		char setting[64];

		(void)snprintf(trial.n, sizeof trial.n, "%ld%s", i, i / stride % 4 == 3 ? "+" : "");
		(void)snprintf(setting, sizeof setting, "FAIL_ALLOC=%s", trial.n);
		trial.code = give(c, way, setting);
		add_trial(c, way, &trial, reference, expected, tally);
	}
}

/* All trials at once. */
static void try_forks(const struct command *c, const struct way *way, const char *reference,
	int expected, long stride, struct tally *tally)
{
	struct trial trial;
	char setting[64], *codes, *rest = NULL;

	(void)snprintf(setting, sizeof setting, "FAIL_EVERY=%ld", stride);
	assert_int_equal(give(c, way, setting), expected);
	codes = contents("trials/codes");
	for (char *line = strtok_r(codes, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
		char *code = strchr(line, ' ');

		assert_non_null(code);
		(void)snprintf(trial.n, sizeof trial.n, "%.*s", (int)(code - line), line);
		trial.code = (int)strtol(code, NULL, 10);
		(void)snprintf(trial.out, sizeof trial.out, "trials/%ld.out", strtol(trial.n, NULL, 10));
		(void)snprintf(trial.err, sizeof trial.err, "trials/%ld.err", strtol(trial.n, NULL, 10));
		add_trial(c, way, &trial, reference, expected, tally);
	}
	if (!is_well_after(c))
		fail_msg("%s, %s: what is left is wrong: %s", c->name, way->name, contents("after"));
	free(codes);
}

static void try_command(const struct command *c, const struct way *way)
{
	int expected = give(c, way, "");
	char *reference = contents("stdout"), *counted = contents("count");
	long count = strtol(counted, NULL, 10);
	bool all = getenv("TALUS_EVERY_ALLOCATION") || !strcmp(way->all, c->name);
	long stride = all ? 1 : 1 + count / way->trials;
	struct tally tally = {0};

	assert_in_range(expected, 0, 1);
	assert_in_range(count, 12, 1000000);
	if (c->prepare)
		try_each(c, way, reference, expected, count, stride, &tally);
	else
		try_forks(c, way, reference, expected, stride, &tally);
	print_message("# %s, %s: %ld allocations, %ld of %ld trials told an error\n", c->name,
		way->name, count, tally.told, tally.trials);
	assert_int_equal(tally.faults, 0);
	assert_true(tally.told > 0 || tally.trials < 4);
	free(counted);
	free(reference);
}

static void any_allocation_may_fail(void **state)
{
	const char *build = getenv("SANITIZER"), *only = getenv("TALUS_ONLY"),
			   *way = getenv("TALUS_WAY");

	(void)state;
	for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
		for (size_t k = 0; k < sizeof ways / sizeof *ways; k++)
			if ((!only || !strcmp(only, commands[i].name)) &&
				(!way || !strcmp(way, ways[k].name)) &&
				strstr(ways[k].builds, build ? build : "plain"))
				try_command(&commands[i], &ways[k]);
}

static int enter_folder(void **state)
{
	static char folder[256], tools[1024];
	const char *parent = getenv("TMPDIR");
	ssize_t length = readlink("/proc/self/exe", tools, sizeof tools - 1);

	(void)snprintf(folder, sizeof folder, "%.200s/talus-test-XXXXXX", parent ? parent : "/tmp");
	if (length < 0 || !mkdtemp(folder) || chdir(folder))
		return -1;
	*strrchr(tools, '/') = '\0';
	*state = folder;
	return setenv("TOOLS", tools, 1) || setenv("LINE", setup, 1) || run("exec bash -ec \"$LINE\"");
}

static int leave_folder(void **state)
{
	char command[300];

	(void)snprintf(command, sizeof command, "rm -rf '%s'", (char *)*state);
	return chdir("/") || run(command);
}

int main(int argc, char **argv)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(any_allocation_may_fail, enter_folder, leave_folder)};

	if (argc == 1)
		return cmocka_run_group_tests(tests, NULL, NULL);
	for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
		for (size_t k = 0; k < sizeof ways / sizeof *ways; k++)
			(void)printf(
				"TALUS_ONLY=%s TALUS_WAY=%s %s\n", commands[i].name, ways[k].name, argv[0]);
	return 0;
}
