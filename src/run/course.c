#include "run/course.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "run/run_file_parts.h"

/* Of differences between configs, a line each. */
static bool is_end_alone(const char *keys)
{
	return !strncmp(keys, "time.end:", 9) && !strchr(keys, '\n')[1];
}

/* Refuse a file that this config and this program would not have made. One whose run has an earlier end
 * and else the same config is a beginning of this run: `*earlier` is then its end, else NaN. */
static int compare_config(
	const struct attempt *attempt, struct run_file *file, double *earlier, struct error *err)
{
	struct text keys = {0}, list = {0};
	struct error unreadable = {0};
	struct config config;
	int result = -1;
	bool later;
	char *rest;

	*earlier = NAN;
	if (!strcmp(run_file_summary(file)->config_hash, attempt->config_hash))
		return 0;
	if (run_file_config(file, &config, &unreadable) == 0)
		config_differences(&config, attempt->config, &keys);
	if (unreadable.code == EX_SOFTWARE || keys.failed) {
		*err = unreadable;
		if (keys.failed)
			error_memory(err, keys.capacity);
		goto done;
	}
	later = keys.length && config.time.end < attempt->config->time.end;
	if (later && is_end_alone(keys.data)) {
		*earlier = config.time.end;
		result = 0;
		goto done;
	}
	for (char *key = keys.data ? strtok_r(keys.data, "\n", &rest) : NULL; key;
		 key = strtok_r(NULL, "\n", &rest))
		text_addf(&list, list.length ? ", %s" : "%s", key);
	error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
		"was made from another config (%s); %sname another folder with -o, or remove this one",
		list.length ? text_string(&list) : "one that this version cannot read",
		later ? "it goes on to a later time.end where nothing else changes: "
				"leave the other keys as they were, or "
			  : "");
done:
	text_clean(&keys);
	text_clean(&list);
	return result;
}

static int compare_numerics(const struct attempt *attempt, struct run_file *file, struct error *err)
{
	double version;

	TRY(run_file_real(file, "numerics_version", &version, err));
	if (version == attempt->model->numerics_version)
		return 0;
	return error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
		"was made with numerics_version %g, and this program has %d; "
		"name another folder with -o, or remove this one",
		version, attempt->model->numerics_version);
}

/* Take from the file what an attempt carries on whatever its course: the run's past. */
static int read_past(struct attempt *attempt, struct run_file *file, struct error *err)
{
	struct text created = {0};
	int result = -1;

	if (run_file_real(file, "cpu_seconds", &attempt->cpu_before, err) != 0 ||
		run_file_text(file, "created", &created, err) != 0)
		goto done;
	(void)snprintf(attempt->created, sizeof attempt->created, "%s", text_string(&created));
	result = 0;
done:
	text_clean(&created);
	return result;
}

/* Files of before this was possible lack the state to go on from once they are complete. */
static int can_continue(struct run_file *file, struct error *err)
{
	bool has;

	TRY(run_file_has(file, RUN_FILE_CONTINUATION, &has, err));
	if (has || run_file_summary(file)->status != RUN_COMPLETE)
		return 0;
	return error_at(err, EX_DATAERR, run_file_path(file), 0, 0,
		"is complete with an earlier time.end, and holds no %s to go on from",
		RUN_FILE_CONTINUATION);
}

/* The same of a file in the run's own folder. */
static int read_own_past(struct attempt *attempt, struct run_file *file, struct error *err)
{
	double attempts;

	TRY(run_file_real(file, "attempts", &attempts, err));
	if (attempts >= attempt->number)
		attempt->number = (int)fmin(attempts, 1e9) + 1;
	attempt->keep_newest = run_file_is_newest(file);
	return read_past(attempt, file, err);
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

/* A finished run with an earlier end stays beside the one that goes on from it, under this name. */
enum { KEPT_SIZE = TEXT_REAL_SIZE + 16 };
static char *kept_name(double end, char name[KEPT_SIZE])
{
	char number[TEXT_REAL_SIZE];

	(void)snprintf(name, KEPT_SIZE, "run.end-%s.h5", text_real(end, number));
	return name;
}

static int keep_earlier(
	const struct attempt *attempt, struct run_file *file, double earlier, struct error *err)
{
	char number[TEXT_REAL_SIZE], name[KEPT_SIZE];
	struct text path = {0};
	unsigned char *bytes = NULL;
	size_t size;
	int result = 0;

	TRY(file_path(&path, attempt->folder, kept_name(earlier, name), err));
	if (!file_exists(text_string(&path)))
		result = file_read(run_file_path(file), &bytes, &size, err) != 0 ||
						 file_replace(
							 &(struct file_place){
								 .folder = attempt->folder, .name = name, .durable = true},
							 &(struct file_part){bytes, size}, 1, err) != 0
					 ? -1
					 : 0;
	free(bytes);
	if (result == 0)
		attempt_say(attempt, RUN_VOICE_RESULT,
			"%s: goes on from the run to %s s, which is kept as %s", attempt->folder,
			text_real(earlier, number), name);
	text_clean(&path);
	return result;
}

/* run.h5 is another run, with the error `err`. This one may have been finished before that went on from
 * it: then it takes the place of `*file`. */
static int find_kept(
	struct attempt *attempt, struct run_file **file, enum course *course, struct error *err)
{
	char name[KEPT_SIZE];
	const char *remark;
	struct text path = {0};
	struct error other = {0};
	struct run_file *kept = NULL;
	double earlier;
	bool found = err->code == EX_DATAERR &&
				 file_path(&path, attempt->folder, kept_name(attempt->config->time.end, name),
					 &other) == 0 &&
				 run_file_open(text_string(&path), &kept, &remark, &other) == 0 &&
				 run_file_summary(kept)->status == RUN_COMPLETE &&
				 compare_config(attempt, kept, &earlier, &other) == 0 && isnan(earlier) &&
				 compare_numerics(attempt, kept, &other) == 0;

	text_clean(&path);
	if (found) {
		run_file_close(*file);
		*file = kept;
		*course = COURSE_NOTHING;
		*err = (struct error){0};
		return 0;
	}
	run_file_close(kept);
	if (other.code == EX_SOFTWARE)
		*err = other;
	return -1;
}

/* The run of options->from, if it is a beginning of this one. One that is not, or cannot be read, is
 * told, and this run starts at 0. */
static int find_beginning(
	struct attempt *attempt, struct run_file **file, enum course *course, struct error *err)
{
	char message[sizeof err->text + sizeof err->file];
	struct text warning = {0};
	struct error why = {0};
	double earlier = NAN;

	*course = COURSE_START;
	if (!attempt->options->from)
		return 0;
	if (run_file_open_newest(attempt->options->from, file, &warning, &why) == 0 &&
		compare_config(attempt, *file, &earlier, &why) == 0 &&
		compare_numerics(attempt, *file, &why) == 0 && !isnan(earlier) &&
		run_file_summary(*file)->status != RUN_FAILED && can_continue(*file, &why) == 0 &&
		read_past(attempt, *file, &why) == 0)
		*course = COURSE_CONTINUE;
	text_clean(&warning);
	if (*course == COURSE_CONTINUE) {
		attempt_say(attempt, RUN_VOICE_RESULT, "%s: goes on from %s, a run to %g s",
			attempt->folder, attempt->options->from, earlier);
		attempt_log(attempt, "goes on from %s, a run to %g s", attempt->options->from, earlier);
		return 0;
	}
	attempt->cpu_before = 0;
	run_file_close(*file);
	*file = NULL;
	if (why.code == EX_SOFTWARE) {
		*err = why;
		return -1;
	}
	if (!why.code)
		(void)error_at(&why, EX_DATAERR, attempt->options->from, 0, 0, "is not its beginning");
	(void)error_format(&why, message, sizeof message);
	attempt_say(attempt, RUN_VOICE_WARNING, "starts anew: %s", message);
	attempt_log(attempt, "warning: starts anew: %s", message);
	return 0;
}

/* No generation is good. Only --retry starts anew, and what is damaged is kept under other names. */
static int leave_damaged(
	struct attempt *attempt, struct run_file **file, enum course *course, struct error *err)
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
	return find_beginning(attempt, file, course, err);
}

int course_find(
	struct attempt *attempt, struct run_file **file, enum course *course, struct error *err)
{
	struct text warning = {0};
	enum run_status status;
	double earlier;
	int result = run_file_open_newest(attempt->folder, file, &warning, err);

	if (result == 0 && warning.length) {
		attempt_say(attempt, RUN_VOICE_WARNING, "%s", text_string(&warning));
		attempt_log(attempt, "warning: %s", text_string(&warning));
	}
	text_clean(&warning);
	if (result != 0 && err->code == EX_NOINPUT) {
		*err = (struct error){0};
		return find_beginning(attempt, file, course, err);
	}
	if (result != 0 && err->code == EX_DATAERR)
		return leave_damaged(attempt, file, course, err);
	if (result != 0)
		return -1;
	TRY(read_own_past(attempt, *file, err));
	status = run_file_summary(*file)->status;
	if (status == RUN_FAILED && attempt->options->retry) {
		*course = COURSE_START;
		attempt->cpu_before = 0;
		attempt->created[0] = '\0';
		return 0;
	}
	if (compare_config(attempt, *file, &earlier, err) != 0)
		return find_kept(attempt, file, course, err);
	TRY(compare_numerics(attempt, *file, err));
	if (status == RUN_FAILED)
		return failed_before(attempt, *file, err);
	*course = status == RUN_COMPLETE ? COURSE_NOTHING : COURSE_RESUME;
	if (isnan(earlier))
		return 0;
	*course = COURSE_CONTINUE;
	TRY(can_continue(*file, err));
	return status == RUN_COMPLETE ? keep_earlier(attempt, *file, earlier, err) : 0;
}
