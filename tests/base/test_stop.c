/* Signals that ask to stop. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/stop.h"
#include "talus/error.h"

/* Exit code of a process that raises both signals: 10 when it lives on and knows the second. */
static int after(int first, int second)
{
	int status;
	pid_t pid = fork();

	if (pid == 0) {
		stop_install();
		if (stop_signal() != 0)
			_exit(1);
		(void)raise(first);
		if (stop_signal() != first)
			_exit(2);
		(void)raise(second);
		_exit(stop_signal() == second ? 10 : 3);
	}
	assert_int_equal(waitpid(pid, &status, 0), pid);
	return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

static void a_signal_is_remembered(void **state)
{
	(void)state;
	assert_int_equal(after(SIGTERM, SIGTERM), 10);
	assert_int_equal(after(SIGUSR1, SIGTERM), 10);
	assert_int_equal(after(SIGTERM, SIGINT), 10);
	assert_int_equal(after(SIGTERM, SIGHUP), 10); /* a closed terminal */
}

static void a_second_interrupt_leaves_at_once(void **state)
{
	(void)state;
	assert_int_equal(after(SIGINT, SIGINT), EX_INTERRUPTED);
}

static void a_hangup_that_was_ignored_stays_ignored(void **state)
{
	(void)state;
	(void)signal(SIGHUP, SIG_IGN); /* as nohup does */
	assert_int_equal(after(SIGTERM, SIGHUP), 3);
	(void)signal(SIGHUP, SIG_DFL);
}

static void a_file_over_the_quota_is_no_signal(void **state)
{
	(void)state;
	assert_int_equal(after(SIGTERM, SIGXFSZ), 3);
}

static void other_signals_keep_their_meaning(void **state)
{
	(void)state;
	assert_int_equal(after(SIGTERM, SIGALRM), -SIGALRM);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_signal_is_remembered),
		cmocka_unit_test(a_second_interrupt_leaves_at_once),
		cmocka_unit_test(a_hangup_that_was_ignored_stays_ignored),
		cmocka_unit_test(a_file_over_the_quota_is_no_signal),
		cmocka_unit_test(other_signals_keep_their_meaning),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
