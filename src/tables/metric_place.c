/* Metrics of one column of layers: at a profile time and a position. */
#include <math.h>
#include <stdlib.h>

#include "tables/metric_parts.h"

/* The cell whose middle is nearest. EX_DATAERR: outside the domain. */
static int find_cell(struct run_file *file, double at, size_t *cell, struct error *err)
{
	struct dataset x = {0};
	size_t count;

	TRY(metric_read(file, "x", &x, err));
	count = metric_count(&x);
	*cell = 0;
	for (size_t i = 1; i < count; i++)
		if (fabs(x.values[i] - at) < fabs(x.values[*cell] - at))
			*cell = i;
	if (count > 1 && fabs(x.values[*cell] - at) > 0.51 * (x.values[1] - x.values[0]))
		(void)error_set(err, EX_DATAERR, "x = %g m lies outside the domain", at);
	free(x.values);
	return err->code ? -1 : 0;
}

int metric_mean_velocity(const struct sample *sample, double *out, struct error *err)
{
	const struct real_list *shares = &sample->config->layer_fractions;
	struct dataset u = {0};
	size_t row, cell;

	TRY(metric_profile_row(sample->file, sample->at, &row, err));
	TRY(find_cell(sample->file, sample->x, &cell, err));
	TRY(metric_read(sample->file, "u", &u, err));
	if (u.rank != 3 || row >= u.extent[0] || cell >= u.extent[2]) {
		free(u.values);
		return error_set(err, EX_DATAERR, "dataset 'u' is not profile_time by layer by x");
	}
	*out = 0;
	for (size_t a = 0; a < u.extent[1]; a++)
		*out += u.values[(row * u.extent[1] + a) * u.extent[2] + cell] *
				(shares->count ? shares->values[a] : 1.0 / (double)u.extent[1]);
	free(u.values);
	return 0;
}
