/* Dying or failing at the n-th call that changes the disk loses nothing. The calls are replaced by
 * defining them here, which the linker prefers to those of the C library. */
#include "../run/logistic.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>

#include "base/file.h"

enum deed { DIE, LOSE_POWER, FAIL, SHORT_WRITE, INTERRUPT };

/* Calls to come before it happens; 0: it does not. */
static long countdown;
static enum deed deed;
static int number; /* errno of FAIL */

/* What has been written and not brought to disk: descriptors of our own to its files. */
static int unsafe[64];
static size_t unsafe_count;

static bool same_file(int a, int b)
{
	struct stat first, second;

	return fstat(a, &first) == 0 && fstat(b, &second) == 0 && first.st_dev == second.st_dev &&
		   first.st_ino == second.st_ino;
}

static void forget(int fd)
{
	for (size_t i = 0; i < unsafe_count; i++)
		if (same_file(unsafe[i], fd)) {
			(void)close(unsafe[i]);
			unsafe[i--] = unsafe[--unsafe_count];
		}
}

/* A cut of the power, at its worst: every name is on disk, and nothing of what was not synced. */
static void die(void)
{
	for (size_t i = 0; deed == LOSE_POWER && i < unsafe_count; i++)
		(void)syscall(SYS_ftruncate, unsafe[i], 0);
	(void)raise(SIGKILL);
}

static bool happens(void)
{
	return countdown && --countdown == 0;
}

static bool fails(void)
{
	if (!happens())
		return false;
	if (deed == DIE || deed == LOSE_POWER)
		die();
	errno = deed == INTERRUPT ? EINTR : number;
	return deed == FAIL;
}

ssize_t write(int fd, const void *buf, size_t n)
{
	struct stat st;

	if (countdown && deed == LOSE_POWER && fstat(fd, &st) == 0 && S_ISREG(st.st_mode)) {
		forget(fd);
		assert_true(unsafe_count < sizeof unsafe / sizeof *unsafe);
		unsafe[unsafe_count++] = fcntl(fd, F_DUPFD_CLOEXEC, 100);
	}
	if (happens()) {
		/* half of it reaches the disk first */
		if (deed == DIE || deed == LOSE_POWER) {
			(void)syscall(SYS_write, fd, buf, n / 2);
			die();
		}
		if (deed == SHORT_WRITE && n > 1)
			return syscall(SYS_write, fd, buf, n / 2);
		errno = deed == INTERRUPT ? EINTR : number;
		if (deed != SHORT_WRITE)
			return -1;
	}
	return syscall(SYS_write, fd, buf, n);
}

/* What a process has written outlives it, so that nothing has to reach the disk here. */
int fsync(int fd)
{
	if (fails())
		return -1;
	forget(fd);
	return 0;
}

/* Only the creation of files counts: to read fails in other ways. */
int openat(int fd, const char *file, int oflag, ...)
{
	if ((oflag & O_CREAT) && fails())
		return -1;
	return (int)syscall(SYS_openat, fd, file, oflag, 0666);
}

int linkat(int fromfd, const char *from, int tofd, const char *to, int flags)
{
	return fails() ? -1 : (int)syscall(SYS_linkat, fromfd, from, tofd, to, flags);
}

int renameat(int oldfd, const char *old, int newfd, const char *new)
{
	return fails() ? -1 : (int)syscall(SYS_renameat, oldfd, old, newfd, new);
}

int unlinkat(int fd, const char *name, int flag)
{
	return fails() ? -1 : (int)syscall(SYS_unlinkat, fd, name, flag);
}

static const char settings[] = "checkpoint.every_steps=15;time.end=0.5";

/* At least one generation is good, and the run goes on from it to the same bits. */
static void assert_nothing_lost(const struct config *config, const char *name)
{
	char path[256];
	struct run_report report;
	unsigned char *log = NULL;
	struct error err = {0};
	size_t size;

	run_report_read(in_folder(name), &report);
	assert_int_not_equal(report.state, RUN_STATE_DAMAGED);
	/* from the first checkpoint on, which is told in the log, there always is one */
	(void)snprintf(path, sizeof path, "%s/run.log", in_folder(name));
	if (file_read(path, &log, &size, &err) == 0 && strstr((const char *)log, "started at step"))
		assert_int_not_equal(report.state, RUN_STATE_PENDING);
	free(log);
	assert_int_not_equal(report.state, RUN_STATE_RUNNING);
	must_execute(config, name);
	assert_same_bits("straight", name);
	assert_int_equal(nftw(in_folder(name), remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}

/* How many of these calls a whole run makes. */
static long count_calls(const struct config *config, const char *name)
{
	const long many = 1000000;
	long calls;

	countdown = many;
	must_execute(config, name);
	calls = many - countdown;
	countdown = 0;
	return calls;
}

/* Let it happen at the n-th call, for every n; returns how many n made a difference. `expected_code`
 * may also be one less: what cannot be created. */
static int at_every_call(enum deed what, int expected_code)
{
	struct config config = logistic_config(settings);
	long calls = count_calls(&config, "straight");
	int count = 0;

	deed = what;
	for (countdown = 1; countdown <= calls; countdown++) {
		long n = countdown;
		int code = execute_in_child(&config, "a", false);

		if (code != 0) {
			assert_in_range(expected_code - code, 0, expected_code == EX_IOERR);
			count++;
		}
		countdown = 0;
		assert_nothing_lost(&config, "a");
		countdown = n;
	}
	countdown = 0;
	return count;
}

static void dying_at_any_call_loses_nothing(void **state)
{
	(void)state;
	/* five checkpoints of eight calls, and what status, log and config write */
	assert_in_range(at_every_call(DIE, -SIGKILL), 30, 100);
}

static void a_power_cut_at_any_call_loses_nothing(void **state)
{
	(void)state;
	assert_in_range(at_every_call(LOSE_POWER, -SIGKILL), 30, 100);
}

static void a_full_disk_at_any_call_is_73_or_74_and_loses_nothing(void **state)
{
	/* full, broken, gone; others differ by their message alone */
	static const int numbers[] = {ENOSPC, EIO, ENOENT};

	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
		number = numbers[i];
		assert_in_range(at_every_call(FAIL, EX_IOERR), 10, 60);
		assert_int_equal(remove_folder(state), 0);
		assert_int_equal(make_folder(state), 0);
	}
}

static void short_and_interrupted_writes_do_not_matter(void **state)
{
	(void)state;
	assert_int_equal(at_every_call(SHORT_WRITE, 0), 0);
	assert_int_equal(remove_folder(state), 0);
	assert_int_equal(make_folder(state), 0);
	assert_int_equal(at_every_call(INTERRUPT, 0), 0);
}

static void a_full_disk_says_how_much_room_is_needed(void **state)
{
	const struct file_part part = {"0123456789", 10};
	const struct file_place place = {.folder = in_folder("."), .name = "file", .durable = true};
	struct error err = {0};

	(void)state;
	deed = FAIL;
	for (long n = 1; n <= 5; n++) {
		err = (struct error){0};
		number = n % 2 ? ENOSPC : EDQUOT;
		countdown = n; /* create, write, bring to disk, rename, bring the folder to disk */
		assert_int_equal(file_replace(&place, &part, 1, &err), -1);
		assert_int_equal(err.code, n == 1 ? EX_CANTCREAT : EX_IOERR);
		assert_non_null(strstr(err.text, "; 10 bytes are needed"));
		assert_false(file_exists(in_folder("file.tmp")));
	}
}

/* The clock for people, set back by this many seconds. */
static time_t set_back;

time_t time(time_t *timer)
{
	struct timespec now = {0};

	(void)syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
	now.tv_sec -= set_back;
	if (timer)
		*timer = now.tv_sec;
	return now.tv_sec;
}

int clock_gettime(clockid_t clock_id, struct timespec *tp)
{
	int result = (int)syscall(SYS_clock_gettime, clock_id, tp);

	if (clock_id == CLOCK_REALTIME)
		tp->tv_sec -= set_back;
	return result;
}

static void set_clock_back(int unused)
{
	(void)unused;
	set_back = 1000000;
}

static void a_clock_set_back_changes_nothing(void **state)
{
	struct config config = logistic_config("checkpoint.every=1e-9;time.end=0.5");
	const long many = 1000000;
	long steady, back;

	(void)state;
	(void)signal(SIGUSR2, set_clock_back);
	deed = INTERRUPT;
	countdown = many;
	must_execute(&config, "straight");
	steady = many - countdown;
	logistic.number = SIGUSR2;
	logistic.raise_at[0] = 3;
	countdown = many;
	must_execute(&config, "a");
	back = many - countdown;
	countdown = 0;
	assert_int_equal(set_back, 1000000);
	/* checkpoints come as before: the same calls, but for status.yaml, which goes by the second */
	assert_in_range(back, steady - 12, steady + 12);
	assert_same_bits("straight", "a");
	set_back = 0;
}

static void two_failures_in_a_row_lose_nothing(void **state)
{
	struct config config = logistic_config(settings);

	(void)state;
	must_execute(&config, "straight");
	deed = DIE;
	for (long n = 8; n < 40; n++) {
		countdown = n;
		(void)execute_in_child(&config, "a", false);
		countdown = n - 3;
		(void)execute_in_child(&config, "a", false);
		countdown = 0;
		assert_nothing_lost(&config, "a");
	}
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
	const struct CMUnitTest tests[] = {
		TEST(dying_at_any_call_loses_nothing),
		TEST(a_power_cut_at_any_call_loses_nothing),
		TEST(a_full_disk_at_any_call_is_73_or_74_and_loses_nothing),
		TEST(short_and_interrupted_writes_do_not_matter),
		TEST(a_full_disk_says_how_much_room_is_needed),
		TEST(two_failures_in_a_row_lose_nothing),
		TEST(a_clock_set_back_changes_nothing),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
