#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"

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

/* open a regular file for reading and tell its size; a pipe is refused, not waited for */
static int open_to_read(const char *path, size_t *size, struct error *err)
{
	struct stat st;
	int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);

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

/* what is there within the time; 0 at the end, -1 with errno */
static ssize_t read_in_time(int fd, char *buffer, size_t size, double deadline)
{
	struct pollfd wait = {.fd = fd, .events = POLLIN};

	for (;;) {
		ssize_t n = read(fd, buffer, size);
		double left = deadline - clock_wall();

		if (n >= 0 || (errno != EINTR && errno != EAGAIN))
			return n;
		if (left <= 0 || poll(&wait, 1, (int)(1e3 * left) + 1) == 0) {
			errno = ETIMEDOUT;
			return -1;
		}
	}
}

ssize_t file_read_text(const char *path, char *buffer, size_t size)
{
	int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
	double deadline = clock_wall() + FILE_PATIENCE;
	ssize_t done = 0, n = 1;
	int number;

	if (fd < 0)
		return -1;
	while (n > 0 && (size_t)done < size) {
		n = read_in_time(fd, buffer + done, size - (size_t)done, deadline);
		done += n > 0 ? n : 0;
	}
	if (n < 0)
		done = -1;
	number = errno;
	(void)close(fd);
	errno = number;
	return done;
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

/* A file on its way to its place. */
struct replacement {
	const struct file_place *place;
	int folder;      /* descriptor */
	size_t size;     /* of the new file */
	char fresh[256]; /* its name until it is whole */
	struct error *err;
};

/* what went wrong with `name` in the folder, by errno */
static int fail(const struct replacement *r, const char *name, int code, const char *deed)
{
	int number = errno;
	char path[sizeof r->err->file], room[FILE_SIZE_TEXT];

	(void)snprintf(path, sizeof path, "%s/%s", r->place->folder, name);
	if (number == ENOSPC || number == EDQUOT || number == EFBIG)
		return error_at(r->err, code, path, 0, 0, "cannot %s: %s; %s are needed", deed,
			strerror(number), file_size_text((double)r->size, room));
	return error_at(r->err, code, path, 0, 0, "cannot %s: %s", deed, strerror(number));
}

/* A file of our own under the temporary name, whatever lies there: what a crash left, or a link that
 * would let us write to another place. */
static int create(const struct replacement *r)
{
	const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
	int fd = openat(r->folder, r->fresh, flags, 0666);

	if (fd < 0 && errno == EEXIST && unlinkat(r->folder, r->fresh, 0) == 0)
		fd = openat(r->folder, r->fresh, flags, 0666);
	return fd;
}

static int write_new(const struct replacement *r, const struct file_part *parts, size_t count)
{
	int fd = create(r);

	if (fd < 0)
		return fail(r, r->fresh, EX_CANTCREAT, "create");
	for (size_t i = 0; i < count; i++)
		if (write_fully(fd, parts[i].bytes, parts[i].size) != 0) {
			fail(r, r->fresh, EX_IOERR, "write");
			(void)close(fd);
			return -1;
		}
	if (r->place->durable && fsync(fd) != 0) {
		fail(r, r->fresh, EX_IOERR, "bring to disk");
		(void)close(fd);
		return -1;
	}
	return close(fd) == 0 ? 0 : fail(r, r->fresh, EX_IOERR, "close");
}

/* Give the present file its second name. A hard link under a third name and a rename, so that the
 * second name never is without a file. Where the file system has no hard links, nothing is kept. */
static int keep_present(const struct replacement *r)
{
	const struct file_place *place = r->place;
	char third[256];

	(void)snprintf(third, sizeof third, "%s.tmp", place->previous);
	(void)unlinkat(r->folder, third, 0);
	if (linkat(r->folder, place->name, r->folder, third, 0) != 0) {
		if (errno == ENOENT || errno == EPERM || errno == EOPNOTSUPP)
			return 0;
		return fail(r, third, EX_IOERR, "link");
	}
	if (renameat(r->folder, third, r->folder, place->previous) != 0) {
		fail(r, place->previous, EX_IOERR, "rename to");
		(void)unlinkat(r->folder, third, 0);
		return -1;
	}
	/* rename does nothing between two names of one file, as after a crash at this very place */
	(void)unlinkat(r->folder, third, 0);
	return 0;
}

int file_replace(
	const struct file_place *place, const struct file_part *parts, size_t count, struct error *err)
{
	struct replacement r = {.place = place, .err = err};
	int result = -1;

	r.folder = open(place->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
	if (r.folder < 0)
		return error_at(
			err, EX_CANTCREAT, place->folder, 0, 0, "cannot open this folder: %s", strerror(errno));
	for (size_t i = 0; i < count; i++)
		r.size += parts[i].size;
	(void)snprintf(r.fresh, sizeof r.fresh, "%s.tmp", place->name);
	if (write_new(&r, parts, count) != 0 || (place->previous && keep_present(&r) != 0)) {
		(void)unlinkat(r.folder, r.fresh, 0); /* the room may be needed */
		goto done;
	}
	if (renameat(r.folder, r.fresh, r.folder, place->name) != 0) {
		fail(&r, place->name, EX_IOERR, "rename to");
		(void)unlinkat(r.folder, r.fresh, 0);
		goto done;
	}
	/* some file systems cannot sync a folder and say EINVAL: nothing more can be done there */
	if (place->durable && fsync(r.folder) != 0 && errno != EINVAL) {
		fail(&r, "", EX_IOERR, "bring this folder to disk");
		goto done;
	}
	result = 0;
done:
	(void)close(r.folder);
	return result;
}

int file_rename(const char *folder, const char *name, const char *other, struct error *err)
{
	struct text from = {0}, to = {0};
	int result = -1;

	if (file_path(&from, folder, name, err) != 0 || file_path(&to, folder, other, err) != 0)
		goto done;
	result = rename(from.data, to.data) != 0 && errno != ENOENT
				 ? error_at(err, EX_IOERR, from.data, 0, 0, "cannot be renamed to %s: %s", other,
					   strerror(errno))
				 : 0;
done:
	text_clean(&from);
	text_clean(&to);
	return result;
}

int file_open_log(const char *path)
{
	return open(path, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
}

int file_append(const char *path, const char *text, struct error *err)
{
	int fd = file_open_log(path);

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

bool file_has_room(const char *folder, size_t size, struct error *err)
{
	struct text path = {0};
	char room[FILE_SIZE_TEXT];
	int fd, number = 0;

	if (file_path(&path, folder, ".room-XXXXXX", err) != 0)
		return false;
	fd = mkostemp(path.data, O_CLOEXEC);
	if (fd < 0) {
		error_at(err, EX_CANTCREAT, folder, 0, 0, "cannot hold another file: %s", strerror(errno));
	} else {
		number = posix_fallocate(fd, 0, (off_t)size);
		(void)close(fd);
		(void)unlink(path.data);
	}
	if (number)
		error_at(err, EX_IOERR, folder, 0, 0, "cannot hold %s more: %s",
			file_size_text((double)size, room), strerror(number));
	text_clean(&path);
	return fd >= 0 && !number;
}

bool file_size(const char *path, size_t *size)
{
	struct stat st;
	bool there = stat(path, &st) == 0 && S_ISREG(st.st_mode);

	if (there)
		*size = (size_t)st.st_size;
	return there;
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

bool file_stem(const char *path, struct text *out)
{
	const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
	const char *dot = strrchr(name, '.');
	size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);

	text_add_bytes(out, name, length);
	return length > 2 || strncmp("..", name, length) != 0;
}
