/* The thickness over x at a profile time, and at the end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tables/metric_parts.h"

/* h_f of P3, which falls as the bed gets thicker. */
int metric_deposit_height(const struct sample *sample, double *out, struct error *err)
{
	TRY(metric_series_last(sample, out, err));
	*out -= config_bed_thickness(sample->config);
	return 0;
}

int metric_thickness(
	struct run_file *file, double time, double **values, size_t *cells, struct error *err)
{
	struct dataset h = {0};
	size_t row;

	*values = NULL;
	TRY(metric_profile_row(file, time, &row, err));
	TRY(metric_read(file, "h", &h, err));
	if (!h.values || h.rank != 2 || row >= h.extent[0]) {
		free(h.values);
		(void)error_set(err, EX_DATAERR, "dataset 'h' is not profile_time by x");
		return -1;
	}
	*cells = h.extent[1];
	memmove(h.values, h.values + row * *cells, *cells * sizeof *h.values);
	*values = h.values;
	return 0;
}

/* ||h - h_ref|| / ||h_ref - h_i|| in percent, over x, in the norm of this power: the papers' errors
 * are against the mass above the erodible bed. */
static int difference(const struct sample *sample, int power, double *out, struct error *err)
{
	const struct config *here = sample->config, *there = sample->partner_config;
	double *h = NULL, *reference = NULL, above = 0, apart = 0, bed = config_bed_thickness(there);
	size_t cells = 0, reference_cells = 0;
	int result = -1;

	if (here->coordinates == there->coordinates &&
		(here->domain.x_min != there->domain.x_min || here->domain.x_max != there->domain.x_max))
		return error_set(err, EX_DATAERR, "its domain is not that of the reference");
	if (metric_thickness(sample->file, sample->at, &h, &cells, err) ||
		metric_thickness(sample->partner, sample->at, &reference, &reference_cells, err))
		goto done;
	if (here->coordinates != there->coordinates && metric_turn_thickness(sample, &h, &cells, err))
		goto done;
	if (cells != reference_cells) {
		error_set(
			err, EX_DATAERR, "%zu cells here and %zu in the reference", cells, reference_cells);
		goto done;
	}
	for (size_t i = 0; i < cells; i++) {
		apart += pow(fabs(h[i] - reference[i]), power);
		above += pow(fabs(reference[i] - bed), power);
	}
	*out = 100 * pow(apart / above, 1.0 / power);
	result = 0;
done:
	free(h);
	free(reference);
	return result;
}

int metric_l1_difference(const struct sample *sample, double *out, struct error *err)
{
	return difference(sample, 1, out, err);
}

int metric_l2_difference(const struct sample *sample, double *out, struct error *err)
{
	return difference(sample, 2, out, err);
}
