#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "config/field_parts.h"
#include "config/quantity.h"

/* One end of a range: "[0 deg" or "90 deg)". */
struct range_end {
	char text[32];
	double value;
	bool bounded, open;
};

static void parse_range_end(const char *text, const char *unit, bool open, struct range_end *end)
{
	struct error err = {0};

	(void)snprintf(end->text, sizeof end->text, "%s", text);
	end->open = open;
	end->bounded = strcmp(text, "inf") != 0 && strcmp(text, "-inf") != 0;
	if (end->bounded)
		(void)quantity_read(text, unit, &end->value, &err);
	assert(!err.code);
}

/* The range of a row. Rows are ours: a range that does not parse is our own mistake. */
static void parse_range(const struct field *field, struct range_end *low, struct range_end *high)
{
	const char *unit = field->unit ? field->unit : "1";
	char first[32], last[32], opening, closing;
	int count = sscanf(field->range, "%c%31[^,], %31[^])]%c", &opening, first, last, &closing);

	assert(count == 4);
	(void)count;
	parse_range_end(first, unit, opening == '(', low);
	parse_range_end(last, unit, closing == ')', high);
}

void field_describe_range(const struct field *field, struct text *out)
{
	struct range_end low, high;

	parse_range(field, &low, &high);
	if (low.bounded)
		text_addf(out, "%s %s", low.open ? "above" : "at least", low.text);
	if (low.bounded && high.bounded)
		text_add(out, " and ");
	if (high.bounded)
		text_addf(out, "%s %s", high.open ? "below" : "at most", high.text);
}

int field_check_range(const struct field *field, const char *shown, double value, struct error *err)
{
	struct range_end low, high;
	struct text range = {0};

	if (!field->range)
		return 0;
	parse_range(field, &low, &high);
	if ((!low.bounded || value > low.value || (value == low.value && !low.open)) &&
		(!high.bounded || value < high.value || (value == high.value && !high.open)))
		return 0;
	field_describe_range(field, &range);
	(void)error_set(
		err, EX_DATAERR, "%s is out of range; it must be %s", shown, text_string(&range));
	text_clean(&range);
	return -1;
}
