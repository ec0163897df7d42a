/* What state a run is in, asked from outside. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/lock.h"
#include "run/run_file_parts.h"
#include "run/status.h"

const char *run_state_name(enum run_state state)
{
	static const char *const names[] = {
		"pending", "running", "interrupted", "complete", "failed", "damaged"};

	return names[state];
}

/* What one generation says, by its trailer or, for a copy without one, by its content. */
static int summarise(
	const char *folder, const char *name, struct run_summary *summary, struct error *err)
{
	struct text path = {0};
	struct run_file *file = NULL;
	struct error unpeeked = {0};
	int result;

	TRY(file_path(&path, folder, name, err));
	result = run_file_peek(text_string(&path), summary, &unpeeked);
	if (result != 0 && unpeeked.code != EX_DATAERR) {
		*err = unpeeked;
	} else if (result != 0) {
		result = run_file_open(text_string(&path), &file, NULL, err);
		if (result == 0)
			*summary = *run_file_summary(file);
		run_file_close(file);
	}
	text_clean(&path);
	return result;
}

/* What status.yaml would say, from the content of the run file. */
static void read_content(const char *folder, struct run_report *report)
{
	struct run_file *file = NULL;
	struct text warning = {0}, reason = {0};
	struct error ignored = {0};
	struct config config;
	double attempts;

	if (run_file_open_newest(folder, &file, &warning, &ignored) != 0)
		goto done;
	if (run_file_real(file, "attempts", &attempts, &ignored) == 0 && attempts < 1e9)
		report->attempts = (int)attempts;
	(void)run_file_real(file, "cpu_seconds", &report->cpu_seconds, &ignored);
	if (run_file_config(file, &config, &ignored) == 0)
		report->end = config.time.end;
	if (run_file_text(file, "reason", &reason, &ignored) == 0)
		(void)snprintf(report->reason, sizeof report->reason, "%s", text_string(&reason));
done:
	run_file_close(file);
	report->unknown |= ignored.code == EX_SOFTWARE;
	text_clean(&warning);
	text_clean(&reason);
}

/* State and simulated time by the run file, which wins over status.yaml. */
static void read_run_file(const char *folder, struct run_report *report)
{
	static const enum run_state states[] = {
		RUN_STATE_INTERRUPTED, RUN_STATE_COMPLETE, RUN_STATE_FAILED};
	struct error newest = {0}, previous = {0};
	struct run_summary summary;
	bool found = summarise(folder, RUN_FILE_NEWEST, &summary, &newest) == 0 ||
				 summarise(folder, RUN_FILE_PREVIOUS, &summary, &previous) == 0;

	report->unknown |= newest.code == EX_SOFTWARE || previous.code == EX_SOFTWARE;
	if (!found) {
		if (newest.code == EX_NOINPUT && previous.code == EX_NOINPUT)
			return;
		report->state = RUN_STATE_DAMAGED;
		report->blocked = newest.code == EX_IOERR || previous.code == EX_IOERR;
		(void)error_format(
			newest.code == EX_NOINPUT ? &previous : &newest, report->reason, sizeof report->reason);
		return;
	}
	report->state = states[summary.status];
	report->time = summary.time;
}

static bool is_running(const char *folder, struct run_report *report)
{
	struct error ignored = {0};
	struct text path = {0};
	bool known = file_path(&path, folder, "run.lock", &ignored) == 0;
	bool held = known && lock_is_held(text_string(&path));

	report->unknown |= !known;
	text_clean(&path);
	return held;
}

void run_report_read(const char *folder, struct run_report *report)
{
	struct run_report status = {.end = NAN, .wall_left = NAN};
	bool told = status_read(folder, &status);

	*report = status;
	report->state = RUN_STATE_PENDING;
	if (!told && file_exists(folder) && !file_is_folder(folder)) {
		report->state = RUN_STATE_DAMAGED;
		report->blocked = true;
		(void)snprintf(report->reason, sizeof report->reason, "%.900s is not a folder", folder);
		return;
	}
	if (is_running(folder, report)) {
		/* the run file is behind by up to a checkpoint; status.yaml by seconds */
		report->state = RUN_STATE_RUNNING;
		report->reason[0] = '\0';
		return;
	}
	report->wall_left = NAN;
	read_run_file(folder, report);
	if (!told || (report->state == RUN_STATE_FAILED && !*report->reason))
		read_content(folder, report);
	text_tame(report->reason);
}
