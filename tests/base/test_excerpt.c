/* A user's text as messages show it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "talus/text.h"

static void short_text_is_shown_whole(void **state)
{
	char buffer[8];

	(void)state;
	assert_string_equal(text_excerpt("", buffer, sizeof buffer), "");
	assert_string_equal(text_excerpt("1234567", buffer, sizeof buffer), "1234567");
}

static void long_text_is_cut_with_dots(void **state)
{
	char buffer[8];

	(void)state;
	assert_string_equal(text_excerpt("12345678", buffer, sizeof buffer), "1234...");
}

static void a_cut_does_not_split_a_character(void **state)
{
	char buffer[8];

	(void)state;
	assert_string_equal(text_excerpt("123\xC3\xA9xxxx", buffer, sizeof buffer), "123...");
}

static void control_characters_are_masked(void **state)
{
	char buffer[16];

	(void)state;
	assert_string_equal(text_excerpt("a\nb\033[1m\x7F\tc", buffer, sizeof buffer), "a?b?[1m? c");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(short_text_is_shown_whole),
		cmocka_unit_test(long_text_is_cut_with_dots),
		cmocka_unit_test(a_cut_does_not_split_a_character),
		cmocka_unit_test(control_characters_are_masked),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
