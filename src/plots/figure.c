#include "plots/figure.h"

#include <math.h>
#include <stdlib.h>

struct figure_panel *figure_add_panel(struct figure *figure, struct error *err)
{
	size_t bytes = (figure->panel_count + 1) * sizeof *figure->panels;
	struct figure_panel *panels = realloc(figure->panels, bytes);

	if (!panels) {
		(void)error_memory(err, bytes);
		return NULL;
	}
	figure->panels = panels;
	panels += figure->panel_count++;
	*panels = (struct figure_panel){
		.x = {.from = NAN, .to = NAN},
		.y = {.from = NAN, .to = NAN},
	};
	return panels;
}

struct figure_line *figure_add_line(struct figure_panel *panel, struct error *err)
{
	size_t bytes = (panel->line_count + 1) * sizeof *panel->lines;
	struct figure_line *lines = realloc(panel->lines, bytes);

	if (!lines) {
		(void)error_memory(err, bytes);
		return NULL;
	}
	panel->lines = lines;
	lines += panel->line_count++;
	*lines = (struct figure_line){0};
	return lines;
}

bool figure_can_be_drawn(const struct figure_panel *panel, const struct figure_line *line)
{
	for (size_t i = 0; i < line->count; i++)
		if (isfinite(line->x[i]) && isfinite(line->y[i]) && (!panel->x.log || line->x[i] > 0) &&
			(!panel->y.log || line->y[i] > 0))
			return true;
	return false;
}

static void panel_clean(struct figure_panel *panel)
{
	for (size_t i = 0; i < panel->line_count; i++) {
		free(panel->lines[i].title);
		free(panel->lines[i].x);
		free(panel->lines[i].y);
		free(panel->lines[i].spread);
	}
	free(panel->lines);
	free(panel->map.x);
	free(panel->map.y);
	free(panel->map.values);
	text_clean(&panel->map.label.text);
	text_clean(&panel->title);
	text_clean(&panel->x.label.text);
	text_clean(&panel->y.label.text);
}

void figure_clean(struct figure *figure)
{
	for (size_t i = 0; i < figure->panel_count; i++)
		panel_clean(&figure->panels[i]);
	free(figure->panels);
	text_clean(&figure->title);
	text_clean(&figure->missing);
	*figure = (struct figure){0};
}
