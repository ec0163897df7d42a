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
	struct sigaction action = {.sa_handler = remember, .sa_flags = SA_RESTART}, before;

	(void)sigemptyset(&action.sa_mask);
	(void)sigaction(SIGINT, &action, NULL);
	(void)sigaction(SIGTERM, &action, NULL);
	(void)sigaction(SIGUSR1, &action, NULL);
	/* a closed terminal, unless nohup said that it does not matter */
	if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
		(void)sigaction(SIGHUP, &action, NULL);
	/* a file over the quota is then an error of write, with a message */
	(void)signal(SIGXFSZ, SIG_IGN);
}

int stop_signal(void)
{
	return asked;
}
