#include "run/probes.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"

static const struct {
	const char *name, *profile, *axis;
	size_t at; /* of the positions in struct config */
} wanted[PROBES_MAX] = {
	{"h_gauge", "h", "gauge", offsetof(struct config, output.gauges)},
	{"h_station", "h", "station", offsetof(struct config, output.velocity_at)},
	{"u_station", "u", "station", offsetof(struct config, output.velocity_at)},
	{"w_station", "w", "station", offsetof(struct config, output.velocity_at)},
};

static const struct {
	const char *name, *long_name;
} axes_known[] = {
	{"gauge", "distance along the slope, gauges of the thickness"},
	{"station", "distance along the slope, stations of the velocity"},
};

static size_t width(const struct probe *probe)
{
	return (size_t)probe->at->count * probe->layers;
}

int probes_init(struct probes *probes, const struct model *model, const struct config *config,
	const struct axes *axes, struct error *err)
{
	size_t most = 0;

	*probes = (struct probes){.cells = (size_t)axes->cells, .x = axes->x};
	for (size_t i = 0; i < PROBES_MAX && axes->cells > 0; i++) {
		const struct real_list *at = (const void *)((const char *)config + wanted[i].at);

		for (size_t p = 0; at->count && p < model->profile_count; p++) {
			const struct profile *profile = &model->profiles[p];
			bool over_layers = profile->shape == PROFILE_LAYER_X;

			if (strcmp(profile->name, wanted[i].profile) != 0)
				continue;
			probes->items[probes->count++] = (struct probe){wanted[i].name, wanted[i].axis, profile,
				p, at, over_layers ? (size_t)axes->layers : 1, NULL};
			most = over_layers || !most ? probes->cells * probes->items[probes->count - 1].layers
										: most;
		}
	}
	probes->field = malloc((most + 1) * sizeof *probes->field);
	return probes->field ? 0 : error_memory(err, most * sizeof *probes->field);
}

void probes_clean(struct probes *probes)
{
	for (size_t i = 0; i < probes->count; i++)
		free(probes->items[i].rows);
	free(probes->field);
	*probes = (struct probes){0};
}

int probes_reserve(struct probes *probes, size_t rows, struct error *err)
{
	for (size_t i = 0; i < probes->count; i++) {
		struct probe *probe = &probes->items[i];
		size_t bytes = rows * width(probe) * sizeof *probe->rows;
		double *larger = realloc(probe->rows, bytes);

		if (!larger)
			return error_memory(err, bytes);
		probe->rows = larger;
	}
	return 0;
}

size_t probes_width(const struct probes *probes)
{
	size_t sum = 0;

	for (size_t i = 0; i < probes->count; i++)
		sum += width(&probes->items[i]);
	return sum;
}

/* Between the centres around `x`; beyond the first and the last, theirs. `*share` is that of the cell
 * after `*cell`. */
static void find_cell(const struct probes *probes, double x, size_t *cell, double *share)
{
	const double *centre = probes->x;
	size_t i = 0;

	*cell = 0;
	*share = 0;
	if (probes->cells < 2 || x <= centre[0])
		return;
	while (i + 2 < probes->cells && centre[i + 1] < x)
		i++;
	*cell = i;
	*share = x < centre[i + 1] ? (x - centre[i]) / (centre[i + 1] - centre[i]) : 1;
}

void probes_observe(
	struct probes *probes, const struct model *model, const struct model_state *state, size_t row)
{
	for (size_t i = 0; i < probes->count; i++) {
		const struct probe *probe = &probes->items[i];
		double *values = probe->rows + row * width(probe);

		model->profile(state, probe->index, probes->field);
		for (int k = 0; k < probe->at->count; k++) {
			size_t cell;
			double share;

			find_cell(probes, probe->at->values[k], &cell, &share);
			for (size_t a = 0; a < probe->layers; a++) {
				const double *at = probes->field + a * probes->cells + cell;

				*values++ = share > 0 ? at[0] + share * (at[1] - at[0]) : at[0];
			}
		}
	}
}

static void write_axis(const struct probes *probes, size_t index, struct image *image)
{
	for (size_t i = 0; i < probes->count; i++)
		if (!strcmp(probes->items[i].axis, axes_known[index].name)) {
			image_scale(image, &(struct image_data){.path = axes_known[index].name,
								   .units = "m",
								   .long_name = axes_known[index].long_name,
								   .rank = 1,
								   .extent = {(size_t)probes->items[i].at->count},
								   .values = probes->items[i].at->values});
			return;
		}
}

void probes_write(const struct probes *probes, size_t rows, struct image *image)
{
	for (size_t i = 0; i < sizeof axes_known / sizeof *axes_known; i++)
		write_axis(probes, i, image);
	for (size_t i = 0; i < probes->count; i++) {
		const struct probe *probe = &probes->items[i];
		bool over_layers = probe->profile->shape == PROFILE_LAYER_X;

		image_dataset(image, &(struct image_data){.path = probe->name,
								 .units = probe->profile->units,
								 .long_name = probe->profile->long_name,
								 .rank = over_layers ? 3 : 2,
								 .extent = {rows, (size_t)probe->at->count, probe->layers},
								 .scales = {"time", probe->axis, over_layers ? "layer" : NULL},
								 .values = probe->rows});
	}
}

int probes_read(struct probes *probes, struct run_file *file, size_t rows, struct error *err)
{
	for (size_t i = 0; i < probes->count; i++)
		TRY(run_file_fill(file, probes->items[i].name, probes->items[i].rows,
			rows * width(&probes->items[i]), err));
	return 0;
}
