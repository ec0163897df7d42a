#include "base/crash.h"

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "talus/error.h"

/* The sanitizers tell more about a fault than we do. */
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define SANITIZED true
#else
#define SANITIZED false
#endif

enum { STACK = 1 << 16 };

static volatile sig_atomic_t ending;

/* Only what is safe in a handler. */
static void say(const char *text)
{
	if (write(STDERR_FILENO, text, strlen(text)) < 0)
		return;
}

static void tell(int number)
{
	const char *name = sigabbrev_np(number);

	say("talus: ended by a fault inside Talus or a library (SIG");
	say(name ? name : "?");
	say("), as HDF5 has when memory runs out; the files on disk are whole\n");
	_exit(EX_SOFTWARE);
}

static void guard(void)
{
	if (ending)
		return;
	say("talus: HDF5 gave up, as it does when memory runs out; the files on disk are whole\n");
	_exit(EX_SOFTWARE);
}

void crash_install(void)
{
	static const int numbers[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};
	static char room[STACK]; /* the fault may be that there is no stack left */
	const stack_t stack = {.ss_sp = room, .ss_size = sizeof room};
	struct sigaction action = {.sa_handler = tell, .sa_flags = SA_ONSTACK};

	(void)atexit(guard);
	(void)sigemptyset(&action.sa_mask);
	if (SANITIZED || sigaltstack(&stack, NULL) != 0)
		return;
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
		(void)sigaction(numbers[i], &action, NULL);
}

_Noreturn void crash_exit(int code)
{
	ending = true;
	exit(code);
}
