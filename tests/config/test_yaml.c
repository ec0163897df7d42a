/* YAML trees: shape and places, and everything that is refused, in bounded time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "config/yaml.h"
#include "talus/text.h"

/* Parse and compare the whole message. */
static void expect_refusal(const char *text, size_t length, const char *message)
{
	struct node root;
	struct error err = {0};
	char shown[sizeof err.text];

	assert_int_equal(yaml_parse(&root, text, length, "a.yaml", &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_string_equal(error_format(&err, shown, sizeof shown), message);
	node_clean(&root);
	assert_null(root.items);
}

static void a_byte_order_mark_before_a_key_is_no_part_of_it(void **state)
{
	const char *text = "\xEF\xBB\xBFlayers: 10\n";
	struct node root;
	struct error err = {0};
	const struct node *node;

	(void)state;
	assert_int_equal(yaml_parse(&root, text, strlen(text), "a.yaml", &err), 0);
	node = node_find(&root, "layers");
	assert_non_null(node);
	assert_int_equal(node->key_column, 1);
	node_clean(&root);
}

static void a_mapping_keeps_order_places_and_kinds(void **state)
{
	const char *text =
		"\xEF\xBB\xBF# comment\r\na: 1 mm\r\nb:\r\n  - x\r\n  - 'y'\r\nc: {d: \"\", e: }\r\n";
	struct node root;
	struct error err = {0};
	const struct node *node;

	(void)state;
	assert_int_equal(yaml_parse(&root, text, strlen(text), "a.yaml", &err), 0);
	assert_int_equal(root.kind, NODE_MAPPING);
	assert_int_equal(root.count, 3);
	node = node_find(&root, "a");
	assert_string_equal(node->text, "1 mm");
	assert_int_equal(node->line, 2);
	assert_int_equal(node->column, 4);
	assert_int_equal(node->key_line, 2);
	assert_int_equal(node->key_column, 1);
	node = node_find(&root, "b");
	assert_int_equal(node->kind, NODE_SEQUENCE);
	assert_int_equal(node->count, 2);
	assert_false(node->items[0].quoted);
	assert_true(node->items[1].quoted);
	assert_int_equal(node->items[1].line, 5);
	assert_int_equal(node->items[1].column, 5);
	node = node_find(&root, "c");
	assert_string_equal(node_find(node, "d")->text, "");
	assert_string_equal(node_find(node, "e")->text, "");
	assert_null(node_find(node, "f"));
	node_clean(&root);
}

static void bad_documents_are_refused_with_their_place(void **state)
{
	static const struct {
		const char *text, *message;
	} cases[] = {
		{"", "a.yaml:1:1: the document is empty"},
		{"# only a comment\n", "a.yaml:1:1: the document is empty"},
		{"---\n", "a.yaml:1:1: the document is empty"},
		{"a: 1\n---\nb: 2\n", "a.yaml:2:1: a second document; one file holds one"},
		{"a: &x 1\n", "a.yaml:1:4: anchors and aliases are not supported"},
		{"a: &x [1]\n", "a.yaml:1:4: anchors and aliases are not supported"},
		{"a: &x {b: 1}\n", "a.yaml:1:4: anchors and aliases are not supported"},
		{"&x a: 1\n", "a.yaml:1:1: anchors and aliases are not supported"},
		{"a: *x\n", "a.yaml:1:4: anchors and aliases are not supported"},
		{"*x : 1\n", "a.yaml:1:1: anchors and aliases are not supported"},
		{"a: !!int 1\n", "a.yaml:1:4: tags are not supported"},
		{"a: !x [1]\n", "a.yaml:1:4: tags are not supported"},
		{"a: !x {b: 1}\n", "a.yaml:1:4: tags are not supported"},
		{"[a]: 1\n", "a.yaml:1:1: a key must be a plain word"},
		{"a: 1\nb: 2\na: 3\nb: 4\n", "a.yaml:3:1: duplicate key 'a'; it is already on line 1"},
		{"g: {a: 1, 'a': 3}\n", "a.yaml:1:11: duplicate key 'a'; it is already on line 1"},
		{"a: \"x\\0y\"\n", "a.yaml:1:4: a NUL character in a text"},
		{"\"a\\0b\": 1\n", "a.yaml:1:1: a NUL character in a text"},
		{"a: [1, 2\n", "a.yaml:2:1: not valid YAML: while parsing a flow sequence, did not find "
					   "expected ',' or ']'"},
		{"a: b: c\n", "a.yaml:1:5: not valid YAML: mapping values are not allowed in this context"},
		{"a: 1\n\tb: 2\n", "a.yaml:2:1: not valid YAML: while scanning a plain scalar, found a tab "
						   "character that violates indentation"},
		{"a: 'x\n", "a.yaml:2:1: not valid YAML: while scanning a quoted scalar, found unexpected "
					"end of stream"},
		{"a: 1\nb: \xC3\x28\n", "a.yaml:2:4: byte 0xC3 is not valid UTF-8 text"},
		{"\xC0\xAF", "a.yaml:1:1: byte 0xC0 is not valid UTF-8 text"},
		{"\xE0\x80\xAF", "a.yaml:1:1: byte 0xE0 is not valid UTF-8 text"},
		{"\xED\xA0\x80", "a.yaml:1:1: byte 0xED is not valid UTF-8 text"},
		{"\xF0\x80\x80\xAF", "a.yaml:1:1: byte 0xF0 is not valid UTF-8 text"},
		{"\xF4\x90\x80\x80", "a.yaml:1:1: byte 0xF4 is not valid UTF-8 text"},
		{"\xF5\x80\x80\x80", "a.yaml:1:1: byte 0xF5 is not valid UTF-8 text"},
		{"\xE2\x82", "a.yaml:1:1: byte 0xE2 is not valid UTF-8 text"},
		{"\xFF\xFE"
		 "a",
			"a.yaml:1:1: byte 0xFF is not valid UTF-8 text"},
		{"a: \xE2\x82\xAC \x07\n",
			"a.yaml:1:6: control character 0x07 does not belong in a text file"},
		{"\x7F"
		 "ELF",
			"a.yaml:1:1: control character 0x7F does not belong in a text file"},
	};

	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
		expect_refusal(cases[i].text, strlen(cases[i].text), cases[i].message);
}

static void a_nul_byte_is_refused(void **state)
{
	(void)state;
	expect_refusal(
		"a: 1\nb\0: 2\n", 12, "a.yaml:2:2: control character 0x00 does not belong in a text file");
}

static void nesting_is_limited_to_16(void **state)
{
	struct node root;
	struct error err = {0};

	(void)state;
	assert_int_equal(yaml_parse(&root, "[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]", 32, "a.yaml", &err), 0);
	node_clean(&root);
	expect_refusal(
		"[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]", 34, "a.yaml:1:17: nested deeper than 16 levels");
}

/* 1 MiB of anything is answered within a second: libyaml's own document loader hangs on some. */
static void hostile_text_is_refused_quickly(void **state)
{
	static const char *const patterns[] = {"[", "{", "- ", "? ", "a: ", "[a,", "{? ", "! ", "&a ",
		"*a ", "\"", "'", "|\n", "%", "---\n", "#", "\n", " ", "a\n", "- a\n", "{a: [",
		"\xEF\xBB\xBF"};
	const size_t length = (size_t)1 << 20;
	char *text = malloc(length);

	(void)state;
	assert_non_null(text);
	for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
		struct node root;
		struct error err = {0};
		clock_t start = clock();

		for (size_t j = 0; j < length; j++)
			text[j] = patterns[i][j % strlen(patterns[i])];
		(void)yaml_parse(&root, text, length, "a.yaml", &err);
		node_clean(&root);
		/* far above the 0.05 s that the slowest takes, for sanitizers and valgrind */
		assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 10);
	}
	free(text);
}

static void size_and_count_are_limited(void **state)
{
	struct text text = {0};
	size_t length = ((size_t)1 << 20) + 1;
	char *big = malloc(length);

	(void)state;
	assert_non_null(big);
	memset(big, ' ', length);
	expect_refusal(big, length, "a.yaml: more than 1 MiB of text");
	free(big);
	text_add(&text, "[");
	for (int i = 0; i <= 100000; i++)
		text_add(&text, "1,");
	expect_refusal(text.data, text.length, "a.yaml:1:200002: more than 100000 values");
	text_clean(&text);
}

static void many_keys_are_compared_quickly(void **state)
{
	struct text text = {0};
	clock_t start = clock();

	(void)state;
	for (int i = 0; i < 90000; i++)
		text_addf(&text, "k%d:\n", i);
	text_add(&text, "k5:\n");
	expect_refusal(
		text.data, text.length, "a.yaml:90001:1: duplicate key 'k5'; it is already on line 6");
	assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 10);
	text_clean(&text);
}

static void files_that_cannot_be_read_say_why(void **state)
{
	char folder[] = "/tmp/talus-yaml-XXXXXX", path[64], shown[256], expected[256];
	struct node root;
	struct error err = {0};

	(void)state;
	assert_non_null(mkdtemp(folder));
	(void)snprintf(path, sizeof path, "%s/none.yaml", folder);
	assert_int_equal(yaml_load(&root, path, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	(void)snprintf(
		expected, sizeof expected, "%s: cannot be read: No such file or directory", path);
	assert_string_equal(error_format(&err, shown, sizeof shown), expected);
	err = (struct error){0};
	assert_int_equal(yaml_load(&root, folder, &err), -1);
	(void)snprintf(expected, sizeof expected, "%s: cannot be read: Is a directory", folder);
	assert_string_equal(error_format(&err, shown, sizeof shown), expected);
	assert_int_equal(rmdir(folder), 0);
}

static void an_endless_file_is_refused(void **state)
{
	struct node root;
	struct error err = {0};

	(void)state;
	assert_int_equal(yaml_load(&root, "/dev/zero", &err), -1);
	assert_string_equal(err.text, "more than 1 MiB of text");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_byte_order_mark_before_a_key_is_no_part_of_it),
		cmocka_unit_test(a_mapping_keeps_order_places_and_kinds),
		cmocka_unit_test(bad_documents_are_refused_with_their_place),
		cmocka_unit_test(a_nul_byte_is_refused),
		cmocka_unit_test(nesting_is_limited_to_16),
		cmocka_unit_test(hostile_text_is_refused_quickly),
		cmocka_unit_test(size_and_count_are_limited),
		cmocka_unit_test(many_keys_are_compared_quickly),
		cmocka_unit_test(files_that_cannot_be_read_say_why),
		cmocka_unit_test(an_endless_file_is_refused),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
