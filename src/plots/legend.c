#include "plots/legend.h"

#include <string.h>

static bool same_entry(const struct figure_line *a, const struct figure_line *b)
{
	return !strcmp(a->title, b->title) && a->colour == b->colour && a->dash == b->dash &&
		   a->mark == b->mark && a->hollow == b->hollow;
}

static bool same_look(const struct figure_line *a, const struct figure_line *b)
{
	return a->colour == b->colour && a->dash == b->dash && a->mark == b->mark &&
		   a->hollow == b->hollow;
}

static size_t letters(const char *string)
{
	size_t count = 0;

	for (; *string; string++)
		count += ((unsigned char)*string & 0xC0) != 0x80;
	return count;
}

static void add_entry(struct legend *legend, const struct figure_line *line)
{
	for (size_t i = 0; i < legend->count; i++)
		if (same_entry(legend->items[i], line))
			return;
	if (legend->count == LEGEND_MAX)
		return;
	legend->items[legend->count++] = line;
	if (letters(line->title) > legend->longest)
		legend->longest = letters(line->title);
}

void legend_collect(const struct figure_panel *panel, struct legend *legend)
{
	for (size_t i = 0; i < panel->line_count; i++)
		if (panel->lines[i].title && figure_can_be_drawn(panel, &panel->lines[i]))
			add_entry(legend, &panel->lines[i]);
}

bool legend_is_ambiguous(const struct legend *legend)
{
	for (size_t i = 0; i < legend->count; i++)
		for (size_t k = 0; k < i; k++)
			if (same_look(legend->items[i], legend->items[k]))
				return true;
	return false;
}
