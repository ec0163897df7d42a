/* A run file that is damaged, at any byte and cut at any length, never leads to a crash, to a wrong value
 * or to a run that goes on wrongly. */
#include "../run/logistic.h"

#include "base/file.h"

static const char settings[] = "checkpoint.every_steps=15;time.end=0.4";

/* A run that was stopped, and one that never was; the two generations of the first. */
struct scene {
	struct config config;
	unsigned char *newest, *previous;
	size_t newest_size, previous_size;
	uint64_t step[2]; /* of newest and previous */
};

static void put(const char *name, const unsigned char *bytes, size_t size)
{
	const struct file_place place = {.folder = in_folder("a"), .name = name};
	struct error err = {0};

	assert_int_equal(file_replace(&place, &(struct file_part){bytes, size}, 1, &err), 0);
}

static void begin(struct scene *s)
{
	struct run_summary summary;
	struct error err = {0};

	*s = (struct scene){.config = logistic_config(settings)};
	must_execute(&s->config, "straight");
	logistic.number = SIGTERM;
	logistic.raise_at[0] = 20;
	assert_int_equal(execute_in_child(&s->config, "a", false), EX_INTERRUPTED);
	logistic.raise_at[0] = 0;
	assert_int_equal(file_read(in_folder("a/run.h5"), &s->newest, &s->newest_size, &err), 0);
	assert_int_equal(
		file_read(in_folder("a/run.previous.h5"), &s->previous, &s->previous_size, &err), 0);
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &summary, &err), 0);
	s->step[0] = summary.step;
	assert_int_equal(run_file_peek(in_folder("a/run.previous.h5"), &summary, &err), 0);
	s->step[1] = summary.step;
	assert_int_equal(s->step[0], 20);
	assert_int_equal(s->step[1], 15);
}

static void end(struct scene *s)
{
	free(s->newest);
	free(s->previous);
}

/* The first place where the run went on; the log is removed. */
static uint64_t resumed_at(void)
{
	static const char words[] = "resumed at step ";
	uint64_t step;
	unsigned char *log = NULL;
	struct error err = {0};
	const char *told;
	size_t size;

	assert_int_equal(file_read(in_folder("a/run.log"), &log, &size, &err), 0);
	told = strstr((const char *)log, words);
	assert_non_null(told);
	step = told ? strtoull(told + strlen(words), NULL, 10) : 0;
	free(log);
	assert_int_equal(remove(in_folder("a/run.log")), 0);
	return step;
}

/* With this newest generation the run goes on from the previous one, to the same bits. */
static void assert_falls_back(const struct scene *s, const unsigned char *bytes, size_t size)
{
	(void)remove(in_folder("a/run.log"));
	put("run.h5", bytes, size);
	put("run.previous.h5", s->previous, s->previous_size);
	must_execute(&s->config, "a");
	assert_int_equal(resumed_at(), s->step[1]);
	assert_same_bits("straight", "a");
}

static void a_flipped_bit_anywhere_is_never_resumed_from(void **state)
{
	uint32_t random = 1;
	struct scene s;

	(void)state;
	begin(&s);
	for (int i = 0; i < 150; i++) {
		size_t at = (random >> 4) % s.newest_size;
		unsigned char mask = (unsigned char)(1U << (random & 7));

		s.newest[at] ^= mask;
		assert_falls_back(&s, s.newest, s.newest_size);
		s.newest[at] ^= mask;
		random = random * 1664525U + 1013904223U;
	}
	end(&s);
}

static void a_cut_file_is_never_resumed_from(void **state)
{
	struct scene s;

	(void)state;
	begin(&s);
	for (size_t size = 0; size < s.newest_size; size += 512)
		assert_falls_back(&s, s.newest, size);
	end(&s);
}

static void two_damaged_generations_are_an_error_until_retry(void **state)
{
	struct error err = {0};
	struct scene s;

	(void)state;
	begin(&s);
	put("run.h5", s.newest, s.newest_size - 1);
	put("run.previous.h5", s.previous, s.previous_size / 2);
	assert_int_equal(execute(&s.config, "a", false, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_non_null(strstr(err.text, "--retry starts it anew"));
	err = (struct error){0};
	assert_int_equal(execute(&s.config, "a", true, &err), 0);
	assert_same_bits("straight", "a");
	assert_true(file_exists(in_folder("a/run.damaged.h5")));
	assert_true(file_exists(in_folder("a/run.previous.damaged.h5")));
	end(&s);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
	const struct CMUnitTest tests[] = {
		TEST(a_flipped_bit_anywhere_is_never_resumed_from),
		TEST(a_cut_file_is_never_resumed_from),
		TEST(two_damaged_generations_are_an_error_until_retry),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
