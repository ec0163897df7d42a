/* Quantities: what is read, to which bits, and what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "config/quantity.h"

enum { PAD = 200 };

static void quantities_read_as_si(void **state)
{
	static const struct {
		const char *text, *unit;
		double value;
	} cases[] = {
		{"0.14", "m", 0.14},
		{"1.82 mm", "m", 0.00182},
		{"1.82mm", "m", 0.00182},
		{"  1.82\t mm ", "m", 0.00182},
		{"0.7 mm", "m", 0.0007},
		{"1.5e2 cm", "m", 1.5},
		{"250 um", "m", 0.00025},
		{"1.2 km", "m", 1200},
		{"-.5 m", "m", -0.5},
		{"+3. m", "m", 3},
		{"-0", "m", 0},
		{"3 s", "s", 3},
		{"20 ms", "s", 0.02},
		{"7 us", "s", 7e-6},
		{"2 min", "s", 120},
		{"1.5 h", "s", 5400},
		{"22 deg", "rad", 0.38397243543875248},
		{"180 deg", "rad", 3.141592653589793},
		{"0.38 rad", "rad", 0.38},
		{"2500 kg/m3", "kg/m3", 2500},
		{"2.65 g/cm3", "kg/m3", 2650},
		{"1e-5 1/s", "1/s", 1e-5},
		{"1E-5 m/s", "m/s", 1e-5},
		{"3 mm/s", "m/s", 0.003},
		{"4 cm/s", "m/s", 0.04},
		{"1e-6 m2/s2", "m2/s2", 1e-6},
		{"0.62", "1", 0.62},
		{"tan(45 deg)", "1", 1},
		{"tan( 0.25 rad )", "1", 0.25534192122103627},
		{"tan(25.5 deg)", "1", 0.47697553269816},
		{"1e-310 m", "m", 1e-310},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct error err = {0};
		double value = -1;

		if (quantity_read(cases[i].text, cases[i].unit, &value, &err) != 0)
			fail_msg("%s: %s", cases[i].text, err.text);
		/* tan is the one that the C library may round in another way */
		if (strncmp(cases[i].text, "tan", 3) != 0)
			assert_memory_equal(&value, &cases[i].value, sizeof value);
		else
			assert_true(fabs(value - cases[i].value) < 1e-14);
	}
}

static void decimal_units_round_once(void **state)
{
	(void)state;
	for (int i = 1; i < 5000; i++) {
		struct error err = {0};
		struct text mm = {0}, plain = {0};
		double value = 0;

		text_addf(&mm, "%d.%03d mm", i / 7, i % 1000);
		text_addf(&plain, "%d.%03de-3", i / 7, i % 1000);
		assert_int_equal(quantity_read(text_string(&mm), "m", &value, &err), 0);
		assert_true(value == strtod(text_string(&plain), NULL));
		text_clean(&mm);
		text_clean(&plain);
	}
}

static void bad_quantities_are_refused_with_the_reason(void **state)
{
	static const struct {
		const char *text, *unit, *message;
	} cases[] = {
		{"", "m", "the value is missing"},
		{" \t", "m", "the value is missing"},
		{"nan", "m", "nan is not a finite decimal number"},
		{"NaN m", "m", "NaN m is not a finite decimal number"},
		{"inf", "m", "inf is not a finite decimal number"},
		{"-inf s", "s", "-inf s is not a finite decimal number"},
		{".inf", "m", ".inf is not a finite decimal number"},
		{"0x1p3", "m", "0x1p3 is not a finite decimal number"},
		{"0X10 m", "m", "0X10 m is not a finite decimal number"},
		{".", "m", ". is not a finite decimal number"},
		{"--1", "m", "--1 is not a finite decimal number"},
		{"e5", "1", "e5 is not a finite decimal number"},
		{"wide", "m", "wide is not a finite decimal number"},
		{"1,5 m", "m", "1,5 m: unknown unit ',5 m'; a length is given in m, km, cm, mm or um"},
		{"100x", "1", "100x: unknown unit 'x'; a plain number has no unit"},
		{"1e", "1", "1e: unknown unit 'e'; a plain number has no unit"},
		{"0.5 1", "1", "0.5 1: unknown unit '1'; a plain number has no unit"},
		{"3 parsec", "m",
			"3 parsec: unknown unit 'parsec'; a length is given in m, km, cm, mm or um"},
		{"3 MM", "m", "3 MM: unknown unit 'MM'; a length is given in m, km, cm, mm or um"},
		{"3 mm mm", "m", "3 mm mm: unknown unit 'mm mm'; a length is given in m, km, cm, mm or um"},
		{"3 s", "m", "3 s is a time; a length is given in m, km, cm, mm or um"},
		{"3 m", "s", "3 m is a length; a time is given in s, ms, us, min or h"},
		{"3 m/s", "1/s", "3 m/s is a speed; a rate is given in 1/s"},
		{"0.6 m", "1", "0.6 m is a length; a plain number has no unit"},
		{"25 deg", "1", "25 deg is an angle; a plain number has no unit"},
		{"22", "rad", "22 has no unit; an angle must say deg or rad, as in 22 deg"},
		{"0", "rad", "0 has no unit; an angle must say deg or rad, as in 0 deg"},
		{"22 m", "rad", "22 m is a length; an angle is given in rad or deg"},
		{"tan(25 deg)", "rad", "tan(25 deg) is not a finite decimal number"},
		{"tan(25)", "1", "tan(25): 25 has no unit; an angle must say deg or rad, as in 25 deg"},
		{"tan(25 m)", "1", "tan(25 m): 25 m is a length; an angle is given in rad or deg"},
		{"tan()", "1", "tan(): the value is missing"},
		{"tan(25 deg", "1", "tan(25 deg: the bracket is not closed at the end"},
		{"tan(25 deg) 2", "1", "tan(25 deg) 2: the bracket is not closed at the end"},
		{"tan(", "1", "tan(: the bracket is not closed at the end"},
		{"1e400", "m", "1e400 is beyond what a double can hold"},
		{"-1e99999999999999999999", "m",
			"-1e99999999999999999999 is beyond what a double can hold"},
		{"1e-400", "m", "1e-400 is beyond what a double can hold"},
		{"1e308 km", "m", "1e308 km is beyond what a double can hold"},
		{"1e308 h", "s", "1e308 h is beyond what a double can hold"},
		{"1\n2", "m", "1?2: unknown unit '?2'; a length is given in m, km, cm, mm or um"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct error err = {0};
		double value = -1;

		assert_int_equal(quantity_read(cases[i].text, cases[i].unit, &value, &err), -1);
		assert_int_equal(err.code, EX_DATAERR);
		assert_string_equal(err.text, cases[i].message);
	}
}

static void a_long_text_is_no_number(void **state)
{
	char digits[PAD + 1];
	struct error err = {0};
	double value;

	(void)state;
	memset(digits, '1', PAD);
	digits[PAD] = '\0';
	assert_int_equal(quantity_read(digits, "m", &value, &err), -1);
	assert_non_null(strstr(err.text, "1111... is too long for a number"));
}

static void a_printed_quantity_reads_back_to_the_same_bits(void **state)
{
	static const double values[] = {
		0, 0.1, 1.0 / 3, 0.38397243543875248, 1e-5, 1e300, 5e-324, -0.2};

	(void)state;
	for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
		struct error err = {0};
		struct text text = {0};
		double value = -1;

		quantity_print(values[i], i % 2 ? "rad" : "1", &text);
		assert_int_equal(quantity_read(text_string(&text), i % 2 ? "rad" : "1", &value, &err), 0);
		assert_memory_equal(&value, &values[i], sizeof value);
		text_clean(&text);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(quantities_read_as_si),
		cmocka_unit_test(decimal_units_round_once),
		cmocka_unit_test(bad_quantities_are_refused_with_the_reason),
		cmocka_unit_test(a_long_text_is_no_number),
		cmocka_unit_test(a_printed_quantity_reads_back_to_the_same_bits),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
