#include "talus/run.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/lock.h"
#include "run/checkpoint.h"
#include "run/course.h"
#include "run/life.h"
#include "run/loop.h"
#include "run/run_file_parts.h"
#include "run/status.h"

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

/* Bring model and recorder to where the run stands. A run that is new, or has got a later end, gets its
 * first checkpoint. */
static int prepare(
	struct attempt *attempt, struct run_file *file, enum course course, struct error *err)
{
	struct axes axes;

	TRY(attempt->model->create(attempt->config, &attempt->state, err));
	axes = attempt->model->axes(attempt->state);
	TRY(recorder_create(attempt->model, attempt->config, &axes, &attempt->recorder, err));
	if (course == COURSE_RESUME)
		return checkpoint_read(attempt, file, err);
	if (course == COURSE_CONTINUE) {
		TRY(checkpoint_continue(attempt, file, err));
	} else {
		TRY(recorder_begin(attempt->recorder, attempt->state, err));
	}
	if (!attempt->created[0])
		(void)clock_stamp(attempt->created);
	return checkpoint_write(attempt, RUN_UNFINISHED, err);
}

/* What is doubtful in the run, if anything is, also into `doubt`. */
static void tell_doubt(const struct attempt *attempt, char doubt[MODEL_DOUBT_SIZE])
{
	*doubt = '\0';
	if (!attempt->state || !attempt->model->doubt || !attempt->model->doubt(attempt->state, doubt))
		return;
	attempt_say(attempt, RUN_VOICE_WARNING, "%s: %s", attempt->folder, doubt);
	attempt_log(attempt, "warning: %s", doubt);
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
	if (state != RUN_STATE_FAILED)
		tell_doubt(attempt, reason);
	if (result != 0)
		(void)error_format(err, reason, sizeof reason);
	if (state == RUN_STATE_FAILED && checkpoint_fail(attempt, reason, &second) != 0) {
		attempt_say(attempt, RUN_VOICE_WARNING, "cannot mark the run as failed: %s", second.text);
		attempt_log(attempt, "cannot mark the run as failed: %s", second.text);
	}
	status_note_end(attempt, state, reason);
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
	static const char *const words[] = {"started", "resumed", "continued"};
	struct run_file *file = NULL;
	enum course course;
	int result = course_find(attempt, &file, &course, err);

	if (result != 0) {
		attempt_log(attempt, "not begun: %s", err->text);
		goto done;
	}
	if (course == COURSE_NOTHING) {
		attempt_say(attempt, RUN_VOICE_RESULT, "%s: already complete, %llu steps to t = %g s",
			run_file_is_newest(file) ? attempt->folder : run_file_path(file),
			(unsigned long long)run_file_summary(file)->step, run_file_summary(file)->time);
		goto done;
	}
	result = write_config(attempt, err);
	if (result == 0)
		result = prepare(attempt, file, course, err);
	run_file_close(file);
	file = NULL;
	if (result == 0) {
		attempt_log(attempt, "%s at step %llu, t = %g s", words[course],
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
	struct text path = {0};
	int result = -1;

	if (config_hash(config, attempt.config_hash, err) != 0 || file_make_folders(folder, err) != 0 ||
		file_path(&path, folder, "run.lock", err) != 0 ||
		lock_take(&lock, text_string(&path), err) != 0)
		goto done;
	result = status_read_past(&attempt, err);
	if (result == 0)
		result = live(&attempt, err);
done:
	recorder_free(attempt.recorder);
	free(attempt.mark.values);
	text_clean(&attempt.ended);
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
