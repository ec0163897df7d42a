#include <string.h>

#include "config/field_parts.h"
#include "config/quantity.h"
#include "talus/config.h"

void field_list_choices(const struct field *field, struct text *out)
{
	for (size_t i = 0; field->choices[i]; i++)
		text_addf(out, "%s%s", i ? ", " : "", field->choices[i]);
}

static void print_list(const struct field *field, const struct real_list *list, struct text *out)
{
	text_add(out, "[");
	for (int i = 0; i < list->count; i++) {
		text_add(out, i ? ", " : "");
		quantity_print(list->values[i], field->unit, out);
	}
	text_add(out, "]");
}

void field_print_value(const struct field *field, const void *target, struct text *out)
{
	const void *member = (const char *)target + field->offset;

	switch (field->kind) {
	case FIELD_REAL:
		quantity_print(*(const double *)member, field->unit, out);
		break;
	case FIELD_INTEGER:
		text_addf(out, "%d", *(const int *)member);
		break;
	case FIELD_CHOICE:
		text_add(out, field->choices[*(const int *)member]);
		break;
	case FIELD_REALS:
		print_list(field, member, out);
		break;
	case FIELD_POINTS:
		points_print(member, out);
		break;
	case FIELD_GROUP:
		break;
	}
}

/* "  cells:" as it stands below its group */
static void print_key(const struct field *field, struct text *out)
{
	text_addf(out, "%*s%s:", 2 * field_depth(field->name), "", field_leaf(field->name));
}

void field_print(
	const struct field_table *table, const void *target, bool active_only, struct text *out)
{
	for (size_t i = 0; i < table->count; i++) {
		const struct field *field = &table->fields[i];

		if ((active_only && field->flags & FIELD_PASSIVE) || !field_applies(table, field, target))
			continue;
		print_key(field, out);
		text_add(out, field->kind == FIELD_GROUP ? "" : " ");
		field_print_value(field, target, out);
		text_add(out, "\n");
	}
}

static void describe(const struct field *field, struct text *out)
{
	if (field->kind == FIELD_CHOICE) {
		text_add(out, "one of: ");
		field_list_choices(field, out);
	} else if (field->kind == FIELD_INTEGER) {
		text_add(out, "a whole number");
	} else if (field->kind == FIELD_POINTS) {
		text_add(out, "the name of a file of two columns, or a list of points [x, value] in m");
	} else {
		if (field->kind == FIELD_REALS)
			text_add(
				out, field->flags & FIELD_UNSORTED ? "a list, each " : "an increasing list, each ");
		quantity_describe(field->unit, out);
	}
	if (field->range) {
		text_add(out, ", ");
		field_describe_range(field, out);
	}
	text_add(out, field->flags & FIELD_REQUIRED ? "; required, here an example" : "");
}

void field_print_reference(const struct field_table *table, const void *target, struct text *out)
{
	for (size_t i = 0; i < table->count; i++) {
		const struct field *field = &table->fields[i];
		int indent = 2 * field_depth(field->name);
		bool selector = table->selector && !strcmp(field->name, table->selector);

		if (!field_applies(table, field, target))
			continue;
		text_addf(out, "%s%*s# %s\n", indent ? "" : "\n", indent, "", field->meaning);
		if (field->kind != FIELD_GROUP) {
			text_addf(out, "%*s# ", indent, "");
			describe(field, out);
			text_add(out, "\n");
		}
		print_key(field, out);
		text_add(out, field->kind == FIELD_GROUP ? "" : " ");
		if (selector)
			field_print_value(field, target, out);
		else
			text_add(out, field->kind == FIELD_GROUP ? "" : field_default(table, field, target));
		text_add(out, "\n");
	}
}

void field_differences(
	const struct field_table *table, const void *a, const void *b, struct text *out)
{
	for (size_t i = 0; i < table->count; i++) {
		const struct field *field = &table->fields[i];
		struct text left = {0}, right = {0};

		if (field->flags & FIELD_PASSIVE || !field_applies(table, field, a) ||
			!field_applies(table, field, b))
			continue;
		field_print_value(field, a, &left);
		field_print_value(field, b, &right);
		if (left.failed || right.failed)
			out->failed = true;
		else if (strcmp(text_string(&left), text_string(&right)) != 0)
			text_addf(out, "%s: %s -> %s\n", field->name, text_string(&left), text_string(&right));
		text_clean(&left);
		text_clean(&right);
	}
}
