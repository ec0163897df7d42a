#include "campaign/range.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "talus/config.h"

/* The texts of a range before they are understood. */
struct form {
	const struct node *from, *to;
	struct range *range;
};

static int read_from(const struct reader *reader, const struct node *node, void *target)
{
	const char *text;

	((struct form *)target)->from = node;
	return reader_text(reader, node, &text);
}

static int read_to(const struct reader *reader, const struct node *node, void *target)
{
	const char *text;

	((struct form *)target)->to = node;
	return reader_text(reader, node, &text);
}

static int read_steps(const struct reader *reader, const struct node *node, void *target)
{
	return reader_integer(
		reader, node, 2, EXPERIMENT_RUNS_MAX, &((struct form *)target)->range->steps);
}

static int read_scale(const struct reader *reader, const struct node *node, void *target)
{
	static const char *const names[] = {"linear", "log", NULL};

	return reader_choice(reader, node, names, &((struct form *)target)->range->scale);
}

const struct reader_key range_keys[RANGE_KEYS] = {
	{"from", read_from, "first value, a number with its unit; required"},
	{"to", read_to, "last value, in the same unit; required"},
	{"steps", read_steps,
		"number of values, both ends among them; without it the range is sampled"},
	{"scale", read_scale, "linear: equal distances, log: equal ratios (default: linear)"},
};

/* "20 deg": 20 and "deg". */
static int split(
	const struct reader *reader, const struct node *node, double *number, const char **unit)
{
	char digits[TEXT_REAL_SIZE];
	size_t length = strspn(node->text, "+-.0123456789eE");

	(void)snprintf(digits, sizeof digits, "%.*s", (int)length, node->text);
	*unit = node->text + length + strspn(node->text + length, " ");
	if (length >= sizeof digits || !text_to_real(digits, number))
		return reader_fail(
			reader, node, "%.60s is not a number, or a number and its unit", node->text);
	return 0;
}

int range_read(const struct reader *reader, const struct leaf *leaf, struct range *out)
{
	struct form form = {.range = out};
	const char *unit;

	*out = (struct range){.whole = config_is_whole(leaf->key)};
	TRY(reader_keys(reader, leaf->node, range_keys, RANGE_KEYS, &form));
	if (!form.from || !form.to)
		return reader_fail(reader, leaf->node, "a range lacks its '%s'", form.from ? "to" : "from");
	TRY(split(reader, form.from, &out->from, &out->unit));
	TRY(split(reader, form.to, &out->to, &unit));
	if (strcmp(out->unit, unit) != 0)
		return reader_fail(
			reader, form.to, "%.60s has another unit than %.60s", form.to->text, form.from->text);
	if (out->from == out->to)
		return reader_fail(reader, form.to, "a range of one value; write the value instead");
	if (out->scale == RANGE_LOG && !(out->from > 0 && out->to > 0))
		return reader_fail(reader, form.from, "a log scale has only values above 0");
	return 0;
}

int range_value(const struct range *range, double share, const struct node *node, struct node *out,
	struct error *err)
{
	double from = range->from, to = range->to, value;

	if (range->whole && !range->steps) { /* sampled: every whole number has the same share */
		value = fmin(floor(fmin(from, to) + share * (fabs(to - from) + 1)), fmax(from, to));
	} else if (share >= 1) {
		value = to;
	} else {
		value =
			range->scale == RANGE_LOG ? from * pow(to / from, share) : from + share * (to - from);
	}
	*out = (struct node){.kind = NODE_SCALAR, .line = node->line, .column = node->column};
	if (asprintf(&out->text, *range->unit ? "%.12g %s" : "%.12g%s", value, range->unit) >= 0)
		return 0;
	out->text = NULL;
	return error_memory(err, strlen(range->unit));
}
