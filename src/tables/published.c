/* Published values, as the experiment writes them beside ours: rows of columns of measures. */
#include <stdlib.h>
#include <string.h>

#include "config/yaml.h"
#include "tables/layout.h"
#include "talus/text.h"

static int refuse(const struct layout *layout, const struct node *node, const char *what,
	size_t wanted, struct error *err)
{
	const char *name = layout->wanted->name.text;

	if (node->kind == NODE_SEQUENCE)
		return error_at(err, EX_DATAERR, layout->experiment->path, node->line, node->column,
			"published: %s has %zu %s here and the table %zu", name, node->count, what, wanted);
	return error_at(err, EX_DATAERR, layout->experiment->path, node->line, node->column,
		"published: %s wants a list of %zu %s here", name, wanted, what);
}

static int read_value(
	const struct layout *layout, const struct node *node, const char **out, struct error *err)
{
	double number;

	*out = NULL;
	if (node->kind == NODE_SCALAR && (!strcmp(node->text, "null") || !node->text[0]))
		return 0;
	if (node->kind != NODE_SCALAR || !text_to_real(node->text, &number))
		return error_at(err, EX_DATAERR, layout->experiment->path, node->line, node->column,
			"published: %s is neither a number nor null",
			node->kind == NODE_SCALAR ? node->text : "this");
	*out = node->text;
	return 0;
}

/* A cell: one value, a list of one per measure, or null for a blank one. */
static int read_cell(
	const struct layout *layout, const struct node *node, const char **out, struct error *err)
{
	bool blank = node->kind == NODE_SCALAR && (!strcmp(node->text, "null") || !node->text[0]);

	if (blank)
		return 0;
	if (layout->measure_count == 1 && node->kind == NODE_SCALAR)
		return read_value(layout, node, out, err);
	if (node->kind != NODE_SEQUENCE || node->count != layout->measure_count)
		return refuse(layout, node, "values", layout->measure_count, err);
	for (size_t i = 0; i < node->count; i++)
		TRY(read_value(layout, &node->items[i], &out[i], err));
	return 0;
}

/* A row: a list of cells, or one cell where the table has no column keys. */
static int read_row(
	const struct layout *layout, const struct node *node, const char **out, struct error *err)
{
	if (!layout->columns.keys)
		return read_cell(layout, node, out, err);
	if (node->kind != NODE_SEQUENCE || node->count != layout->columns.count)
		return refuse(layout, node, "columns", layout->columns.count, err);
	for (size_t i = 0; i < node->count; i++)
		TRY(read_cell(layout, &node->items[i], &out[i * layout->measure_count], err));
	return 0;
}

int layout_read_published(struct layout *layout, struct error *err)
{
	const struct node *node = layout->wanted->published;
	size_t row = layout->columns.count * layout->measure_count;

	if (!node)
		return 0;
	if (node->kind != NODE_SEQUENCE || node->count != layout->rows.count)
		return refuse(layout, node, "rows", layout->rows.count, err);
	layout->published = calloc(node->count * row, sizeof *layout->published);
	if (!layout->published)
		return error_memory(err, node->count * row * sizeof *layout->published);
	for (size_t i = 0; i < node->count; i++)
		TRY(read_row(layout, &node->items[i], &layout->published[i * row], err));
	return 0;
}
