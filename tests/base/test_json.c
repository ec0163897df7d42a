/* JSON values. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/json.h"

static void assert_string_is(const char *string, const char *expected)
{
	struct text out = {0};

	json_add_string(&out, string);
	assert_string_equal(text_string(&out), expected);
	text_clean(&out);
}

static void marks_and_controls_are_escaped(void **state)
{
	(void)state;
	assert_string_is("", "\"\"");
	assert_string_is("a\"b\\c/", "\"a\\\"b\\\\c/\"");
	assert_string_is("a\nb\x01", "\"a\\u000ab\\u0001\"");
}

static void characters_stay_and_broken_ones_are_replaced(void **state)
{
	(void)state;
	assert_string_is("\u00e9 \u20ac \U0001f600", "\"\u00e9 \u20ac \U0001f600\"");
	assert_string_is("a\xff", "\"a\\ufffd\"");
	assert_string_is("\xe2\x82", "\"\\ufffd\\ufffd\"");
	assert_string_is("\xc0\x80", "\"\\ufffd\\ufffd\"");
	assert_string_is("\xed\xa0\x80", "\"\\ufffd\\ufffd\\ufffd\"");
	assert_string_is("\xf4\x90\x80\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\"");
}

static void what_is_no_number_is_null(void **state)
{
	struct text out = {0};

	(void)state;
	json_add_real(&out, 0.1);
	json_add_real(&out, NAN);
	json_add_real(&out, -INFINITY);
	assert_string_equal(text_string(&out), "0.1nullnull");
	text_clean(&out);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(marks_and_controls_are_escaped),
		cmocka_unit_test(characters_stay_and_broken_ones_are_replaced),
		cmocka_unit_test(what_is_no_number_is_null),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
