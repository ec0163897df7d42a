#include "base/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/build.h"
#include "talus/text.h"

/* Open-file-description locks belong to the descriptor: a stray close of another descriptor of the
 * same file, as with classic POSIX locks, does not drop them. */
static struct flock whole_file(void)
{
	return (struct flock){.l_type = F_WRLCK, .l_whence = SEEK_SET};
}

int lock_take(struct lock *lock, const char *path, struct error *err)
{
	struct flock range = whole_file();
	char holder[LOCK_HOLDER_SIZE], host[BUILD_HOST_SIZE];
	int length;

	lock->fd = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
	if (lock->fd < 0)
		return error_at(err, EX_CANTCREAT, path, 0, 0, "cannot be opened: %s", strerror(errno));
	if (fcntl(lock->fd, F_OFD_SETLK, &range) != 0) {
		int number = errno;

		lock_release(lock);
		if (number != EAGAIN && number != EACCES)
			return error_at(err, EX_IOERR, path, 0, 0, "cannot be locked: %s", strerror(number));
		(void)lock_holder(path, holder);
		return error_at(err, EX_INTERRUPTED, path, 0, 0, "is locked by %s",
			*holder ? holder : "another process");
	}
	/* for people; the lock holds without it */
	length =
		snprintf(holder, sizeof holder, "process %ld on %s\n", (long)getpid(), build_host(host));
	if (ftruncate(lock->fd, 0) != 0 || pwrite(lock->fd, holder, (size_t)length, 0) != length)
		return 0;
	return 0;
}

void lock_release(struct lock *lock)
{
	if (lock->fd >= 0)
		(void)close(lock->fd);
	lock->fd = -1;
}

bool lock_is_named(const struct lock *lock, const char *path)
{
	struct stat held, named;

	return fstat(lock->fd, &held) == 0 && lstat(path, &named) == 0 && held.st_dev == named.st_dev &&
		   held.st_ino == named.st_ino;
}

bool lock_is_held(const char *path)
{
	struct flock range = whole_file();
	int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
	bool held;

	if (fd < 0)
		return false;
	held = fcntl(fd, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
	(void)close(fd);
	return held;
}

char *lock_holder(const char *path, char buffer[LOCK_HOLDER_SIZE])
{
	int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
	char text[LOCK_HOLDER_SIZE];
	ssize_t n = fd < 0 ? -1 : pread(fd, text, sizeof text - 1, 0);

	text[n > 0 ? n : 0] = '\0';
	text[strcspn(text, "\n")] = '\0';
	(void)text_excerpt(text, buffer, LOCK_HOLDER_SIZE);
	if (fd >= 0)
		(void)close(fd);
	return buffer;
}
