/* L1 errors against a finer run, P1 (35): what it says is first averaged over the cells and layers here. */
#include <math.h>
#include <stdlib.h>

#include "tables/metric_parts.h"

/* A dataset over x, or over layer and x, at one profile time. */
struct field {
	struct dataset data, x, interface;
	const double *row;    /* [layers][cells] */
	size_t layers, cells; /* one layer where it has none */
};

static void field_clean(struct field *field)
{
	free(field->data.values);
	free(field->x.values);
	free(field->interface.values);
}

/* Clean in every case. */
static int field_read(
	struct run_file *file, const char *name, double time, struct field *field, struct error *err)
{
	struct dataset *data = &field->data;
	size_t row;

	TRY(metric_profile_row(file, time, &row, err));
	TRY(metric_read(file, name, data, err));
	TRY(metric_read(file, "x", &field->x, err));
	TRY(metric_read(file, "interface", &field->interface, err));
	field->cells = metric_count(&field->x);
	field->layers = data->rank == 3 ? data->extent[1] : 1;
	if (data->rank < 2 || row >= data->extent[0] || data->extent[data->rank - 1] != field->cells ||
		field->cells < 2 ||
		(data->rank == 3 && metric_count(&field->interface) != field->layers + 1))
		return error_set(err, EX_DATAERR, "dataset '%s' is not over profile_time and x", name);
	field->row = data->values + row * field->layers * field->cells;
	return 0;
}

static double cell_width(const struct field *field)
{
	return (field->x.values[field->cells - 1] - field->x.values[0]) / (double)(field->cells - 1);
}

/* The left end of the domain, or with `cell` = cells its right one. */
static double cell_edge(const struct field *field, size_t cell)
{
	return field->x.values[0] + ((double)cell - 0.5) * cell_width(field);
}

/* Every cell and layer here is some whole ones of the reference. */
static int check_nested(const struct field *here, const struct field *reference, struct error *err)
{
	const double rounding = 1e-9;
	size_t layers_each = reference->layers / here->layers;

	if (reference->cells % here->cells || reference->layers % here->layers)
		return error_set(err, EX_DATAERR,
			"%zu cells and %zu layers here do not divide the %zu and %zu of the reference",
			here->cells, here->layers, reference->cells, reference->layers);
	for (int end = 0; end < 2; end++)
		if (fabs(cell_edge(here, end ? here->cells : 0) -
				 cell_edge(reference, end ? reference->cells : 0)) > rounding * cell_width(here))
			return error_set(err, EX_DATAERR, "the reference has another domain");
	for (size_t a = 0; here->layers > 1 && a <= here->layers; a++)
		if (fabs(here->interface.values[a] - reference->interface.values[a * layers_each]) >
			rounding)
			return error_set(err, EX_DATAERR, "interface %zu here is none of the reference's", a);
	return 0;
}

static double layer_thickness(const struct field *field, size_t layer)
{
	return field->layers > 1 ? field->interface.values[layer + 1] - field->interface.values[layer]
							 : 1;
}

/* The mean of the reference over a cell and layer of the coarser grid. */
static double project(
	const struct field *reference, const struct field *here, size_t layer, size_t cell)
{
	size_t layers = reference->layers / here->layers, cells = reference->cells / here->cells;
	double sum = 0;

	for (size_t a = layer * layers; a < (layer + 1) * layers; a++) {
		double along = 0;

		for (size_t i = cell * cells; i < (cell + 1) * cells; i++)
			along += reference->row[a * reference->cells + i];
		sum += layer_thickness(reference, a) * along;
	}
	return sum / (layer_thickness(here, layer) * (double)cells);
}

/* Layers are weighted by their thickness; `h` is NULL for what is no field of layers. */
static double distance(
	const struct field *here, const struct field *reference, const struct field *h)
{
	double sum = 0;

	for (size_t a = 0; a < here->layers; a++)
		for (size_t i = 0; i < here->cells; i++)
			sum += (h ? layer_thickness(here, a) * h->row[i] : 1) *
				   fabs(here->row[a * here->cells + i] - project(reference, here, a, i));
	return cell_width(here) * sum;
}

int metric_reference_l1(const struct sample *sample, double *out, struct error *err)
{
	const char *name = sample->metric->dataset;
	struct field here = {0}, reference = {0}, h = {0};
	int result = -1;

	if (field_read(sample->file, name, sample->at, &here, err) ||
		field_read(sample->partner, name, sample->at, &reference, err) ||
		field_read(sample->file, "h", sample->at, &h, err) || check_nested(&here, &reference, err))
		goto done;
	*out = distance(&here, &reference, here.data.rank == 3 ? &h : NULL);
	result = 0;
done:
	field_clean(&here);
	field_clean(&reference);
	field_clean(&h);
	return result;
}
