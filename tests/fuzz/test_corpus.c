/* The committed corpora once more, and texts that are made to take long. */
#include "targets.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/file.h"

/* Feed every file of tests/fuzz/corpus/NAME to a target. */
static void replay(const char *name, int (*target)(const uint8_t *, size_t))
{
	const char *root = getenv("TALUS_ROOT");
	struct dirent **entries;
	char folder[4096], path[4400];
	int count, fed = 0;

	assert_non_null(root);
	(void)snprintf(folder, sizeof folder, "%s/tests/fuzz/corpus/%s", root, name);
	count = scandir(folder, &entries, NULL, alphasort);
	for (int i = 0; i < count; i++) {
		struct error err = {0};
		unsigned char *bytes;
		size_t size;

		(void)snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
		if (entries[i]->d_name[0] != '.' && file_read(path, &bytes, &size, &err) == 0) {
			(void)target(bytes, size);
			free(bytes);
			fed++;
		}
		free(entries[i]);
	}
	free(entries);
	assert_in_range(fed, 5, 1000);
}

static void configs_are_replayed(void **state)
{
	(void)state;
	replay("config", fuzz_config);
}

static void experiments_are_replayed(void **state)
{
	(void)state;
	replay("experiment", fuzz_experiment);
}

static void run_files_are_replayed(void **state)
{
	(void)state;
	replay("run_file", fuzz_run_file);
}

static long peak_kilobytes(void)
{
	struct rusage usage;

	assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
	return usage.ru_maxrss;
}

/* A mebibyte of one thing after another, which is as much as is read. */
static void text_that_is_made_to_take_long_does_not(void **state)
{
	static const char *const parts[] = {"[", "{", "- ", "? ", ": ", "a: ", "a: {", "[a, ",
		"a: [b, ", "&a ", "*a ", "&a [*a, ", "!a ", "!<a> ", "'", "\"", "\"\\", "'a' ", "|\n",
		">\n ", "a\n", "a ", "#\n", "%a\n", "---\n", "...\n", "a: &a\n", "<<: *a\n", "\n", " ",
		"\t", "- - - - a\n", "? - a\n", "{a, ", "{a: b, ", "a: 'b\n", "\xEF\xBB\xBF",
		"\xF4\x8F\xBF\xBF", "- a\n", "a: b\nc: d\n", "layers: [1, 2, 3, 4]\n",
		"runs: [{layers: [2]}]\n"};
	static const char *const before[] = {"", "a: ", "runs:\n"};
	enum { SIZE = 1 << 20 };
	char *text = malloc(SIZE + 64);
	long peak = peak_kilobytes();

	(void)state;
	assert_non_null(text);
	for (size_t b = 0; b < sizeof before / sizeof *before; b++)
		for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
			size_t part = strlen(parts[p]), used = strlen(before[b]);
			double start = clock_cpu();
			struct config config;
			struct error err = {0};

			memcpy(text, before[b], used);
			for (; used + part <= SIZE; used += part)
				memcpy(text + used, parts[p], part);
			assert_int_equal(config_parse(&config, text, used, "long", NULL, 0, &err), -1);
			assert_int_equal(err.code, EX_DATAERR);
			if (clock_cpu() - start > 5)
				fail_msg("'%s' after '%s' took %g s", parts[p], before[b], clock_cpu() - start);
		}
	free(text);
	/* a sanitizer keeps what is freed for a while */
	assert_in_range(peak_kilobytes() - peak, 0, getenv("SANITIZER") ? 1 << 20 : 128 << 10);
}

static void a_hundred_megabytes_are_refused_unread(void **state)
{
	static const char *const names[] = {"large.yaml", "/dev/zero", "/dev/urandom"};
	double start = clock_cpu();

	(void)state;
	enter_folder();
	write_input("large.yaml", (const uint8_t *)"#", 1);
	assert_int_equal(truncate("large.yaml", 100000000), 0);
	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		struct experiment experiment;
		struct config config;
		struct error err = {0}, second = {0};

		assert_int_equal(config_read(&config, names[i], NULL, 0, &err), -1);
		assert_int_equal(err.code, EX_DATAERR);
		assert_int_equal(experiment_read(&experiment, names[i], "x", NULL, 0, &second), -1);
		assert_int_equal(second.code, EX_DATAERR);
		experiment_clean(&experiment);
	}
	assert_true(clock_cpu() - start < 5);
}

/* The targets leave their folder to us. */
static int remove_folder(void **state)
{
	char folder[4096];

	(void)state;
	enter_folder();
	if (!getcwd(folder, sizeof folder) || strncmp(folder, "/tmp/talus-fuzz-", 16) != 0)
		return -1;
	(void)unlink("base.yaml");
	(void)unlink("fuzz.yaml");
	(void)unlink("run.h5");
	(void)unlink("large.yaml");
	return chdir("/") || rmdir(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(configs_are_replayed),
		cmocka_unit_test(experiments_are_replayed),
		cmocka_unit_test(run_files_are_replayed),
		cmocka_unit_test(text_that_is_made_to_take_long_does_not),
		cmocka_unit_test(a_hundred_megabytes_are_refused_unread),
	};

	return cmocka_run_group_tests(tests, NULL, remove_folder);
}
