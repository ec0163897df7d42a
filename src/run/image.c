#include "run/image.h"

#include <hdf5.h>
#include <hdf5_hl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct image {
	hid_t file;
	hid_t creation; /* property list of datasets */
	bool failed;
};

/* Whether `result` is good; every HDF5 call below goes through here once. */
static bool good(struct image *image, hid_t result)
{
	if (result < 0)
		image->failed = true;
	return result >= 0;
}

/* HDF5 takes two files in memory with the same name for one: the name tells where the bytes lie. */
enum { NAME_SIZE = 64 };

static const char *image_name(const void *place, bool writable, char name[NAME_SIZE])
{
	(void)snprintf(name, NAME_SIZE, "image at %p%s", place, writable ? ", writable" : "");
	return name;
}

/* No time stamps: the same content is to make the same bytes. No fill values: all is written. */
static hid_t dataset_properties(void)
{
	hid_t list = H5Pcreate(H5P_DATASET_CREATE);

	if (list >= 0 && (H5Pset_obj_track_times(list, false) < 0 ||
						 H5Pset_fill_time(list, H5D_FILL_TIME_NEVER) < 0)) {
		(void)H5Pclose(list);
		return -1;
	}
	return list;
}

/* HDF5 does not survive that its memory runs out: its stack of errors grows without end, it frees twice,
 * or it calls exit (1.10.8). So see first that there is enough for what it will do with `bytes` of image
 * (a copy of our own, its own, one more while that grows), and do not let it tidy up at exit. */
static int prepare(size_t bytes, struct error *err)
{
	size_t need = 3 * bytes + (4U << 20);
	void *room = malloc(need);

	if (!room)
		return error_memory(err, need);
	free(room);
	(void)H5dont_atexit();
	(void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
	return 0;
}

/* NULL when out of memory. */
static struct image *image_new(size_t bytes, struct error *err)
{
	struct image *image;

	if (prepare(bytes, err) != 0)
		return NULL;
	image = calloc(1, sizeof *image);
	if (!image) {
		(void)error_memory(err, sizeof *image);
		return NULL;
	}
	image->file = -1;
	image->creation = dataset_properties();
	(void)good(image, image->creation);
	return image;
}

static int image_begun(struct image *image, struct image **out, struct error *err)
{
	*out = image;
	if (!image->failed && image->file >= 0)
		return 0;
	if (image->file >= 0)
		(void)H5Fclose(image->file);
	(void)H5Pclose(image->creation);
	free(image);
	*out = NULL;
	return error_set(err, EX_SOFTWARE, "HDF5 cannot begin an image (out of memory?)");
}

int image_create(size_t payload, struct image **out, struct error *err)
{
	hid_t access, creation;
	struct image *image = image_new(payload, err);
	char name[NAME_SIZE];

	*out = NULL;
	if (!image)
		return -1;
	access = H5Pcreate(H5P_FILE_ACCESS);
	creation = H5Pcreate(H5P_FILE_CREATE);
	/* Grown once: the metadata of a run are some 100 kB. Names are listed in the order of creation.
	 * The oldest format bounds stay: H5Fget_file_image clears a flag in the newer superblocks and not
	 * their checksum (1.10.8), and such an image cannot be opened. */
	if (good(image, H5Pset_fapl_core(access, payload + (1U << 18), false)) &&
		good(image, H5Pset_obj_track_times(creation, false)) &&
		good(image,
			H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED)) &&
		good(image,
			H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED)))
		image->file = H5Fcreate(image_name(image, true, name), H5F_ACC_TRUNC, creation, access);
	(void)H5Pclose(access);
	(void)H5Pclose(creation);
	return image_begun(image, out, err);
}

/* Not H5LTopen_file_image: it leaks a few bytes for every image (1.10.8). */
int64_t image_open(unsigned char *bytes, size_t size, bool writable, struct error *err)
{
	hid_t access, file = -1;
	char name[NAME_SIZE];

	if (prepare(size, err) != 0)
		return -1;
	access = H5Pcreate(H5P_FILE_ACCESS);
	/* the property list takes a copy: `bytes` are only read */
	if (H5Pset_fapl_core(access, 1U << 18, false) >= 0 &&
		H5Pset_file_image(access, bytes, size) >= 0)
		file = H5Fopen(
			image_name(bytes, writable, name), writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
	(void)H5Pclose(access);
	return file;
}

int image_reopen(unsigned char *bytes, size_t size, struct image **out, struct error *err)
{
	struct image *image = image_new(size, err);

	*out = NULL;
	if (!image)
		return -1;
	image->file = image_open(bytes, size, true, err);
	return image_begun(image, out, err);
}

/* An attribute of any type; one that exists is replaced. */
static void attribute(struct image *image, hid_t object, const char *name, hid_t type,
	hid_t memory_type, const void *value)
{
	hid_t space, id;

	if (image->failed)
		return;
	if (H5Aexists(object, name) > 0)
		(void)good(image, H5Adelete(object, name));
	space = H5Screate(H5S_SCALAR);
	id = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
	if (good(image, id)) {
		(void)good(image, H5Awrite(id, memory_type, value));
		(void)good(image, H5Aclose(id));
	}
	(void)H5Sclose(space);
}

static void text_attribute(struct image *image, hid_t object, const char *name, const char *value)
{
	hid_t type;
	size_t length = strlen(value);

	if (image->failed)
		return;
	type = H5Tcopy(H5T_C_S1);
	if (good(image, type) && good(image, H5Tset_size(type, length ? length : 1)) &&
		good(image, H5Tset_strpad(type, H5T_STR_NULLPAD)) &&
		good(image, H5Tset_cset(type, H5T_CSET_UTF8)))
		attribute(image, object, name, type, type, value);
	(void)H5Tclose(type);
}

void image_text(struct image *image, const char *name, const char *value)
{
	text_attribute(image, image->file, name, value);
}

void image_real(struct image *image, const char *name, double value)
{
	attribute(image, image->file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void image_whole(struct image *image, const char *name, int value)
{
	attribute(image, image->file, name, H5T_STD_I32LE, H5T_NATIVE_INT, &value);
}

void image_group(struct image *image, const char *path)
{
	hid_t list, group;

	if (image->failed)
		return;
	list = H5Pcreate(H5P_GROUP_CREATE);
	if (good(image, list) && good(image, H5Pset_obj_track_times(list, false)) &&
		good(image,
			H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED))) {
		group = H5Gcreate2(image->file, path, H5P_DEFAULT, list, H5P_DEFAULT);
		if (good(image, group))
			(void)H5Gclose(group);
	}
	(void)H5Pclose(list);
}

/* Create, describe and fill a dataset; the caller closes what comes back. */
static hid_t write_dataset(struct image *image, const struct image_data *data)
{
	hsize_t extent[3];
	hid_t space, id;

	if (image->failed)
		return -1;
	for (int i = 0; i < data->rank; i++)
		extent[i] = data->extent[i];
	space = data->rank ? H5Screate_simple(data->rank, extent, NULL) : H5Screate(H5S_SCALAR);
	id = H5Dcreate2(image->file, data->path, data->whole ? H5T_STD_I64LE : H5T_IEEE_F64LE, space,
		H5P_DEFAULT, image->creation, H5P_DEFAULT);
	(void)H5Sclose(space);
	if (!good(image, id))
		return -1;
	(void)good(image, H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data->values));
	text_attribute(image, id, "units", data->units);
	text_attribute(image, id, "long_name", data->long_name);
	if (data->standard_name)
		text_attribute(image, id, "standard_name", data->standard_name);
	return id;
}

void image_scale(struct image *image, const struct image_data *data)
{
	hid_t id = write_dataset(image, data);
	const char *name = strrchr(data->path, '/');

	if (id < 0)
		return;
	(void)good(image, H5DSset_scale(id, name ? name + 1 : data->path));
	(void)H5Dclose(id);
}

/* An axis that has a length and nothing else, as netCDF knows them: by this very sentence. It has no
 * data and takes no room. */
static hid_t nameless_scale(struct image *image, size_t extent)
{
	hsize_t length = extent;
	char path[64], name[80];
	hid_t space, list, id;

	(void)snprintf(path, sizeof path, "/checkpoint/index_%zu", extent);
	if (H5Lexists(image->file, path, H5P_DEFAULT) > 0)
		return H5Dopen2(image->file, path, H5P_DEFAULT);
	(void)snprintf(
		name, sizeof name, "This is a netCDF dimension but not a netCDF variable.%10zu", extent);
	space = H5Screate_simple(1, &length, NULL);
	list = H5Pcopy(image->creation);
	(void)good(
		image, H5Pset_fill_time(list, H5D_FILL_TIME_IFSET)); /* or it would read as anything */
	id = H5Dcreate2(image->file, path, H5T_IEEE_F32BE, space, H5P_DEFAULT, list, H5P_DEFAULT);
	(void)H5Pclose(list);
	(void)H5Sclose(space);
	if (!good(image, id))
		return -1;
	text_attribute(image, id, "units", "1");
	text_attribute(image, id, "long_name", "an axis of this length");
	(void)good(image, H5DSset_scale(id, name));
	return id;
}

void image_dataset(struct image *image, const struct image_data *data)
{
	hid_t id = write_dataset(image, data);

	if (id < 0)
		return;
	for (int i = 0; i < data->rank && !image->failed; i++) {
		hid_t scale = data->scales[i] ? H5Dopen2(image->file, data->scales[i], H5P_DEFAULT)
									  : nameless_scale(image, data->extent[i]);

		if (!good(image, scale))
			break;
		(void)good(image, H5DSattach_scale(id, scale, (unsigned)i));
		(void)H5Dclose(scale);
	}
	(void)H5Dclose(id);
}

int image_finish(
	struct image *image, size_t room, unsigned char **bytes, size_t *size, struct error *err)
{
	ssize_t length = -1;
	int result = -1;

	*bytes = NULL;
	if (!image->failed && good(image, H5Fflush(image->file, H5F_SCOPE_GLOBAL)))
		length = H5Fget_file_image(image->file, NULL, 0);
	if (length < 0) {
		error_set(err, EX_SOFTWARE, "HDF5 cannot make the image of a run file (out of memory?)");
		goto done;
	}
	*size = (size_t)length;
	*bytes = malloc(*size + room);
	if (!*bytes) {
		error_memory(err, *size + room);
		goto done;
	}
	if (H5Fget_file_image(image->file, *bytes, *size) != length) {
		error_set(
			err, EX_SOFTWARE, "HDF5 cannot hand out the image of a run file (out of memory?)");
		goto done;
	}
	result = 0;
done:
	(void)H5Fclose(image->file);
	(void)H5Pclose(image->creation);
	free(image);
	if (result) {
		free(*bytes);
		*bytes = NULL;
	}
	return result;
}
