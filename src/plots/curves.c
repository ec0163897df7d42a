#include "plots/curves.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "config/yaml.h"
#include "plots/meaning.h"

/* Okabe and Ito's colours, which the colour-blind can tell apart; without yellow, which is lost on white. */
static const unsigned colours[] = {
	0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0x56B4E9, 0xE69F00, 0x000000};
enum { COLOURS = sizeof colours / sizeof *colours, BLACK = 0x000000 };

/* Nine colours of viridis: one after the other for the blind as well. */
enum { VIRIDIS = 9 };
static const unsigned viridis[VIRIDIS] = {
	0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C, 0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};

bool curves_add_dimension(struct curves *curves, const char *name, bool split, bool ordered)
{
	if (curves->dimension_count == CURVES_PARTS_MAX)
		return false;
	curves->dimensions[curves->dimension_count++] = (struct curves_dimension){name, split, ordered};
	return true;
}

struct curve *curves_add(struct curves *curves, struct error *err)
{
	size_t bytes = (curves->count + 1) * sizeof *curves->items;
	struct curve *items = realloc(curves->items, bytes);

	if (!items) {
		(void)error_memory(err, bytes);
		return NULL;
	}
	curves->items = items;
	items += curves->count++;
	*items = (struct curve){0};
	return items;
}

int curves_set_part(struct curve *curve, size_t dimension, const char *text, struct error *err)
{
	free(curve->parts[dimension]);
	curve->parts[dimension] = text ? strdup(text) : NULL;
	return !text || curve->parts[dimension] ? 0 : error_memory(err, strlen(text));
}

/* The values of a dimension, each once, in the order of the curves. */
struct values {
	const char **items; /* [count] */
	size_t count;
};

static size_t find_value(const struct values *values, const char *value)
{
	size_t i = 0;

	while (i < values->count && strcmp(values->items[i], value) != 0)
		i++;
	return i;
}

static int list_values(
	const struct curves *curves, size_t dimension, struct values *values, struct error *err)
{
	values->items = calloc(curves->count + 1, sizeof *values->items);
	if (!values->items)
		return error_memory(err, (curves->count + 1) * sizeof *values->items);
	for (size_t i = 0; i < curves->count; i++) {
		const char *part = curves->items[i].parts[dimension];

		if (part && find_value(values, part) == values->count)
			values->items[values->count++] = part;
	}
	return 0;
}

/* A value of a config as people say it: "22 deg" -> "22°". */
static void add_value(const char *name, const char *value, struct text *out)
{
	const char *dot = strrchr(name, '.'), *degrees = strstr(value, " deg");
	bool number = isdigit((unsigned char)*value) || *value == '-' || *value == '[';

	if (number || !strncmp(value, "tan(", 4))
		for (const char *at = dot ? dot + 1 : name; *at; at++)
			text_addf(out, "%c%s", *at == '_' ? ' ' : *at, at[1] ? "" : " ");
	if (degrees && !degrees[4])
		text_addf(out, "%.*s°", (int)(degrees - value), value);
	else
		text_add(out, value);
}

static void add_part(const struct curves *curves, size_t dimension, const char *value,
	const struct node *names, struct text *out)
{
	const char *name = curves->dimensions[dimension].name;
	const struct node *given = names ? node_find(names, value) : NULL;

	if (given)
		text_add(out, given->text);
	else if (!strcmp(name, "at"))
		text_addf(out, "t = %s", value);
	else if (!strcmp(name, "at_x"))
		text_addf(out, "x = %s", value);
	else if (!strcmp(name, "y"))
		text_add(out, meaning_words(value) ? meaning_words(value) : value);
	else if (!strcmp(name, "run"))
		text_add(out, value);
	else
		add_value(name, value, out);
}

static void join_parts(const struct curves *curves, const struct curve *curve,
	const struct values *values, bool split, const struct node *names, struct text *out)
{
	for (size_t d = 0; d < curves->dimension_count; d++) {
		bool shown = split ? true : values[d].count > 1;

		if (curves->dimensions[d].split != split || !shown || !curve->parts[d])
			continue;
		text_add(out, out->length ? ", " : "");
		add_part(curves, d, curve->parts[d], names, out);
	}
}

/* Part `share` of the way along viridis. */
static unsigned blend(double share)
{
	double place = share * (VIRIDIS - 1);
	size_t i = (size_t)fmin(floor(place), VIRIDIS - 2);
	unsigned colour = 0;

	for (int shift = 0; shift <= 16; shift += 8) {
		double from = (viridis[i] >> shift) & 0xFF, to = (viridis[i + 1] >> shift) & 0xFF;

		colour |= (unsigned)lround(from + (to - from) * (place - (double)i)) << shift;
	}
	return colour;
}

/* The first way in which the lines differ is their colour, the others together their dashes. */
static void set_style(const struct curves *curves, const struct curve *curve,
	const struct values *values, struct figure_line *line)
{
	bool coloured = false;
	size_t dash = 0;

	line->colour = colours[0];
	for (size_t d = 0; d < curves->dimension_count; d++) {
		const struct curves_dimension *dimension = &curves->dimensions[d];
		size_t index;

		if (dimension->split || values[d].count < 2 || !curve->parts[d])
			continue;
		index = find_value(&values[d], curve->parts[d]);
		if (coloured) {
			dash = dash * values[d].count + index;
			continue;
		}
		coloured = true;
		if (!strcmp(dimension->name, "y")) /* datasets differ in kind: tell them apart twice */
			dash = index;
		line->colour = (dimension->ordered && values[d].count > 2) || values[d].count > COLOURS
						   ? blend(0.88 * (double)index / (double)(values[d].count - 1))
						   : colours[index];
	}
	line->dash = (int)dash;
}

static int add_line(const struct curves *curves, struct curve *curve, const struct values *values,
	const struct experiment_panel *wanted, struct figure_panel *panel, struct error *err)
{
	struct figure_line *line = figure_add_line(panel, err);
	struct text title = {0};

	if (!line)
		return -1;
	set_style(curves, curve, values, line);
	line->mark = curve->title ? FIGURE_POINTS : curves->mark;
	if (curve->title) {
		line->colour = BLACK;
		line->hollow = true;
		line->title = strdup(curve->title);
		if (!line->title)
			return error_memory(err, strlen(curve->title));
	} else {
		join_parts(curves, curve, values, false, wanted->names, &title);
		if (title.failed)
			return error_memory(err, title.length);
		line->title = title.data;
	}
	line->x = curve->x;
	line->y = curve->y;
	line->spread = curve->spread;
	line->count = curve->count;
	curve->x = curve->y = curve->spread = NULL;
	return 0;
}

static bool same_panel(const struct curves *curves, const struct curve *a, const struct curve *b)
{
	for (size_t d = 0; d < curves->dimension_count; d++)
		if (curves->dimensions[d].split && a->parts[d] && b->parts[d] &&
			strcmp(a->parts[d], b->parts[d]) != 0)
			return false;
	return true;
}

static int copy_axis(const struct figure_axis *from, struct figure_axis *to, struct error *err)
{
	*to = *from;
	to->label.text = (struct text){0};
	text_add(&to->label.text, text_string(&from->label.text));
	return to->label.text.failed ? error_memory(err, from->label.text.length) : 0;
}

/* The line that has these values of `lines`, to take its colour. */
static const struct figure_line *find_line(const struct curves *curves,
	const struct experiment_panel *wanted, const struct term_list *values, const struct values *all,
	const struct figure_panel *panel)
{
	for (size_t i = 0; i < curves->count; i++) {
		const struct curve *curve = &curves->items[i];
		struct text title = {0};
		size_t found = 0;
		const struct figure_line *line = NULL;

		for (size_t d = 0; d < curves->dimension_count && found < values->count; d++)
			if (!curves->dimensions[d].split && curve->parts[d] &&
				!strcmp(curve->parts[d], values->items[found].text))
				found++;
		if (found < values->count || curve->title)
			continue;
		join_parts(curves, curve, all, false, wanted->names, &title);
		for (size_t k = 0; k < panel->line_count && !line; k++)
			if (panel->lines[k].title && !strcmp(panel->lines[k].title, text_string(&title)))
				line = &panel->lines[k];
		text_clean(&title);
		if (line)
			return line;
	}
	return NULL;
}

static int add_published(const struct curves *curves, const struct experiment_panel *wanted,
	const struct experiment_points *points, const char *source, const struct values *values,
	struct figure_panel *panel, struct error *err)
{
	const struct figure_line *ours =
		points->line.count ? find_line(curves, wanted, &points->line, values, panel) : NULL;
	unsigned colour = ours ? ours->colour : BLACK;
	int dash = ours ? ours->dash : 0;
	struct text title = {0};
	struct figure_line *line;

	if (*points->title)
		text_add(&title, points->title);
	else
		text_addf(&title, "%s%s%.*s", ours && ours->title ? ours->title : "",
			ours && ours->title ? ", " : "", (int)strcspn(source, " "),
			*source ? source : "published");
	line = figure_add_line(panel, err);
	if (!line || title.failed) {
		text_clean(&title);
		return error_memory(err, title.length);
	}
	line->title = title.data;
	line->mark = FIGURE_POINTS;
	line->colour = colour;
	line->dash = dash;
	line->hollow = true;
	line->x = calloc(points->count, sizeof *line->x);
	line->y = calloc(points->count, sizeof *line->y);
	if (!line->x || !line->y)
		return error_memory(err, points->count * sizeof *line->x);
	memcpy(line->x, points->x, points->count * sizeof *line->x);
	memcpy(line->y, points->y, points->count * sizeof *line->y);
	line->count = points->count;
	return 0;
}

/* The panel that `first` opens, with everything that belongs in it. */
static int draw_panel(struct curves *curves, size_t first, const struct values *values,
	const struct experiment_panel *wanted, const char *source, struct figure *figure,
	struct error *err)
{
	struct figure_panel *panel = figure_add_panel(figure, err);
	struct curve opener = curves->items[first];

	if (!panel)
		return -1;
	text_add(&panel->title, wanted->title);
	if (!panel->title.length)
		join_parts(curves, &opener, values, true, wanted->names, &panel->title);
	TRY(copy_axis(&curves->x, &panel->x, err));
	TRY(copy_axis(&curves->y, &panel->y, err));
	for (size_t i = first; i < curves->count; i++) {
		struct curve *curve = &curves->items[i];

		if (!same_panel(curves, &opener, curve))
			continue;
		if (curve->map.rows) {
			panel->map = curve->map;
			curve->map = (struct figure_map){0};
		} else if (curve->x) {
			TRY(add_line(curves, curve, values, wanted, panel, err));
		}
	}
	if (panel->line_count == 1 && !panel->lines[0].title && wanted->published_count) {
		panel->lines[0].title = strdup("ours");
		if (!panel->lines[0].title)
			return error_memory(err, sizeof "ours");
	}
	for (size_t i = 0; i < wanted->published_count; i++)
		TRY(add_published(curves, wanted, &wanted->published[i], source, values, panel, err));
	return panel->title.failed ? error_memory(err, panel->title.length) : 0;
}

int curves_draw(struct curves *curves, const struct experiment_panel *wanted, const char *source,
	struct figure *figure, struct error *err)
{
	struct values values[CURVES_PARTS_MAX] = {{0}};
	int result = -1;

	for (size_t d = 0; d < curves->dimension_count; d++)
		if (list_values(curves, d, &values[d], err))
			goto done;
	for (size_t i = 0; i < curves->count; i++) {
		size_t k = 0;

		while (k < i && (curves->items[k].title ||
							!same_panel(curves, &curves->items[k], &curves->items[i])))
			k++;
		/* what was measured opens no panel: it is shown where there is something of ours */
		if (k == i && !curves->items[i].title &&
			draw_panel(curves, i, values, wanted, source, figure, err))
			goto done;
	}
	result = 0;
done:
	for (size_t d = 0; d < curves->dimension_count; d++)
		free(values[d].items);
	return result;
}

static void curve_clean(struct curve *curve)
{
	for (size_t d = 0; d < CURVES_PARTS_MAX; d++)
		free(curve->parts[d]);
	free(curve->x);
	free(curve->y);
	free(curve->spread);
	free(curve->title);
	free(curve->map.x);
	free(curve->map.y);
	free(curve->map.values);
	text_clean(&curve->map.label.text);
}

void curves_drop(struct curves *curves)
{
	curve_clean(&curves->items[--curves->count]);
}

void curves_clean(struct curves *curves)
{
	for (size_t i = 0; i < curves->count; i++)
		curve_clean(&curves->items[i]);
	free(curves->items);
	text_clean(&curves->x.label.text);
	text_clean(&curves->y.label.text);
	text_clean(&curves->units[0]);
	text_clean(&curves->units[1]);
	*curves = (struct curves){0};
}
