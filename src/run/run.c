#include "talus/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/lock.h"
#include "run/checkpoint.h"
#include "run/life.h"
#include "run/loop.h"
#include "run/run_file_parts.h"
#include "run/status.h"

/* What the run in the folder asks for. */
enum course { START, RESUME, NOTHING };

/* Refuse a file that this config and this program would not have made. */
static int compare_config(const struct attempt *attempt, struct run_file *file, struct error *err)
{
	struct text stored = {0}, keys = {0}, list = {0};
	struct error unreadable = {0};
	struct config config;
	char *rest;

	if (!strcmp(run_file_summary(file)->config_hash, attempt->config_hash))
		return 0;
	if (run_file_text(file, "config", &stored, err) != 0)
		goto done;
	if (config_parse(&config, text_string(&stored), stored.length, run_file_path(file), NULL, 0,
			&unreadable) == 0)
		config_differences(&config, attempt->config, &keys);
	if (unreadable.code == EX_SOFTWARE) {
		*err = unreadable;
		goto done;
	}
	for (char *key = keys.data ? strtok_r(keys.data, "\n", &rest) : NULL; key;
		 key = strtok_r(NULL, "\n", &rest))
		text_addf(&list, list.length ? ", %s" : "%s", key);
	error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
		"was made from another config (%s); name another folder with -o, or remove this one",
		list.length ? text_string(&list) : "one that this version cannot read");
done:
	text_clean(&stored);
	text_clean(&keys);
	text_clean(&list);
	return -1;
}

static int compare_numerics(const struct attempt *attempt, struct run_file *file, struct error *err)
{
	double version;

	TRY(run_file_real(file, "numerics_version", &version, err));
	if (version == attempt->model->numerics_version)
		return 0;
	return error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
		"was made with numerics_version %g, and this program has %d; name another folder with -o, "
		"or remove this one",
		version, attempt->model->numerics_version);
}

/* Take from the file what an attempt carries on whatever its course: the run's past. */
static int read_past(struct attempt *attempt, struct run_file *file, struct error *err)
{
	struct text created = {0};
	double attempts;
	int result = -1;

	if (run_file_real(file, "attempts", &attempts, err) != 0 ||
		run_file_real(file, "cpu_seconds", &attempt->cpu_before, err) != 0 ||
		run_file_text(file, "created", &created, err) != 0)
		goto done;
	if (attempts >= attempt->number)
		attempt->number = (int)fmin(attempts, 1e9) + 1;
	(void)snprintf(attempt->created, sizeof attempt->created, "%s", text_string(&created));
	attempt->keep_newest = run_file_is_newest(file);
	result = 0;
done:
	text_clean(&created);
	return result;
}

static int failed_before(const struct attempt *attempt, struct run_file *file, struct error *err)
{
	struct text reason = {0};
	struct error unknown = {0};

	(void)run_file_text(file, "reason", &reason, &unknown);
	error_at(err, EX_FAILED, attempt->folder, 0, 0, "failed before: %s; --retry starts it anew",
		text_string(&reason));
	text_clean(&reason);
	return -1;
}

/* No generation is good. Only --retry starts anew, and what is damaged is kept under other names. */
static int leave_damaged(struct attempt *attempt, enum course *course, struct error *err)
{
	static const char *const names[][2] = {
		{RUN_FILE_NEWEST, "run.damaged.h5"}, {RUN_FILE_PREVIOUS, "run.previous.damaged.h5"}};
	size_t used = strlen(err->text);

	if (!attempt->options->retry) {
		(void)snprintf(err->text + used, sizeof err->text - used,
			"; --retry starts it anew and keeps these files under other names");
		return -1;
	}
	*err = (struct error){0};
	for (size_t i = 0; i < sizeof names / sizeof *names; i++)
		TRY(file_rename(attempt->folder, names[i][0], names[i][1], err));
	*course = START;
	return 0;
}

/* Look at what lies in the folder. With RESUME and NOTHING `*file` is open. */
static int find_course(
	struct attempt *attempt, struct run_file **file, enum course *course, struct error *err)
{
	struct text warning = {0};
	enum run_status status;
	int result = run_file_open_newest(attempt->folder, file, &warning, err);

	if (result == 0 && warning.length) {
		attempt_say(attempt, RUN_VOICE_WARNING, "%s", text_string(&warning));
		attempt_log(attempt, "warning: %s", text_string(&warning));
	}
	text_clean(&warning);
	if (result != 0 && err->code == EX_NOINPUT) {
		*err = (struct error){0};
		*course = START;
		return 0;
	}
	if (result != 0 && err->code == EX_DATAERR)
		return leave_damaged(attempt, course, err);
	if (result != 0)
		return -1;
	TRY(read_past(attempt, *file, err));
	status = run_file_summary(*file)->status;
	if (status == RUN_FAILED && attempt->options->retry) {
		*course = START;
		attempt->cpu_before = 0;
		return 0;
	}
	TRY(compare_config(attempt, *file, err));
	TRY(compare_numerics(attempt, *file, err));
	if (status == RUN_FAILED)
		return failed_before(attempt, *file, err);
	*course = status == RUN_COMPLETE ? NOTHING : RESUME;
	return 0;
}

static int write_config(const struct attempt *attempt, struct error *err)
{
	struct text config = {0};
	int result;

	config_print(attempt->config, &config);
	result = config.failed ? error_memory(err, config.capacity)
						   : file_replace(&(struct file_place){.folder = attempt->folder,
											  .name = "config.yaml",
											  .durable = true},
								 &(struct file_part){config.data, config.length}, 1, err);
	text_clean(&config);
	return result;
}

/* Bring model and recorder to where the run stands; a new run gets its first checkpoint. */
static int prepare(struct attempt *attempt, struct run_file *file, struct error *err)
{
	struct axes axes;

	TRY(attempt->model->create(attempt->config, &attempt->state, err));
	axes = attempt->model->axes(attempt->state);
	TRY(recorder_create(attempt->model, attempt->config, &axes, &attempt->recorder, err));
	if (file)
		return checkpoint_read(attempt, file, err);
	(void)clock_stamp(attempt->created);
	TRY(recorder_begin(attempt->recorder, attempt->state, err));
	return checkpoint_write(attempt, RUN_UNFINISHED, err);
}

/* Tell how the attempt ended, in the run file, status.yaml, run.log and to people. */
static int conclude(struct attempt *attempt, int result, struct error *err)
{
	enum run_state state = result == 0              ? RUN_STATE_COMPLETE
						   : err->code == EX_FAILED ? RUN_STATE_FAILED
													: RUN_STATE_INTERRUPTED;
	char reason[sizeof err->text + sizeof err->file] = "", span[CLOCK_SPAN_SIZE];
	struct error second = {0};

	attempt_say(attempt, RUN_VOICE_PROGRESS, "%s", "");
	if (result != 0)
		(void)error_format(err, reason, sizeof reason);
	if (state == RUN_STATE_FAILED && checkpoint_fail(attempt, reason, &second) != 0) {
		attempt_say(attempt, RUN_VOICE_WARNING, "cannot mark the run as failed: %s", second.text);
		attempt_log(attempt, "cannot mark the run as failed: %s", second.text);
	}
	status_write(attempt, state, reason);
	attempt_log(attempt, "%s: %s", run_state_name(state),
		result ? reason : clock_span(attempt_cpu(attempt), span));
	if (result != 0)
		return err->file[0] ? -1 : error_context(err, "%s", attempt->folder);
	attempt_say(attempt, RUN_VOICE_RESULT, "%s: complete, %llu steps to t = %g s, %s of CPU time",
		attempt->folder, (unsigned long long)attempt->step, attempt->time,
		clock_span(attempt_cpu(attempt), span));
	return 0;
}

/* With the lock held. */
static int live(struct attempt *attempt, struct error *err)
{
	struct run_file *file = NULL;
	enum course course;
	int result = find_course(attempt, &file, &course, err);

	if (result != 0) {
		attempt_log(attempt, "not begun: %s", err->text);
		goto done;
	}
	if (course == NOTHING) {
		attempt_say(attempt, RUN_VOICE_RESULT, "%s: already complete, %llu steps to t = %g s",
			attempt->folder, (unsigned long long)run_file_summary(file)->step,
			run_file_summary(file)->time);
		goto done;
	}
	result = write_config(attempt, err);
	if (result == 0)
		result = prepare(attempt, course == RESUME ? file : NULL, err);
	run_file_close(file);
	file = NULL;
	if (result == 0) {
		attempt->wall_begin = clock_wall();
		attempt->time_begin = attempt->time;
		attempt_log(attempt, "%s at step %llu, t = %g s", course == RESUME ? "resumed" : "started",
			(unsigned long long)attempt->step, attempt->time);
		attempt_tick(attempt);
		result = loop_run(attempt, err);
	}
	result = conclude(attempt, result, err);
done:
	run_file_close(file);
	return result;
}

int run_execute_model(const struct model *model, const struct config *config, const char *folder,
	const struct run_options *options, struct error *err)
{
	struct lock lock = {-1};
	struct attempt attempt = {.model = model,
		.config = config,
		.folder = folder,
		.options = options,
		.lock = &lock,
		.cpu_begin = clock_cpu()};
	struct run_report before = {0};
	struct text path = {0};
	int result = -1;

	if (config_hash(config, attempt.config_hash, err) != 0 || file_make_folders(folder, err) != 0 ||
		file_path(&path, folder, "run.lock", err) != 0 ||
		lock_take(&lock, text_string(&path), err) != 0)
		goto done;
	(void)status_read(folder, &before);
	attempt.number = before.attempts + 1;
	result = live(&attempt, err);
done:
	recorder_free(attempt.recorder);
	model->free(attempt.state);
	lock_release(&lock);
	text_clean(&path);
	return result;
}

int run_execute(const struct config *config, const char *folder, const struct run_options *options,
	struct error *err)
{
	return run_execute_model(model_find(config), config, folder, options, err);
}
