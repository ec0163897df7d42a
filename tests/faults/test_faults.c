/* Dying or failing at the n-th call that changes the disk loses nothing. The calls are replaced by
 * defining them here, which the linker prefers to those of the C library. */
#include "../run/logistic.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include "base/file.h"

enum deed { DIE, NO_SPACE, SHORT_WRITE, INTERRUPT };

/* Calls to come before it happens; 0: it does not. */
static long countdown;
static enum deed deed;

static bool happens(void)
{
	return countdown && --countdown == 0;
}

static bool fails(void)
{
	if (!happens())
		return false;
	if (deed == DIE)
		(void)raise(SIGKILL);
	errno = deed == INTERRUPT ? EINTR : ENOSPC;
	return deed == NO_SPACE;
}

ssize_t write(int fd, const void *buf, size_t n)
{
	if (happens()) {
		/* half of it reaches the disk first */
		if (deed == DIE) {
			(void)syscall(SYS_write, fd, buf, n / 2);
			(void)raise(SIGKILL);
		}
		if (deed == SHORT_WRITE && n > 1)
			return syscall(SYS_write, fd, buf, n / 2);
		errno = deed == INTERRUPT ? EINTR : ENOSPC;
		if (deed != SHORT_WRITE)
			return -1;
	}
	return syscall(SYS_write, fd, buf, n);
}

/* What a process has written outlives it, so that nothing has to reach the disk here. */
int fsync(int fd)
{
	(void)fd;
	return fails() ? -1 : 0;
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
	struct run_report report;

	run_report_read(in_folder(name), &report);
	assert_int_not_equal(report.state, RUN_STATE_DAMAGED);
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

/* Let it happen at the n-th call, for every n; returns how many n made a difference. */
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
			assert_int_equal(code, expected_code);
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

static void a_full_disk_at_any_call_is_74_and_loses_nothing(void **state)
{
	(void)state;
	assert_in_range(at_every_call(NO_SPACE, EX_IOERR), 15, 60);
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
	deed = NO_SPACE;
	countdown = 1;
	assert_int_equal(file_replace(&place, &part, 1, &err), -1);
	assert_int_equal(err.code, EX_IOERR);
	assert_non_null(strstr(err.text, "No space left on device; 10 bytes are needed"));
	assert_false(file_exists(in_folder("file.tmp")));
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
		TEST(a_full_disk_at_any_call_is_74_and_loses_nothing),
		TEST(short_and_interrupted_writes_do_not_matter),
		TEST(a_full_disk_says_how_much_room_is_needed),
		TEST(two_failures_in_a_row_lose_nothing),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
