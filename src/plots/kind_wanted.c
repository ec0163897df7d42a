/* What a panel wants, read: times, positions and layers, units and labels. */
#include <stdlib.h>
#include <string.h>

#include "config/quantity.h"
#include "plots/kind.h"
#include "plots/meaning.h"
#include "plots/slice.h"

static int read_quantities(const struct term_list *terms, const char *unit, const char *path,
	double **values, size_t *count, struct error *err)
{
	*values = calloc(terms->count + 1, sizeof **values);
	if (!*values)
		return error_memory(err, (terms->count + 1) * sizeof **values);
	for (size_t i = 0; i < terms->count; i++)
		if (quantity_read(terms->items[i].text, unit, &(*values)[i], err))
			return error_place(err, path, terms->items[i].line, terms->items[i].column);
	*count = terms->count;
	return 0;
}

static int read_layers(
	struct kind_cuts *cuts, const struct term_list *terms, const char *path, struct error *err)
{
	cuts->layers = calloc(terms->count + 1, sizeof *cuts->layers);
	if (!cuts->layers)
		return error_memory(err, (terms->count + 1) * sizeof *cuts->layers);
	for (size_t i = 0; i < terms->count; i++) {
		const struct term *term = &terms->items[i];

		if (!strcmp(term->text, "top"))
			cuts->layers[i] = SLICE_TOP;
		else if (!text_to_integer(term->text, &cuts->layers[i]) || cuts->layers[i] < 1)
			return error_at(err, EX_DATAERR, path, term->line, term->column,
				"%s is neither the number of a layer, counted from 1 at the bed, nor top",
				term->text);
	}
	cuts->layer_count = terms->count;
	return 0;
}

int kind_cuts_read(struct kind_cuts *cuts, const struct experiment_panel *wanted, const char *path,
	struct error *err)
{
	*cuts = (struct kind_cuts){0};
	cuts->all_times = wanted->at.count == 1 && !strcmp(wanted->at.items[0].text, "all");
	if (!cuts->all_times)
		TRY(read_quantities(&wanted->at, "s", path, &cuts->times, &cuts->time_count, err));
	TRY(read_quantities(&wanted->at_x, "m", path, &cuts->positions, &cuts->position_count, err));
	return read_layers(cuts, &wanted->layer, path, err);
}

void kind_cuts_clean(struct kind_cuts *cuts)
{
	free(cuts->times);
	free(cuts->positions);
	free(cuts->layers);
	*cuts = (struct kind_cuts){0};
}

static const char *const part_names[KIND_PARTS] = {
	[KIND_Y] = "y", [KIND_AT] = "at", [KIND_AT_X] = "at_x", [KIND_LAYER] = "layer"};

bool kind_add_dimensions(const struct kind_request *request)
{
	for (int part = 0; part < KIND_PARTS; part++) {
		bool split = false;

		for (size_t i = 0; i < request->wanted->split.count; i++)
			split |= !strcmp(request->wanted->split.items[i].text, part_names[part]);
		if (!curves_add_dimension(request->curves, part_names[part], split, part != KIND_Y))
			return false;
	}
	return true;
}

/* The factor of a unit that the experiment chose. */
static int read_unit(const char *path, const struct term *shown, const struct meaning *meaning,
	double *factor, struct error *err)
{
	struct text unit = {0}, one = {0};
	double size;
	int result;

	meaning_unit(meaning->unit, &unit);
	text_addf(&one, "1 %s", shown->text);
	result = quantity_read(text_string(&one), text_string(&unit), &size, err);
	if (result)
		(void)error_place(err, path, shown->line, shown->column);
	else
		*factor = 1 / size;
	text_clean(&unit);
	text_clean(&one);
	return result;
}

int kind_axis(const struct kind_request *request, const struct kind_run *run, int index,
	const struct meaning *meaning, double *factor, struct error *err)
{
	const struct experiment_panel *wanted = request->wanted;
	struct figure_axis *axis = index ? &request->curves->y : &request->curves->x;
	struct meaning all = *meaning;

	*factor = 1;
	all.shown = wanted->units[index].text;
	all.dimensionless = wanted->dimensionless && run->config && !all.shown;
	if (all.dimensionless)
		*factor = 1 / meaning_scale(all.name, all.unit, run->config);
	else if (all.shown)
		TRY(read_unit(request->path, &wanted->units[index], &all, factor, err));
	if (axis->label.text.length)
		return 0;
	text_add(&request->curves->units[index], all.unit);
	if (*wanted->labels[index])
		text_add(&axis->label.text, wanted->labels[index]);
	else
		meaning_label(&all, &axis->label);
	return axis->label.text.failed ? error_memory(err, axis->label.text.length) : 0;
}
