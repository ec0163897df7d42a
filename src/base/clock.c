#include "base/clock.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

static double seconds(clockid_t id)
{
	struct timespec now = {0};

	(void)clock_gettime(id, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double clock_wall(void)
{
	return seconds(CLOCK_MONOTONIC);
}

double clock_cpu(void)
{
	return seconds(CLOCK_PROCESS_CPUTIME_ID);
}

char *clock_stamp(char buffer[CLOCK_STAMP_SIZE])
{
	time_t now = time(NULL);
	struct tm utc = {0};

	(void)gmtime_r(&now, &utc);
	if (!strftime(buffer, CLOCK_STAMP_SIZE, "%Y-%m-%dT%H:%M:%SZ", &utc))
		buffer[0] = '\0';
	return buffer;
}

char *clock_span(double span, char buffer[CLOCK_SPAN_SIZE])
{
	double minutes = floor(span / 60);

	if (!(span < 1e9))
		(void)snprintf(buffer, CLOCK_SPAN_SIZE, "unknown");
	else if (span < 60)
		(void)snprintf(buffer, CLOCK_SPAN_SIZE, span < 10 ? "%.1f s" : "%.0f s", span);
	else if (minutes < 60)
		(void)snprintf(
			buffer, CLOCK_SPAN_SIZE, "%.0f min %02.0f s", minutes, floor(span - 60 * minutes));
	else
		(void)snprintf(
			buffer, CLOCK_SPAN_SIZE, "%.0f h %02.0f min", floor(minutes / 60), fmod(minutes, 60));
	return buffer;
}
