/* Field tables on a struct of the test's own: what a row does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "config/field.h"
#include "talus/config.h"

struct pot {
	double height;
	struct {
		double mix;
		int colour;
	} glaze;
	int count;
	struct real_list fired_at;
};

static const char *const colours[] = {"red", "green", "blue", NULL};

static const struct field fields[] = {
	{"height", FIELD_REAL, FIELD_REQUIRED, offsetof(struct pot, height), "m", "10 cm", "(0, 1 m]",
		NULL, "of the pot", NULL},
	{"glaze", FIELD_GROUP, 0, 0, NULL, NULL, NULL, NULL, "its surface", NULL},
	{"glaze.mix", FIELD_REAL, 0, offsetof(struct pot, glaze.mix), "1", "0.5", "[0, 1)", NULL,
		"share of glass", NULL},
	{"glaze.colour", FIELD_CHOICE, 0, offsetof(struct pot, glaze.colour), NULL, "green", NULL,
		colours, "of the glaze", NULL},
	{"count", FIELD_INTEGER, FIELD_PASSIVE, offsetof(struct pot, count), NULL, "1", "[1, inf)",
		NULL, "pots made", NULL},
	{"fired_at", FIELD_REALS, 0, offsetof(struct pot, fired_at), "s", "[]", "(-inf, 1 h]", NULL,
		"times in the kiln", NULL},
};

static const struct field_table table = {fields, sizeof fields / sizeof *fields, NULL};

static int read_pot(struct pot *pot, const char *text, struct error *err)
{
	struct field_reader reader = {.table = &table};
	struct field_source source = {.name = "pot.yaml"};
	int status = -1;

	memset(pot, 0, sizeof *pot);
	if (yaml_parse(&source.root, text, strlen(text), source.name, err) == 0 &&
		field_collect(&reader, &source, &source.root, err) == 0)
		status = field_convert(&reader, pot, err);
	node_clean(&source.root);
	return status;
}

static void members_and_defaults_are_filled(void **state)
{
	struct pot pot;
	struct error err = {0};

	(void)state;
	assert_int_equal(
		read_pot(&pot, "glaze: {colour: blue}\nheight: 5 cm\nfired_at: [-1, 2 min]\n", &err), 0);
	assert_true(pot.height == 0.05);
	assert_true(pot.glaze.mix == 0.5);
	assert_int_equal(pot.glaze.colour, 2);
	assert_int_equal(pot.count, 1);
	assert_int_equal(pot.fired_at.count, 2);
	assert_non_null(pot.fired_at.values);
	assert_true(
		pot.fired_at.values && pot.fired_at.values[0] == -1 && pot.fired_at.values[1] == 120);
}

static void a_dotted_key_stands_for_nested_ones(void **state)
{
	struct pot pot;
	struct error err = {0};

	(void)state;
	assert_int_equal(
		read_pot(&pot, "glaze.mix: 0.25\nheight: 1 m\nglaze: {colour: red}\n", &err), 0);
	assert_true(pot.glaze.mix == 0.25);
	assert_int_equal(pot.glaze.colour, 0);
}

static void bad_input_is_refused_at_its_place(void **state)
{
	static const struct {
		const char *text, *message;
	} cases[] = {
		{"glaze:\n  mix: 0.5\n", "1:1: missing key 'height'; for example `height: 10 cm`"},
		{"height: 0 m\n", "1:9: height: 0 m is out of range; it must be above 0 and at most 1 m"},
		{"height: 101 cm\n",
			"1:9: height: 101 cm is out of range; it must be above 0 and at most 1 m"},
		{"height: 1\nglaze: {mix: 1}\n",
			"2:14: glaze.mix: 1 is out of range; it must be at least 0 and below 1"},
		{"height: 1\nglaze: {mix: -1e-9}\n",
			"2:14: glaze.mix: -1e-9 is out of range; it must be at least 0 and below 1"},
		{"height: 1\ncount: 0\n", "2:8: count: 0 is out of range; it must be at least 1"},
		{"height: 1\ncount: 2.5\n", "2:8: count: 2.5 is not a whole number"},
		{"height: 1\ncount: 1e3\n", "2:8: count: 1e3 is not a whole number"},
		{"height: 1\ncount: 1.0\n", "2:8: count: 1.0 is not a whole number"},
		{"height: 1\ncount: 0x10\n", "2:8: count: 0x10 is not a whole number"},
		{"height: 1\ncount: 1 m\n", "2:8: count: 1 m is not a whole number"},
		{"height: 1\ncount: [1]\n", "2:8: count: expected a single value, not a list"},
		{"height: 1\ncount: '-'\n", "2:8: count: - is not a whole number"},
		{"height: 1\ncount:\n", "2:7: count: the value is missing"},
		{"height: 1\ncount: 99999999999\n",
			"2:8: count: 99999999999 is beyond what an integer can hold"},
		{"height:\n", "1:8: height: the value is missing"},
		{"height: [1 m]\n", "1:9: height: expected a single value, not a list"},
		{"height: {m: 1}\n", "1:9: height: expected a single value, not a group of keys"},
		{"height: 1\nglaze: {colour: bleu}\n",
			"2:17: glaze.colour: 'bleu' is not one of red, green, blue; did you mean 'blue'?"},
		{"height: 1\nglaze: {colour: Blue}\n",
			"2:17: glaze.colour: 'Blue' is not one of red, green, blue; did you mean 'blue'?"},
		{"height: 1\nglaze: {colour: 1}\n",
			"2:17: glaze.colour: '1' is not one of red, green, blue"},
		{"height: 1\nglaze: {colour: }\n", "2:17: glaze.colour: the value is missing"},
		{"height: 1\nglaze: 3\n", "2:8: glaze: expected a group of keys, not a single value"},
		{"height: 1\nglaze: [3]\n", "2:8: glaze: expected a group of keys, not a list"},
		{"height: 1\nglaze:\n", "2:7: glaze: expected a group of keys, not a single value"},
		{"heigth: 1\n", "1:1: unknown key 'heigth'; did you mean 'height'?"},
		{"height: 1\nglaze: {color: red}\n",
			"2:9: unknown key 'glaze.color'; did you mean 'glaze.colour'?"},
		{"colour: red\n", "1:1: unknown key 'colour'; did you mean 'glaze.colour'?"},
		{"elephant: 1\n",
			"1:1: unknown key 'elephant'; known keys are height, glaze, count, fired_at"},
		{"height: 1\nglaze: {elephant: 1}\n",
			"2:9: unknown key 'glaze.elephant'; known keys are mix, colour"},
		{"height.x.y: 1\n",
			"1:1: unknown key 'height.x.y'; known keys are height, glaze, count, fired_at"},
		{"'': 1\n", "1:1: unknown key ''; known keys are height, glaze, count, fired_at"},
		{"\"a\\nb\\e[1m\": 1\n",
			"1:1: unknown key 'a?b?[1m'; known keys are height, glaze, count, fired_at"},
		{"height: 1\nglaze: {mix: 0.1}\nglaze.mix: 0.2\n",
			"3:1: duplicate key 'glaze.mix'; it is already on line 2"},
		{"height: 1\nfired_at: 3\n",
			"2:11: fired_at: expected a list such as [1, 2], not a single value"},
		{"height: 1\nfired_at: [1, 1]\n", "2:15: fired_at: 1 is not above the value before it"},
		{"height: 1\nfired_at: [1, [2]]\n", "2:15: fired_at: expected a single value, not a list"},
		{"height: 1\nfired_at: [1, 2 h]\n",
			"2:15: fired_at: 2 h is out of range; it must be at most 1 h"},
		{"height: 1\nfired_at: [1, 2 m]\n",
			"2:15: fired_at: 2 m is a length; a time is given in s, ms, us, min or h"},
		{"- height\n", "1:1: expected a group of keys, not a list"},
		{"height\n", "1:1: expected a group of keys, not a single value"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct pot pot;
		struct error err = {0};
		char shown[sizeof err.text], expected[256];

		assert_int_equal(read_pot(&pot, cases[i].text, &err), -1);
		assert_int_equal(err.code, EX_DATAERR);
		(void)snprintf(expected, sizeof expected, "pot.yaml:%s", cases[i].message);
		assert_string_equal(error_format(&err, shown, sizeof shown), expected);
	}
}

static void a_list_that_is_too_long_is_refused(void **state)
{
	struct text text = {0};
	struct pot pot;
	struct error err = {0};

	(void)state;
	text_add(&text, "height: 1\nfired_at: [");
	for (int i = 0; i <= 512; i++)
		text_addf(&text, "%d,", i);
	text_add(&text, "]\n");
	assert_int_equal(read_pot(&pot, text_string(&text), &err), -1);
	assert_string_equal(err.text, "fired_at: a list of 513 values; at most 512 fit");
	text_clean(&text);
}

static void a_later_source_replaces_an_earlier_one_before_checks(void **state)
{
	struct field_reader reader = {.table = &table};
	struct field_source first = {.name = "pot.yaml"}, second = {.name = "--set", .setting = true};
	struct error err = {0};
	struct pot pot;
	char shown[256];

	(void)state;
	assert_int_equal(yaml_parse(&first.root, "height: wrong", 13, "pot.yaml", &err), 0);
	assert_int_equal(yaml_parse(&second.root, "3 cm", 4, "--set", &err), 0);
	assert_int_equal(field_collect(&reader, &first, &first.root, &err), 0);
	assert_int_equal(field_collect_key(&reader, &second, "height", &second.root, &err), 0);
	assert_int_equal(field_convert(&reader, &pot, &err), 0);
	assert_true(pot.height == 0.03);

	(void)error_set(&err, EX_DATAERR, "too small");
	assert_int_equal(field_blame(&reader, "count", "height", -1, &err), -1);
	assert_string_equal(error_format(&err, shown, sizeof shown), "--set: too small");
	node_clean(&first.root);
	node_clean(&second.root);
}

static void blame_falls_on_the_later_of_two_keys(void **state)
{
	const char *text = "count: 3\nfired_at: [1, 2]\nheight: 1\n";
	struct field_reader reader = {.table = &table};
	struct field_source source = {.name = "pot.yaml"};
	struct error parse = {0};

	(void)state;
	assert_int_equal(yaml_parse(&source.root, text, strlen(text), source.name, &parse), 0);
	assert_int_equal(field_collect(&reader, &source, &source.root, &parse), 0);
	for (int i = 0; i < 3; i++) {
		static const int lines[] = {3, 2, 2}, columns[] = {9, 15, 11};
		struct error err = {0};

		(void)error_set(&err, EX_DATAERR, "together too much");
		(void)field_blame(&reader, i == 0 ? "height" : "fired_at", "count", i == 1 ? 1 : -1, &err);
		assert_int_equal(err.line, lines[i]);
		assert_int_equal(err.column, columns[i]);
	}
	node_clean(&source.root);
}

static void a_printed_struct_reads_back_to_the_same_bytes(void **state)
{
	struct pot pot, again;
	struct error err = {0};
	struct text text = {0};

	(void)state;
	assert_int_equal(read_pot(&pot, "height: 1 cm\nfired_at: [0.1, 3 min]\n", &err), 0);
	field_print(&table, &pot, false, &text);
	assert_string_equal(text_string(&text), "height: 0.01 m\nglaze:\n  mix: 0.5\n  colour: green\n"
											"count: 1\nfired_at: [0.1 s, 180 s]\n");
	assert_int_equal(read_pot(&again, text_string(&text), &err), 0);
	assert_memory_equal(&pot, &again, sizeof pot);
	text_clean(&text);
}

static void passive_fields_are_outside_the_active_print_and_the_differences(void **state)
{
	struct pot a, b;
	struct error err = {0};
	struct text text = {0};

	(void)state;
	assert_int_equal(read_pot(&a, "height: 1 cm\ncount: 1\n", &err), 0);
	assert_int_equal(
		read_pot(&b, "height: 2 cm\ncount: 2\nfired_at: [3]\nglaze: {colour: red}\n", &err), 0);
	field_print(&table, &a, true, &text);
	assert_string_equal(
		text_string(&text), "height: 0.01 m\nglaze:\n  mix: 0.5\n  colour: green\nfired_at: []\n");
	text_clean(&text);
	field_differences(&table, &a, &b, &text);
	assert_string_equal(text_string(&text), "height: 0.01 m -> 0.02 m\n"
											"glaze.colour: green -> red\nfired_at: [] -> [3 s]\n");
	text_clean(&text);
}

static void the_reference_describes_every_row(void **state)
{
	struct text text = {0};

	(void)state;
	field_print_reference(&table, NULL, &text);
	assert_string_equal(text_string(&text),
		"\n# of the pot\n"
		"# a length (m, km, cm, mm or um), above 0 and at most 1 m; required, here an example\n"
		"height: 10 cm\n"
		"\n# its surface\nglaze:\n"
		"  # share of glass\n  # a plain number, at least 0 and below 1\n  mix: 0.5\n"
		"  # of the glaze\n  # one of: red, green, blue\n  colour: green\n"
		"\n# pots made\n# a whole number, at least 1\ncount: 1\n"
		"\n# times in the kiln\n"
		"# an increasing list, each a time (s, ms, us, min or h), at most 1 h\nfired_at: []\n");
	text_clean(&text);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(members_and_defaults_are_filled),
		cmocka_unit_test(a_dotted_key_stands_for_nested_ones),
		cmocka_unit_test(bad_input_is_refused_at_its_place),
		cmocka_unit_test(a_list_that_is_too_long_is_refused),
		cmocka_unit_test(a_later_source_replaces_an_earlier_one_before_checks),
		cmocka_unit_test(blame_falls_on_the_later_of_two_keys),
		cmocka_unit_test(a_printed_struct_reads_back_to_the_same_bytes),
		cmocka_unit_test(passive_fields_are_outside_the_active_print_and_the_differences),
		cmocka_unit_test(the_reference_describes_every_row),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
