#include "plots/script_data.h"

#include <math.h>

enum { POINTS_MAX = 1200, MAP_ROWS = 240, MAP_COLUMNS = 400 };

void script_data_add_number(struct text *out, double value)
{
	char buffer[TEXT_REAL_SIZE];

	text_addf(out, " %s", isfinite(value) ? text_real(value, buffer) : "NaN");
}

static void add_point(struct text *out, const struct figure_line *line, size_t i)
{
	script_data_add_number(out, line->x[i]);
	script_data_add_number(out, line->y[i]);
	script_data_add_number(out, line->spread ? line->spread[i] : 0);
	text_add(out, "\n");
}

/* First, least, greatest and last of the points `from` to `end`, in their order: so that thousands of
 * steps become a small file that looks the same. */
static void add_bucket(struct text *out, const struct figure_line *line, size_t from, size_t end)
{
	size_t least = from, greatest = from;

	for (size_t i = from; i < end; i++) {
		if (!(line->y[i] >= line->y[least]))
			least = i;
		if (!(line->y[i] <= line->y[greatest]))
			greatest = i;
	}
	for (size_t i = from; i < end; i++)
		if (i == from || i == least || i == greatest || i == end - 1)
			add_point(out, line, i);
}

static void add_line_data(
	struct text *out, const struct figure_line *line, size_t panel, size_t index)
{
	size_t buckets = POINTS_MAX / 4;

	text_addf(out, "$p%zu_%zu << END\n", panel, index);
	if (line->count <= POINTS_MAX)
		for (size_t i = 0; i < line->count; i++)
			add_point(out, line, i);
	else
		for (size_t k = 0; k < buckets; k++)
			add_bucket(out, line, k * line->count / buckets, (k + 1) * line->count / buckets);
	text_add(out, "END\n");
}

/* The row of a map that is nearest to a height. */
static size_t nearest_row(const struct figure_map *map, double y)
{
	size_t row = 0;

	while (row + 1 < map->rows && fabs(map->y[row + 1] - y) < fabs(map->y[row] - y))
		row++;
	return row;
}

/* An image wants even steps. What lies between two rows was not stored, and so is not drawn: each row is a
 * strip that ends half way to the next. */
static void add_map_data(struct text *out, const struct figure_map *map, size_t panel)
{
	size_t step = map->columns / MAP_COLUMNS + 1;
	double from = map->y[0], to = map->y[map->rows - 1];

	text_addf(out, "$m%zu << END\n", panel);
	for (int row = 0; row < MAP_ROWS; row++) {
		double y = from + (to - from) * row / (MAP_ROWS - 1);
		const double *values = map->values + nearest_row(map, y) * map->columns;

		for (size_t column = 0; column < map->columns; column += step) {
			script_data_add_number(out, map->x[column]);
			script_data_add_number(out, y);
			script_data_add_number(out, values[column]);
			text_add(out, "\n");
		}
	}
	text_add(out, "END\n");
}

void script_data_add(struct text *out, const struct figure *figure)
{
	for (size_t p = 0; p < figure->panel_count; p++) {
		const struct figure_panel *panel = &figure->panels[p];

		for (size_t i = 0; i < panel->line_count; i++)
			if (figure_can_be_drawn(panel, &panel->lines[i]))
				add_line_data(out, &panel->lines[i], p, i);
		if (panel->map.rows > 1)
			add_map_data(out, &panel->map, p);
	}
}
