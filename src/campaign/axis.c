#include "campaign/axis.h"

#include <stdlib.h>
#include <string.h>

#include "campaign/range.h"
#include "campaign/sample.h"

/* A copy of a value that the axis owns. */
static int copy_value(const struct node *node, struct node *out, struct error *err)
{
	*out = (struct node){.kind = node->kind, .line = node->line, .column = node->column};
	if (node->kind == NODE_SCALAR) {
		out->text = strdup(node->text);
		return out->text ? 0 : error_memory(err, strlen(node->text));
	}
	out->items = calloc(node->count + 1, sizeof *out->items);
	if (!out->items)
		return error_memory(err, node->count * sizeof *out->items);
	for (size_t i = 0; i < node->count; i++) {
		out->count = i + 1;
		TRY(copy_value(&node->items[i], &out->items[i], err));
	}
	return 0;
}

/* How many values the key of a leaf has; 0 with an error. */
static size_t leaf_count(const struct reader *reader, const struct leaf *leaf, struct range *range)
{
	if (leaf->node->kind == NODE_SCALAR)
		return 1;
	if (leaf->node->kind == NODE_SEQUENCE && leaf->node->count)
		return leaf->node->count;
	if (leaf->node->kind == NODE_SEQUENCE)
		reader_fail(reader, leaf->node, "an empty list asks for no run at all");
	else if (range_read(reader, leaf, range) == 0 && !range->steps)
		reader_fail(reader, leaf->node, "a range needs its 'steps', or a 'sample' beside it");
	return reader->err->code ? 0 : (size_t)range->steps;
}

static int leaf_value(const struct reader *reader, const struct leaf *leaf,
	const struct range *range, size_t index, struct node *out)
{
	if (leaf->node->kind == NODE_SCALAR)
		return copy_value(leaf->node, out, reader->err);
	if (leaf->node->kind == NODE_SEQUENCE)
		return copy_value(&leaf->node->items[index], out, reader->err);
	return range_value(range, (double)index / (range->steps - 1), leaf->node, out, reader->err);
}

/* A new last axis with room for its values. */
static struct axis *add_axis(const struct reader *reader, struct axis_list *list,
	const struct leaf *leaves, size_t width, size_t count)
{
	struct axis *items = realloc(list->items, (list->count + 1) * sizeof *items), *axis;

	if (!items)
		goto failed;
	list->items = items;
	axis = &items[list->count++];
	*axis = (struct axis){.leaves = calloc(width, sizeof *axis->leaves),
		.values = calloc(count * width, sizeof *axis->values)};
	if (!axis->leaves || !axis->values)
		goto failed;
	memcpy(axis->leaves, leaves, width * sizeof *leaves);
	axis->width = width;
	axis->count = count;
	return axis;
failed:
	error_memory(reader->err, count * width * sizeof *axis->values);
	return NULL;
}

/* These leaves in step: lists and ranges of one length, single values for all. */
static int add_zip(
	const struct reader *reader, struct axis_list *list, const struct leaf *leaves, size_t width)
{
	struct range *ranges = calloc(width, sizeof *ranges);
	struct axis *axis;
	size_t count = 1;
	int result = -1;

	if (!ranges) {
		error_memory(reader->err, width * sizeof *ranges);
		goto done;
	}
	for (size_t k = 0; k < width; k++) {
		size_t own = leaf_count(reader, &leaves[k], &ranges[k]);

		if (!own)
			goto done;
		if (own > 1 && count > 1 && own != count) {
			reader_fail(reader, leaves[k].node, "%zu values, and %zu of another key in this zip",
				own, count);
			goto done;
		}
		count = own > 1 ? own : count;
	}
	axis = add_axis(reader, list, leaves, width, count);
	if (!axis)
		goto done;
	for (size_t i = 0; i < count * width; i++)
		if (leaf_value(reader, &leaves[i % width], &ranges[i % width], i / width, &axis->values[i]))
			goto done;
	result = 0;
done:
	free(ranges);
	return result;
}

static bool is_sampled(const struct leaf *leaf)
{
	return leaf->node->kind == NODE_MAPPING && !node_find(leaf->node, "steps");
}

/* These leaves, all of them ranges without steps, drawn together. */
static int draw(const struct reader *reader, struct axis_list *list, const struct node *node,
	const struct sample *sample, const struct leaf *leaves, size_t width)
{
	struct axis *axis = add_axis(reader, list, leaves, width, (size_t)sample->points);
	struct range *ranges = calloc(width, sizeof *ranges);
	double *shares = calloc((size_t)sample->points * width, sizeof *shares);
	int result = -1;

	if (!axis)
		goto done;
	if (!ranges || !shares) {
		error_memory(reader->err, (size_t)sample->points * width * sizeof *shares);
		goto done;
	}
	axis->sampled = true;
	for (size_t k = 0; k < width; k++)
		if (range_read(reader, &leaves[k], &ranges[k]))
			goto done;
	if (sample_draw(reader, node, sample, width, shares))
		goto done;
	for (size_t i = 0; i < axis->count * width; i++)
		if (range_value(&ranges[i % width], shares[i], leaves[i % width].node, &axis->values[i],
				reader->err))
			goto done;
	result = 0;
done:
	free(ranges);
	free(shares);
	return result;
}

static int add_sample(const struct reader *reader, struct axis_list *list, const struct node *node)
{
	struct leaf *leaves = calloc(list->leaves.count + 1, sizeof *leaves);
	struct sample sample;
	size_t width = 0;
	int result = -1;

	for (size_t i = 0; leaves && i < list->leaves.count; i++)
		if (is_sampled(&list->leaves.items[i]))
			leaves[width++] = list->leaves.items[i];
	if (!leaves)
		error_memory(reader->err, list->leaves.count * sizeof *leaves);
	else if (!width)
		reader_fail(reader, node, "no range of this entry is without 'steps', to be sampled");
	else if (sample_read(reader, node, &sample) == 0)
		result = draw(reader, list, node, &sample, leaves, width);
	free(leaves);
	return result;
}

/* The axes of one item of an entry whose leaves are these. */
static int add_item(const struct reader *reader, struct axis_list *list, const struct node *item,
	const struct leaf *leaves, size_t count, bool sampling)
{
	if (!strcmp(item->key, "zip"))
		return count ? add_zip(reader, list, leaves, count) : 0;
	for (size_t k = 0; k < count; k++)
		if (!sampling || !is_sampled(&leaves[k]))
			TRY(add_zip(reader, list, &leaves[k], 1));
	return 0;
}

int axis_list_read(const struct reader *reader, const struct node *entry, struct axis_list *out)
{
	const struct node *sample;
	size_t *starts; /* of each item, its first leaf */
	int result = -1;

	*out = (struct axis_list){0};
	if (entry->kind != NODE_MAPPING)
		return reader_fail(reader, entry, "a mapping of config keys is wanted here");
	sample = node_find(entry, "sample");
	starts = calloc(entry->count + 1, sizeof *starts);
	if (!starts)
		return error_memory(reader->err, entry->count * sizeof *starts);
	for (size_t i = 0; i < entry->count; i++) {
		const struct node *item = &entry->items[i];
		const struct node alone = {.kind = NODE_MAPPING, .items = &entry->items[i], .count = 1};
		bool zip = !strcmp(item->key, "zip");

		if (item != sample && reader_leaves(reader, zip ? item : &alone, &out->leaves))
			goto done;
		starts[i + 1] = out->leaves.count;
	}
	/* the points come first, so that they are the slowest of the product */
	if (sample && add_sample(reader, out, sample))
		goto done;
	for (size_t i = 0; i < entry->count; i++)
		if (add_item(reader, out, &entry->items[i], &out->leaves.items[starts[i]],
				starts[i + 1] - starts[i], sample != NULL))
			goto done;
	result = 0;
done:
	free(starts);
	return result;
}

void axis_list_clean(struct axis_list *list)
{
	for (size_t i = 0; i < list->count; i++) {
		for (size_t k = 0; k < list->items[i].count * list->items[i].width; k++)
			node_clean(&list->items[i].values[k]);
		free(list->items[i].leaves);
		free(list->items[i].values);
	}
	free(list->items);
	reader_leaves_clean(&list->leaves);
	*list = (struct axis_list){0};
}
