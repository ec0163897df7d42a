/* What an open run file holds: attributes, datasets, their axes and names. */
#include <hdf5_hl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_private.h"

/* HDF5 cannot read `name`. Of a file whose digest is right that is no fault of the file: memory ran out. */
static int unreadable(struct run_file *file, const char *what, const char *name, struct error *err)
{
	if (file->verified)
		return error_set(err, EX_SOFTWARE, "HDF5 cannot read %s '%s' (out of memory?)", what, name);
	return error_at(err, EX_DATAERR, file->path, 0, 0, "%s '%s' cannot be read", what, name);
}

static int attribute_error(struct run_file *file, const char *name, struct error *err)
{
	return error_at(err, EX_DATAERR, file->path, 0, 0,
		"attribute '%s' is absent or not of the right type", name);
}

/* Negative with `err` set when the object has no such attribute, or none that HDF5 can open. */
static hid_t open_attribute(
	struct run_file *file, hid_t object, const char *name, struct error *err)
{
	htri_t there = H5Aexists(object, name);
	hid_t id = there > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;

	if (there == 0)
		(void)attribute_error(file, name, err);
	else if (id < 0)
		(void)unreadable(file, "attribute", name, err);
	return id;
}

/* Add the text attribute of an object. */
static int read_text(
	struct run_file *file, hid_t object, const char *name, struct text *out, struct error *err)
{
	hid_t id = open_attribute(file, object, name, err), type = id < 0 ? -1 : H5Aget_type(id);
	size_t size = type < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0
					  ? 0
					  : H5Tget_size(type);
	char *value = size ? calloc(1, size + 1) : NULL;
	int result = -1;

	if (size && !value) {
		error_memory(err, size + 1);
	} else if (id >= 0 && (type < 0 || (size && H5Aread(id, type, value) < 0))) {
		unreadable(file, "attribute", name, err);
	} else if (size) {
		text_add(out, value);
		result = out->failed ? error_memory(err, size) : 0;
	} else {
		attribute_error(file, name, err);
	}
	free(value);
	if (type >= 0)
		(void)H5Tclose(type);
	if (id >= 0)
		(void)H5Aclose(id);
	return result;
}

int run_file_text(struct run_file *file, const char *name, struct text *out, struct error *err)
{
	return read_text(file, file->id, name, out, err);
}

int run_file_dataset_text(
	struct run_file *file, const char *path, const char *name, struct text *out, struct error *err)
{
	hid_t id = H5Dopen2(file->id, path, H5P_DEFAULT);
	htri_t there = id < 0 ? -1 : H5Aexists(id, name);
	int result = 0;

	if (there > 0)
		result = read_text(file, id, name, out, err);
	else if (there < 0)
		result = unreadable(file, "the attributes of dataset", path, err);
	if (id >= 0)
		(void)H5Dclose(id);
	return result;
}

int run_file_real(struct run_file *file, const char *name, double *out, struct error *err)
{
	hid_t id = open_attribute(file, file->id, name, err), space = id < 0 ? -1 : H5Aget_space(id),
		  type = space < 0 ? -1 : H5Aget_type(id);
	H5T_class_t kind = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
	bool number = type >= 0 && (kind == H5T_FLOAT || kind == H5T_INTEGER) &&
				  H5Sget_simple_extent_npoints(space) == 1;
	int result = -1;

	if (type >= 0 && !number)
		attribute_error(file, name, err);
	else if (number && H5Aread(id, H5T_NATIVE_DOUBLE, out) >= 0)
		result = 0;
	else if (id >= 0)
		unreadable(file, "attribute", name, err);
	if (type >= 0)
		(void)H5Tclose(type);
	if (space >= 0)
		(void)H5Sclose(space);
	if (id >= 0)
		(void)H5Aclose(id);
	return result;
}

int run_file_config(struct run_file *file, struct config *config, struct error *err)
{
	struct text text = {0};
	int result = run_file_text(file, "config", &text, err);

	if (result == 0)
		result = config_parse(config, text_string(&text), text.length, file->path, NULL, 0, err);
	text_clean(&text);
	return result;
}

/* Open a dataset of numbers and tell its shape. */
static hid_t open_dataset(
	struct run_file *file, const char *path, struct dataset *shape, struct error *err)
{
	hsize_t extent[3] = {0};
	hid_t id, space;
	bool has = false;
	int rank;

	shape->rank = -1;
	if (run_file_has(file, path, &has, err) != 0)
		return -1;
	id = has ? H5Dopen2(file->id, path, H5P_DEFAULT) : -1;
	space = id < 0 ? -1 : H5Dget_space(id);
	rank = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
	if (!has)
		error_at(err, EX_DATAERR, file->path, 0, 0, "holds no dataset '%s'", path);
	else if (rank > 3)
		error_at(err, EX_DATAERR, file->path, 0, 0, "dataset '%s' has too many axes", path);
	else if (rank < 0 || H5Sget_simple_extent_dims(space, extent, NULL) < 0)
		unreadable(file, "dataset", path, err);
	else
		shape->rank = rank;
	for (int i = 0; i < 3; i++)
		shape->extent[i] = extent[i];
	if (space >= 0)
		(void)H5Sclose(space);
	if (id >= 0 && shape->rank < 0) {
		(void)H5Dclose(id);
		id = -1;
	}
	return id;
}

/* The number of values of a shape; SIZE_MAX / 16 where it cannot be held. */
static size_t shape_count(const struct dataset *shape)
{
	size_t count = 1;

	for (int i = 0; i < shape->rank; i++) {
		if (shape->extent[i] && count > SIZE_MAX / 16 / shape->extent[i])
			return SIZE_MAX / 16;
		count *= shape->extent[i];
	}
	return count;
}

int run_file_dataset(
	struct run_file *file, const char *path, struct dataset *out, struct error *err)
{
	size_t count;
	hid_t id = open_dataset(file, path, out, err);
	int result = -1;

	out->values = NULL;
	if (id < 0)
		return -1;
	count = shape_count(out);
	out->values = calloc(count + 1, sizeof *out->values); /* HDF5 leaves unwritten values alone */
	if (!out->values)
		error_memory(err, count * sizeof *out->values);
	else if (H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out->values) < 0)
		unreadable(file, "dataset", path, err);
	else
		result = 0;
	(void)H5Dclose(id);
	if (result) {
		free(out->values);
		out->values = NULL;
	}
	return result;
}

int run_file_fill(
	struct run_file *file, const char *path, double *values, size_t count, struct error *err)
{
	struct dataset shape;
	hid_t id = open_dataset(file, path, &shape, err);
	int result = 0;

	if (id < 0)
		return -1;
	if (shape_count(&shape) != count)
		result = error_at(err, EX_DATAERR, file->path, 0, 0,
			"dataset '%s' has %zu values instead of %zu", path, shape_count(&shape), count);
	else if (H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
		result = unreadable(file, "dataset", path, err);
	(void)H5Dclose(id);
	return result;
}

static int axis_count(hid_t dataset)
{
	hid_t space = H5Dget_space(dataset);
	int rank = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);

	if (space >= 0)
		(void)H5Sclose(space);
	return rank;
}

/* Call `visit` with the scale that axis `axis` of a dataset has, or with the dataset if it is one itself. */
static int visit_scale(struct run_file *file, const char *path, int axis, H5DS_iterate_t visit,
	void *out, struct error *err)
{
	int rank = 0, result = 0;
	htri_t scale;
	hid_t id;

	if (H5Lexists(file->id, path, H5P_DEFAULT) == 0)
		return 0;
	id = H5Dopen2(file->id, path, H5P_DEFAULT);
	scale = id < 0 ? -1 : H5DSis_scale(id);
	if (scale > 0)
		result = visit(id, 0, id, out);
	else if (scale == 0)
		rank = axis_count(id);
	if (axis < rank)
		result = H5DSiterate_scales(id, (unsigned)axis, NULL, visit, out);
	if (scale < 0 || rank < 0 || result < 0)
		result = unreadable(file, "the axes of dataset", path, err);
	if (id >= 0)
		(void)H5Dclose(id);
	return result < 0 ? -1 : 0;
}

static herr_t read_length(hid_t dataset, unsigned axis, hid_t scale, void *length)
{
	hid_t space = H5Dget_space(scale);

	(void)dataset;
	(void)axis;
	*(size_t *)length = space < 0 ? 0 : (size_t)H5Sget_simple_extent_npoints(space);
	return space < 0 ? -1 : H5Sclose(space);
}

int run_file_scale_length(
	struct run_file *file, const char *path, int axis, size_t *length, struct error *err)
{
	*length = 0;
	return visit_scale(file, path, axis, read_length, length, err);
}

static herr_t read_name(hid_t dataset, unsigned axis, hid_t scale, void *out)
{
	char name[256];

	(void)dataset;
	(void)axis;
	if (H5Iget_name(scale, name, sizeof name) <= 0)
		return -1;
	text_add(out, name + (name[0] == '/'));
	return 1; /* the first is enough */
}

int run_file_scale_name(
	struct run_file *file, const char *path, int axis, struct text *out, struct error *err)
{
	int result = visit_scale(file, path, axis, read_name, out, err);

	return out->failed ? error_memory(err, out->capacity) : result;
}

/* H5Lexists fails where a group on the way is absent: so go down step by step. */
int run_file_has(struct run_file *file, const char *path, bool *has, struct error *err)
{
	char part[512];
	size_t end = *path == '/';
	htri_t there = 1;

	while (there > 0 && path[end]) {
		end += 1 + strcspn(path + end + 1, "/");
		(void)snprintf(part, sizeof part, "%.*s", (int)end, path);
		there = H5Lexists(file->id, part, H5P_DEFAULT);
	}
	*has = there > 0;
	return there < 0 ? unreadable(file, "the name", path, err) : 0;
}

static herr_t add_name(hid_t group, const char *name, const H5L_info_t *info, void *out)
{
	hid_t id = H5Oopen(group, name, H5P_DEFAULT);

	(void)info;
	if (id < 0)
		return -1;
	if (H5Iget_type(id) == H5I_DATASET)
		text_addf(out, "/%s\n", name);
	return H5Oclose(id);
}

int run_file_names(struct run_file *file, struct text *out, struct error *err)
{
	if (H5Lvisit(file->id, H5_INDEX_NAME, H5_ITER_INC, add_name, out) < 0)
		return unreadable(file, "the list of datasets of", "/", err);
	return out->failed ? error_memory(err, out->capacity) : 0;
}
