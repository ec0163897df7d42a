#include "talus/run_file.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "run/image.h"
#include "run/run_file_private.h"
#include "run/trailer.h"

const char *run_status_name(enum run_status status)
{
	static const char *const names[] = {"unfinished", "complete", "failed"};

	return names[status];
}

/* The length that the HDF5 superblock gives the file; 0: these bytes are no HDF5 file. */
static uint64_t superblock_length(const unsigned char *bytes, size_t size)
{
	static const unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
	static const size_t places[] = {40, 44, 28, 28}; /* by version of the superblock */
	uint64_t length;

	if (size < TRAILER_SIZE || memcmp(bytes, signature, sizeof signature) != 0 || bytes[8] > 3)
		return 0;
	memcpy(&length, bytes + places[bytes[8]], sizeof length);
	return le64toh(length);
}

/* Decide from the bytes alone, before HDF5 sees any of them, whether the file is good. */
static int verify(struct run_file *file, size_t size, bool *trailer, struct error *err)
{
	uint64_t length = superblock_length(file->bytes, size), image_size;
	const unsigned char *end;

	if (size < TRAILER_SIZE)
		return error_at(err, EX_DATAERR, file->path, 0, 0,
			"is not a run file, or what is left of one: it has %zu bytes", size);
	end = file->bytes + size - TRAILER_SIZE;
	*trailer = trailer_read(end, &file->summary, &image_size);
	if (*trailer && image_size != size - TRAILER_SIZE)
		return error_at(err, EX_DATAERR, file->path, 0, 0,
			"is damaged: it should have %llu bytes and has %zu",
			(unsigned long long)image_size + TRAILER_SIZE, size);
	if (*trailer && !trailer_matches(end, file->bytes, size - TRAILER_SIZE))
		return error_at(
			err, EX_DATAERR, file->path, 0, 0, "is damaged: its content does not match its digest");
	if (!*trailer && !length)
		return error_at(err, EX_DATAERR, file->path, 0, 0, "is not a run file");
	if (!*trailer && length != size)
		return error_at(
			err, EX_DATAERR, file->path, 0, 0, "is damaged: its trailer is missing or changed");
	file->size = *trailer ? size - TRAILER_SIZE : size;
	return 0;
}

/* What the trailer would say, from the content. */
static int summarise(struct run_file *file, struct error *err)
{
	struct text status = {0}, hash = {0};
	double step, time;
	int result = -1;

	if (run_file_text(file, "status", &status, err) != 0 ||
		run_file_text(file, "config_hash", &hash, err) != 0 ||
		run_file_fill(file, "/checkpoint/step", &step, 1, err) != 0 ||
		run_file_fill(file, "/checkpoint/time", &time, 1, err) != 0)
		goto done;
	file->summary = (struct run_summary){.step = (uint64_t)step, .time = time};
	for (int i = RUN_UNFINISHED; i <= RUN_FAILED; i++)
		if (!strcmp(text_string(&status), run_status_name((enum run_status)i)))
			file->summary.status = (enum run_status)i;
	strncat(file->summary.config_hash, text_string(&hash), sizeof file->summary.config_hash - 1);
	result = 0;
done:
	text_clean(&status);
	text_clean(&hash);
	return result;
}

int run_file_open(const char *path, struct run_file **out, const char **warning, struct error *err)
{
	struct run_file *file = calloc(1, sizeof *file);
	bool trailer = true;
	size_t size;

	*out = NULL;
	if (warning)
		*warning = NULL;
	if (!file)
		return error_memory(err, sizeof *file);
	file->id = -1;
	file->path = strdup(path);
	if (!file->path) {
		error_memory(err, strlen(path) + 1);
		goto failed;
	}
	if (file_read(path, &file->bytes, &size, err) != 0 || verify(file, size, &trailer, err) != 0)
		goto failed;
	/* an image of ours whose digest is right is good: to fall back would throw it away */
	file->verified = trailer && superblock_length(file->bytes, file->size) == file->size;
	file->id = image_open(file->bytes, file->size, false, err);
	if (file->id < 0) {
		error_at(err, file->verified ? EX_SOFTWARE : EX_DATAERR, path, 0, 0,
			file->verified ? "is whole, but HDF5 cannot open it (out of memory?)"
						   : "is not a run file: HDF5 cannot open it");
		goto failed;
	}
	if (!trailer && summarise(file, err) != 0)
		goto failed;
	if (!trailer && warning)
		*warning = "has no trailer (a copy made by another program?): its content is not verified";
	*out = file;
	return 0;
failed:
	run_file_close(file);
	return -1;
}

void run_file_close(struct run_file *file)
{
	if (!file)
		return;
	if (file->id >= 0)
		(void)H5Fclose(file->id);
	free(file->bytes);
	free(file->path);
	free(file);
}

int run_file_peek(const char *path, struct run_summary *summary, struct error *err)
{
	unsigned char trailer[TRAILER_SIZE];
	uint64_t image_size;
	size_t size;

	TRY(file_read_end(path, trailer, sizeof trailer, &size, err));
	if (!trailer_read(trailer, summary, &image_size) || image_size != size - TRAILER_SIZE)
		return error_at(err, EX_DATAERR, path, 0, 0, "has no trailer: it is damaged or a copy");
	return 0;
}

const char *run_file_path(const struct run_file *file)
{
	return file->path;
}

const struct run_summary *run_file_summary(const struct run_file *file)
{
	return &file->summary;
}

unsigned char *run_file_image(const struct run_file *file, size_t *size)
{
	*size = file->size;
	return file->bytes;
}
