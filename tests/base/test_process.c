/* Other programs: what they print, how they end, and that nobody waits for them for ever. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/process.h"

static void what_it_prints_is_read_and_its_arguments_are_no_shell_words(void **state)
{
	const char *const echo[] = {"echo", "$(id); 'a b'", NULL};
	struct error err = {0};
	struct text out = {0};

	(void)state;
	assert_int_equal(process_run(echo, 10, &out, &err), 0);
	assert_string_equal(text_string(&out), "$(id); 'a b'\n");
	text_clean(&out);
}

static void more_than_a_pipe_holds_is_read(void **state)
{
	const char *const head[] = {"head", "-c", "1000000", "/dev/zero", NULL};
	struct error err = {0};
	struct text out = {0};

	(void)state;
	assert_int_equal(process_run(head, 60, &out, &err), 0);
	assert_int_equal(out.length, 1000000);
	text_clean(&out);
}

static void an_end_that_is_not_good_is_told(void **state)
{
	static const struct {
		const char *script, *text;
	} cases[] = {
		{"echo first >&2; echo '  last' >&2; exit 3", "sh ended with code 3:   last"},
		{"exit 1", "sh ended with code 1"},
		{"kill -9 $$", "sh was ended by signal 9"},
		{"head -c 100000 /dev/zero | tr '\\0' x >&2; printf '\\nlong\\n\\n' >&2; exit 1",
			"sh ended with code 1: long"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		const char *const sh[] = {"sh", "-c", cases[i].script, NULL};
		struct error err = {0};
		struct text out = {0};

		assert_int_equal(process_run(sh, 10, &out, &err), -1);
		assert_int_equal(err.code, EX_UNAVAILABLE);
		assert_string_equal(err.text, cases[i].text);
		text_clean(&out);
	}
}

static void a_program_that_is_not_there_is_named(void **state)
{
	const char *const absent[] = {"no-such-program", NULL};
	struct error err = {0};
	struct text out = {0};

	(void)state;
	assert_int_equal(process_run(absent, 10, &out, &err), -1);
	assert_int_equal(err.code, EX_UNAVAILABLE);
	assert_string_equal(err.text, "no-such-program is needed and is not on PATH");
}

static void a_program_that_does_not_answer_is_not_waited_for(void **state)
{
	const char *const sleep[] = {"sleep", "60", NULL};
	double begin = clock_wall();
	struct error err = {0};
	struct text out = {0};

	(void)state;
	assert_int_equal(process_run(sleep, 1, &out, &err), -1);
	assert_string_equal(err.text, "sleep did not answer in 1 s");
	assert_true(clock_wall() - begin < 30);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(what_it_prints_is_read_and_its_arguments_are_no_shell_words),
		cmocka_unit_test(more_than_a_pipe_holds_is_read),
		cmocka_unit_test(an_end_that_is_not_good_is_told),
		cmocka_unit_test(a_program_that_is_not_there_is_named),
		cmocka_unit_test(a_program_that_does_not_answer_is_not_waited_for),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
