#include "run/loop.h"

#include <signal.h>
#include <string.h>

#include "base/stop.h"
#include "run/checkpoint.h"
#include "run/verify.h"

/* A step shorter than this part of the run would never get there, unless steps grow again. */
#define SHORTEST 1e-12

/* The next step. Only the end of the run shortens steps, and the last two share what is left, so
 * that none of them is tiny: `shared` says that this is one of them. */
static int choose(
	const struct attempt *attempt, struct recorder_step *step, bool *shared, struct error *err)
{
	double end = attempt->config->time.end, left = end - attempt->time;
	double dt = attempt->model->time_step(attempt->state);
	double shortest = attempt->model->taken ? 0 : SHORTEST * end;
	const char *remedy = attempt->model->remedy ? attempt->model->remedy(attempt->state) : NULL;

	if (!(dt >= shortest) || attempt->time + dt == attempt->time)
		return error_set(err, EX_FAILED, "the time step has become %g s: %s (end: %g s)%s%s", dt,
			dt > 0 ? "too short to get to the end" : "the state is not a flow", end,
			remedy ? "; " : "", remedy ? remedy : "");
	*step = (struct recorder_step){.from = attempt->time, .dt = dt, .to = attempt->time + dt};
	*shared = left < 2 * dt;
	if (left <= dt) {
		step->dt = left;
		step->to = end;
		step->last = true;
	} else if (*shared) {
		step->dt = left / 2;
		step->to = attempt->time + step->dt;
	}
	return 0;
}

/* The model took less than it was offered. */
static void shorten(struct recorder_step *step, double taken)
{
	if (taken >= step->dt)
		return;
	*step = (struct recorder_step){.from = step->from, .dt = taken, .to = step->from + taken};
}

static int advance(struct attempt *attempt, struct recorder_step *step, struct error *err)
{
	bool shared = false;

	TRY(choose(attempt, step, &shared, err));
	if (shared && !attempt->mark.values)
		TRY(checkpoint_mark(attempt, err));
	recorder_before(attempt->recorder, attempt->state, step);
	TRY(attempt->model->step(attempt->state, step->dt, err));
	if (attempt->model->taken)
		shorten(step, attempt->model->taken(attempt->state));
	attempt->step++;
	attempt->time = step->to;
	return recorder_after(attempt->recorder, attempt->state, step, err);
}

/* Checkpoints by wall clock and by steps. */
struct due {
	double wall;
	uint64_t step;
};

static void due_after(struct due *due, const struct attempt *attempt)
{
	due->wall = clock_wall() + attempt->config->checkpoint.every;
	due->step = attempt->step + (uint64_t)attempt->config->checkpoint.every_steps;
}

static bool is_due(const struct due *due, const struct attempt *attempt)
{
	return (attempt->config->checkpoint.every_steps > 0 && attempt->step >= due->step) ||
		   (attempt->config->checkpoint.every > 0 && clock_wall() >= due->wall);
}

static int stop(struct attempt *attempt, bool saved, struct error *err)
{
	const char *name = sigabbrev_np(stop_signal());

	if (!saved)
		TRY(checkpoint_write(attempt, RUN_UNFINISHED, err));
	return error_set(err, EX_INTERRUPTED,
		"stopped by SIG%s after step %llu at t = %g s; the same command goes on from there",
		name ? name : "?", (unsigned long long)attempt->step, attempt->time);
}

/* A step failed. The state before it is saved where the model still has it. */
static int fail(struct attempt *attempt, bool saved, struct error *err)
{
	struct error second = {0};

	if (err->code == EX_FAILED && attempt->model->keeps_state && !saved &&
		checkpoint_write(attempt, RUN_UNFINISHED, &second) != 0)
		attempt_log(attempt, "the state before the failed step is not saved: %s", second.text);
	return error_context(
		err, "step %llu at t = %g s", (unsigned long long)attempt->step + 1, attempt->time);
}

/* A run is complete if `verify` will find it good. */
static int finish(struct attempt *attempt, struct error *err)
{
	size_t count;
	const double *mass = recorder_series(attempt->recorder, "mass", &count);
	const double *left = recorder_series(attempt->recorder, "mass_outflow", &count);
	struct text breach = {0};
	bool kept = !mass || !left || verify_mass(mass, left, count, attempt->step, &breach);

	if (!kept)
		error_set(
			err, EX_FAILED, "%.*s", (int)strcspn(text_string(&breach), "\n"), text_string(&breach));
	text_clean(&breach);
	return kept ? checkpoint_write(attempt, RUN_COMPLETE, err) : -1;
}

int loop_run(struct attempt *attempt, struct error *err)
{
	struct recorder_step step = {0};
	bool saved = true; /* the present state is in run.h5 */
	struct due due;

	due_after(&due, attempt);
	while (!step.last) {
		if (stop_signal())
			return stop(attempt, saved, err);
		if (advance(attempt, &step, err) != 0)
			return fail(attempt, saved, err);
		saved = false;
		if (!step.last && is_due(&due, attempt)) {
			TRY(checkpoint_write(attempt, RUN_UNFINISHED, err));
			due_after(&due, attempt);
			saved = true;
		}
		attempt_tick(attempt);
	}
	return finish(attempt, err);
}
