#include "base/stop.h"

#include <signal.h>
#include <unistd.h>

#include "talus/error.h"

/* A signal handler has nowhere else to leave its word. */
static volatile sig_atomic_t asked, interrupts;

static void remember(int number)
{
	if (number == SIGINT && ++interrupts > 1)
		_exit(EX_INTERRUPTED);
	asked = number;
}

void stop_install(void)
{
	struct sigaction action = {.sa_handler = remember, .sa_flags = SA_RESTART};

	(void)sigemptyset(&action.sa_mask);
	(void)sigaction(SIGINT, &action, NULL);
	(void)sigaction(SIGTERM, &action, NULL);
	(void)sigaction(SIGUSR1, &action, NULL);
}

int stop_signal(void)
{
	return asked;
}
