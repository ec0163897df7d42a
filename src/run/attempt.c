#include "run/attempt.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/clock.h"
#include "base/file.h"
#include "run/status.h"

double attempt_cpu(const struct attempt *attempt)
{
	return attempt->cpu_before + clock_cpu() - attempt->cpu_begin;
}

/* Most of a collapse is computed in its first tenth, where the rate alone is up to ten times too slow: the
 * expected cost of the whole leads there, and the rate of late takes over with the share that is done. */
double attempt_wall_left(const struct attempt *attempt)
{
	double end = attempt->config->time.end, left = end - attempt->time, share = attempt->time / end;
	double expected = attempt->model->cost ? attempt->model->cost(attempt->config) : NAN;
	double by_rate = attempt->time_sum > 0 ? left * attempt->wall_sum / attempt->time_sum : NAN;
	double spent = attempt_cpu(attempt),
		   by_cost = fmax(expected - spent, 0.3 * spent * (1 - share));

	if (isnan(expected) || isnan(by_rate))
		return isnan(expected) ? by_rate : by_cost;
	return pow(by_cost, 1 - share) * pow(by_rate, share);
}

/* The rate of late: what is older than a quarter of the attempt hardly counts. */
static void watch_rate(struct attempt *attempt, double now)
{
	double passed = now - attempt->rate_wall, kept;

	if (attempt->rate_wall <= 0)
		passed = 0;
	kept = attempt->wall_sum > 0 ? exp(-4 * passed / attempt->wall_sum) : 1;
	attempt->wall_sum = kept * attempt->wall_sum + passed;
	if (attempt->rate_wall > 0)
		attempt->time_sum = kept * attempt->time_sum + attempt->time - attempt->rate_time;
	attempt->rate_wall = now;
	attempt->rate_time = attempt->time;
}

void attempt_say(const struct attempt *attempt, enum run_voice voice, const char *format, ...)
{
	const struct run_options *options = attempt->options;
	char line[2048];
	va_list args;

	if (!options->say || (voice == RUN_VOICE_RESULT && options->quiet) ||
		(voice == RUN_VOICE_PROGRESS && !options->progress))
		return;
	va_start(args, format);
	(void)vsnprintf(line, sizeof line, format, args);
	va_end(args);
	options->say(voice, line);
}

void attempt_log(const struct attempt *attempt, const char *format, ...)
{
	struct text path = {0}, line = {0};
	struct error ignored = {0};
	char stamp[CLOCK_STAMP_SIZE], message[2048];
	va_list args;

	va_start(args, format);
	(void)vsnprintf(message, sizeof message, format, args);
	va_end(args);
	text_addf(&line, "%s attempt %d: %s\n", clock_stamp(stamp), attempt->number, message);
	if (file_path(&path, attempt->folder, "run.log", &ignored) == 0 && !line.failed)
		(void)file_append(text_string(&path), text_string(&line), &ignored);
	text_clean(&path);
	text_clean(&line);
}

static void progress(const struct attempt *attempt)
{
	double end = attempt->config->time.end, left = attempt_wall_left(attempt);
	char span[CLOCK_SPAN_SIZE];

	attempt_say(attempt, RUN_VOICE_PROGRESS, "%s: %5.1f %%, t = %.4g of %.4g s, step %llu, %s left",
		attempt->folder, 100 * attempt->time / end, attempt->time, end,
		(unsigned long long)attempt->step, clock_span(left, span));
}

void attempt_tick(struct attempt *attempt)
{
	double now = clock_wall();

	watch_rate(attempt, now);
	if (now >= attempt->progress_due) {
		progress(attempt);
		attempt->progress_due = now + 0.2;
	}
	if (now >= attempt->status_due) {
		status_write(attempt, RUN_STATE_RUNNING, "");
		attempt->status_due = now + 2;
	}
}
