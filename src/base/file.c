#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* read until `count` bytes are there or the file ends; -1 with errno on failure */
static ssize_t read_fully(int fd, unsigned char *bytes, size_t count, off_t offset)
{
	size_t done = 0;

	while (done < count) {
		ssize_t n = pread(fd, bytes + done, count - done, offset + (off_t)done);

		if (n < 0 && errno == EINTR)
			continue;
		if (n < 0)
			return -1;
		if (n == 0)
			break;
		done += (size_t)n;
	}
	return (ssize_t)done;
}

static int write_fully(int fd, const void *bytes, size_t count)
{
	const unsigned char *next = bytes;

	while (count) {
		ssize_t n = write(fd, next, count);

		if (n < 0 && errno == EINTR)
			continue;
		if (n < 0)
			return -1;
		next += n;
		count -= (size_t)n;
	}
	return 0;
}

/* open a regular file for reading and tell its size */
static int open_to_read(const char *path, size_t *size, struct error *err)
{
	struct stat st;
	int fd = open(path, O_RDONLY | O_CLOEXEC);

	if (fd < 0)
		return error_at(err, errno == ENOENT || errno == ENOTDIR ? EX_NOINPUT : EX_IOERR, path, 0,
			0, "cannot be opened: %s", strerror(errno));
	if (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) {
		(void)close(fd);
		return error_at(err, EX_IOERR, path, 0, 0, "is not a regular file");
	}
	*size = (size_t)st.st_size;
	return fd;
}

int file_read(const char *path, unsigned char **bytes, size_t *size, struct error *err)
{
	int fd = open_to_read(path, size, err), result = -1;
	ssize_t n;

	*bytes = NULL;
	if (fd < 0)
		return -1;
	*bytes = malloc(*size + 1);
	if (!*bytes) {
		error_memory(err, *size + 1);
		goto done;
	}
	n = read_fully(fd, *bytes, *size, 0);
	if (n < 0) {
		error_at(err, EX_IOERR, path, 0, 0, "cannot be read: %s", strerror(errno));
		goto done;
	}
	*size = (size_t)n;
	(*bytes)[n] = '\0';
	result = 0;
done:
	(void)close(fd);
	if (result) {
		free(*bytes);
		*bytes = NULL;
	}
	return result;
}

int file_read_end(
	const char *path, unsigned char *bytes, size_t count, size_t *size, struct error *err)
{
	int fd = open_to_read(path, size, err), result = -1;
	ssize_t n;

	if (fd < 0)
		return -1;
	if (*size < count) {
		error_at(err, EX_DATAERR, path, 0, 0, "is only %zu bytes long", *size);
		goto done;
	}
	n = read_fully(fd, bytes, count, (off_t)(*size - count));
	if (n != (ssize_t)count) {
		error_at(err, EX_IOERR, path, 0, 0, "cannot be read: %s",
			n < 0 ? strerror(errno) : "it became shorter");
		goto done;
	}
	result = 0;
done:
	(void)close(fd);
	return result;
}

int file_make_folders(const char *path, struct error *err)
{
	char *copy = strdup(path);
	int result = 0;

	if (!copy)
		return error_memory(err, strlen(path) + 1);
	for (char *end = copy + 1; !result && end[-1]; end++) {
		char kept = *end;

		if (kept != '/' && kept != '\0')
			continue;
		*end = '\0';
		if (mkdir(copy, 0777) != 0 && (errno != EEXIST || !file_is_folder(copy)))
			result = error_at(err, EX_CANTCREAT, copy, 0, 0, "cannot make this folder: %s",
				strerror(errno == EEXIST ? ENOTDIR : errno));
		*end = kept;
	}
	free(copy);
	return result;
}

char *file_size_text(double bytes, char buffer[FILE_SIZE_TEXT])
{
	if (bytes < 1e3)
		(void)snprintf(buffer, FILE_SIZE_TEXT, "%.0f bytes", bytes);
	else if (bytes < 1e6)
		(void)snprintf(buffer, FILE_SIZE_TEXT, "%.1f kB", bytes / 1e3);
	else if (bytes < 1e9)
		(void)snprintf(buffer, FILE_SIZE_TEXT, "%.1f MB", bytes / 1e6);
	else
		(void)snprintf(buffer, FILE_SIZE_TEXT, "%.2f GB", bytes / 1e9);
	return buffer;
}

/* what went wrong with `name` in the folder of `place`, by errno */
static int fail(const struct file_place *place, const char *name, int code, const char *deed,
	size_t size, struct error *err)
{
	int number = errno;
	char path[sizeof err->file], room[FILE_SIZE_TEXT];

	(void)snprintf(path, sizeof path, "%s/%s", place->folder, name);
	if (number == ENOSPC || number == EDQUOT || number == EFBIG)
		return error_at(err, code, path, 0, 0, "cannot %s: %s; %s are needed", deed,
			strerror(number), file_size_text((double)size, room));
	return error_at(err, code, path, 0, 0, "cannot %s: %s", deed, strerror(number));
}

/* write the new file under its temporary name */
static int write_new(int folder, const struct file_place *place, const char *name,
	const struct file_part *parts, size_t count, struct error *err)
{
	size_t size = 0;
	int fd = openat(folder, name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);

	for (size_t i = 0; i < count; i++)
		size += parts[i].size;
	if (fd < 0)
		return fail(place, name, EX_CANTCREAT, "create", size, err);
	for (size_t i = 0; i < count; i++)
		if (write_fully(fd, parts[i].bytes, parts[i].size) != 0) {
			fail(place, name, EX_IOERR, "write", size, err);
			goto failed;
		}
	if (place->durable && fsync(fd) != 0) {
		fail(place, name, EX_IOERR, "bring to disk", size, err);
		goto failed;
	}
	if (close(fd) == 0)
		return 0;
	fd = -1;
	fail(place, name, EX_IOERR, "close", size, err);
failed:
	if (fd >= 0)
		(void)close(fd);
	(void)unlinkat(folder, name, 0);
	return -1;
}

/* Give the present file its second name. A hard link under a third name and a rename, so that the
 * second name never is without a file. Where the file system has no hard links, nothing is kept. */
static int keep_present(int folder, const struct file_place *place, struct error *err)
{
	char third[256];

	(void)snprintf(third, sizeof third, "%s.tmp", place->previous);
	(void)unlinkat(folder, third, 0);
	if (linkat(folder, place->name, folder, third, 0) != 0) {
		if (errno == ENOENT || errno == EPERM || errno == EOPNOTSUPP)
			return 0;
		return fail(place, third, EX_IOERR, "link", 0, err);
	}
	if (renameat(folder, third, folder, place->previous) != 0) {
		fail(place, place->previous, EX_IOERR, "rename to", 0, err);
		(void)unlinkat(folder, third, 0);
		return -1;
	}
	/* rename does nothing between two names of one file, as after a crash at this very place */
	(void)unlinkat(folder, third, 0);
	return 0;
}

int file_replace(
	const struct file_place *place, const struct file_part *parts, size_t count, struct error *err)
{
	char name[256];
	int result = -1;
	int folder = open(place->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);

	if (folder < 0)
		return error_at(
			err, EX_CANTCREAT, place->folder, 0, 0, "cannot open this folder: %s", strerror(errno));
	(void)snprintf(name, sizeof name, "%s.tmp", place->name);
	if (write_new(folder, place, name, parts, count, err) != 0)
		goto done;
	if (place->previous && keep_present(folder, place, err) != 0)
		goto done;
	if (renameat(folder, name, folder, place->name) != 0) {
		fail(place, place->name, EX_IOERR, "rename to", 0, err);
		goto done;
	}
	/* some file systems cannot sync a folder and say EINVAL: nothing more can be done there */
	if (place->durable && fsync(folder) != 0 && errno != EINVAL) {
		fail(place, "", EX_IOERR, "bring this folder to disk", 0, err);
		goto done;
	}
	result = 0;
done:
	(void)close(folder);
	return result;
}

int file_append(const char *path, const char *text, struct error *err)
{
	int fd = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);

	if (fd < 0)
		return error_at(err, EX_CANTCREAT, path, 0, 0, "cannot be opened: %s", strerror(errno));
	if (write_fully(fd, text, strlen(text)) != 0) {
		error_at(err, EX_IOERR, path, 0, 0, "cannot be written: %s", strerror(errno));
		(void)close(fd);
		return -1;
	}
	if (close(fd) != 0)
		return error_at(err, EX_IOERR, path, 0, 0, "cannot be closed: %s", strerror(errno));
	return 0;
}

int file_path(struct text *out, const char *folder, const char *name, struct error *err)
{
	text_clean(out);
	text_addf(out, "%s/%s", folder, name);
	return out->failed ? error_memory(err, strlen(folder) + strlen(name) + 2) : 0;
}

bool file_exists(const char *path)
{
	return access(path, F_OK) == 0;
}

bool file_is_folder(const char *path)
{
	struct stat st;

	return stat(path, &st) == 0 && S_ISDIR(st.st_mode);
}
