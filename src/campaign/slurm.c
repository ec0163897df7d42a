/* Submitting the runs of a campaign to Slurm. */
#include "campaign/slurm.h"

#include <ctype.h>
#include <limits.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/digest.h"
#include "base/file.h"
#include "base/lock.h"
#include "campaign/order.h"
#include "campaign/task.h"

/* A task to submit. */
struct item {
	struct task *task;
	int depth;   /* tasks of its chain that are to end before it begins: see campaign_execute */
	size_t turn; /* by campaign_order */
};

/* What one `campaign run` hands over. */
struct submission {
	struct campaign *campaign;
	char folder[PATH_MAX], program[PATH_MAX]; /* absolute */
	struct item *items;                       /* [count], by depth and turn */
	size_t count;
	size_t array_size; /* tasks in an array at most */
	int throttle;      /* tasks at a time, 0: no limit of ours */
	struct text after; /* ":12:13": the arrays that are to end before the next one begins */
	struct text level; /* the arrays of the depth that is being submitted */
	unsigned serial;   /* tells the arrays of this folder apart */
};

__attribute__((format(printf, 2, 3))) static void tell(
	const struct submission *submission, const char *format, ...)
{
	const struct campaign_watch *watch = &submission->campaign->watch;
	char line[1024];
	va_list args;

	if (!watch->told)
		return;
	va_start(args, format);
	(void)vsnprintf(line, sizeof line, format, args);
	va_end(args);
	watch->told(watch->context, line);
}

/* The script has paths within quotes, and a list of runs has one a line: a path with a line break, or
 * with another control character that nobody would see, is refused. */
static bool is_printable(const char *path)
{
	for (; *path; path++)
		if (iscntrl((unsigned char)*path))
			return false;
	return true;
}

/* The absolute path of a folder that may not be there yet. */
static int make_absolute(const char *path, char absolute[PATH_MAX], struct error *err)
{
	char here[PATH_MAX];

	if (realpath(path, absolute))
		return 0;
	if (path[0] == '/' ? snprintf(absolute, PATH_MAX, "%s", path) < PATH_MAX
					   : getcwd(here, sizeof here) &&
							 snprintf(absolute, PATH_MAX, "%s/%s", here, path) < PATH_MAX)
		return 0;
	return error_at(err, EX_CANTCREAT, path, 0, 0, "this path is too long");
}

static int submission_init(
	struct submission *submission, struct campaign *campaign, struct error *err)
{
	const struct experiment *experiment = campaign->experiment;
	const char *program = campaign->options.program ? campaign->options.program : "/proc/self/exe";
	char shown[256];

	*submission = (struct submission){.campaign = campaign, .array_size = SLURM_ARRAY_SIZE};
	submission->throttle = experiment->timing     ? 1
						   : campaign->jobs_asked ? campaign->jobs_asked
												  : experiment->slurm.throttle;
	submission->items = calloc(experiment->run_count, sizeof *submission->items);
	if (!submission->items)
		return error_memory(err, experiment->run_count * sizeof *submission->items);
	if (!realpath(program, submission->program))
		return error_set(err, EX_UNAVAILABLE, "%s is not there for the tasks to run", program);
	TRY(make_absolute(experiment->folder, submission->folder, err));
	if (!is_printable(submission->folder) || !is_printable(submission->program))
		return error_set(err, EX_USAGE,
			"%s: a path with a control character cannot be handed to Slurm; name another with -o",
			text_excerpt(experiment->folder, shown, sizeof shown));
	return 0;
}

static void submission_clean(struct submission *submission)
{
	free(submission->items);
	text_clean(&submission->after);
	text_clean(&submission->level);
}

static bool is_among(const char *numbers, const char *number)
{
	size_t length = strlen(number);

	for (const char *at = numbers; (at = strstr(at, number)); at++)
		if (at[length] == ':' || at[length] == '\0')
			return true;
	return false;
}

/* Add the array of this task. */
static void add_array(struct text *arrays, const char *job)
{
	char number[sizeof((struct queue_entry){0}).job + 1];

	(void)snprintf(number, sizeof number, ":%.*s", (int)strcspn(job, "_"), job);
	if (!is_among(text_string(arrays), number))
		text_add(arrays, number);
}

/* The task that this one goes on from, if the end of that lies ahead; else NULL. */
static struct task *task_ahead(const struct campaign *campaign, const struct task *task)
{
	struct task *before;

	if (task->report.state != RUN_STATE_PENDING || task->before == SIZE_MAX)
		return NULL;
	before = &campaign->tasks[task->before];
	return before->state == TASK_WAITING || before->state == TASK_QUEUED ||
				   before->state == TASK_ELSEWHERE
			   ? before
			   : NULL;
}

/* By depth, so that an array holds none that waits for another in it. */
static int compare_items(const void *a, const void *b)
{
	const struct item *x = a, *y = b;

	if (x->depth != y->depth)
		return x->depth < y->depth ? -1 : 1;
	return x->turn < y->turn ? -1 : x->turn > y->turn;
}

/* Look at the tasks once more: which of them are in the queue? */
static int look_at_tasks(
	struct submission *submission, const struct queue_entry *entries, struct error *err)
{
	struct campaign *campaign = submission->campaign;

	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		struct task *task = &campaign->tasks[i];

		task_look(campaign, task);
		if (task->report.unknown)
			return error_memory(err, sizeof task->report);
		task->queue = entries[i];
		if (!task->queue.job[0] || task->state == TASK_COMPLETE)
			continue;
		if (campaign->experiment->timing) /* one at a time, whoever submitted it */
			add_array(&submission->after, task->queue.job);
		if (task->state != TASK_LEFT)
			task->state = TASK_QUEUED;
	}
	return 0;
}

/* The tasks that are neither at their end nor in the queue nor at work elsewhere. */
static int choose_tasks(
	struct submission *submission, const struct queue_entry *entries, struct error *err)
{
	const struct campaign *campaign = submission->campaign;
	struct task **order;

	TRY(look_at_tasks(submission, entries, err));
	order = campaign_order(campaign, err);
	if (!order)
		return -1;
	for (size_t i = 0; i < campaign->experiment->run_count; i++) {
		struct item item = {order[i], 0, i};

		if (item.task->state != TASK_WAITING)
			continue;
		for (const struct task *t = item.task; (t = task_ahead(campaign, t));)
			item.depth++;
		submission->items[submission->count++] = item;
	}
	free(order);
	if (submission->count)
		qsort(submission->items, submission->count, sizeof *submission->items, compare_items);
	return 0;
}

/* The folder of the run that a task goes on from, if it has none of its own; NULL: it starts at 0. */
static const char *find_from(const struct campaign *campaign, const struct task *task)
{
	const struct task *ahead = task_ahead(campaign, task);

	return ahead ? ahead->run->folder : task_from(campaign, task);
}

static int prepare_task(const struct campaign *campaign, const struct task *task, struct error *err)
{
	const char *from = find_from(campaign, task);

	if (!is_printable(task->run->folder) || (from && !is_printable(from)))
		return error_set(err, EX_CANTCREAT, "the name of %s has a control character; rename it",
			is_printable(task->run->folder) ? "the folder that it goes on from" : "its folder");
	return task_write_config(task, err);
}

/* A run whose folder or config cannot be written fails alone; on a disk that holds no more nothing is
 * submitted. */
static int prepare_tasks(struct submission *submission, struct error *err)
{
	struct error *fault = &submission->campaign->fault;
	size_t kept = 0;

	for (size_t i = 0; i < submission->count && !fault->code; i++) {
		struct task *task = submission->items[i].task;

		if (prepare_task(submission->campaign, task, err) == 0) {
			submission->items[kept++] = submission->items[i];
			continue;
		}
		if (err->code != EX_CANTCREAT && err->code != EX_IOERR)
			return -1;
		task->state = TASK_FAILED;
		task->code = err->code;
		(void)error_format(err, task->report.reason, sizeof task->report.reason);
		*err = (struct error){0};
		task_blame_disk(submission->campaign, task);
	}
	submission->count = fault->code ? 0 : kept;
	return 0;
}

/* "talus-STEM-1a2b3c4d": readable, and known by its digits to this folder alone. */
static void name_array(struct submission *submission, char name[SLURM_NAME_SIZE])
{
	enum { STEM = 40 };
	const char *path = submission->campaign->experiment->path, *slash = strrchr(path, '/');
	const char *stem = slash ? slash + 1 : path, *dot = strrchr(stem, '.');
	int length = (int)(dot && dot > stem ? (size_t)(dot - stem) : strlen(stem));
	unsigned char digest[DIGEST_SIZE];

	digest_of_two(submission->folder, strlen(submission->folder), &submission->serial,
		sizeof submission->serial, digest);
	(void)snprintf(name, SLURM_NAME_SIZE, "talus-%.*s-%02x%02x%02x%02x",
		length < STEM ? length : STEM, stem, digest[0], digest[1], digest[2], digest[3]);
	for (char *c = name; *c; c++)
		if (!isalnum((unsigned char)*c) && !strchr("._-", *c))
			*c = '-';
}

static bool is_taken(const struct submission *submission, const char *name)
{
	struct text path = {0};
	bool taken;

	text_addf(&path, "%s/" SLURM_FOLDER "/%s.runs", submission->folder, name);
	taken = file_exists(text_string(&path));
	text_clean(&path);
	return taken;
}

static struct slurm_array make_array(struct submission *submission, size_t first)
{
	const struct item *items = submission->items;
	struct slurm_array array = {.section = &submission->campaign->experiment->slurm,
		.folder = submission->folder,
		.program = submission->program,
		.first = first,
		.throttle = submission->throttle};

	while (array.count < submission->array_size && first + array.count < submission->count &&
		   items[first + array.count].depth == items[first].depth)
		array.count++;
	do {
		submission->serial++;
		name_array(submission, array.name);
	} while (is_taken(submission, array.name));
	return array;
}

/* What the script tells `talus run` beside the config; a task that comes back from the queue is told it
 * again, when its run has a file and is not failed, and neither means anything. */
static void add_run(const struct campaign *campaign, const struct task *task, struct text *runs)
{
	const char *from = find_from(campaign, task);

	text_add(runs, slurm_run_name(task->run->folder));
	if (task_may_begin_anew(campaign, task))
		text_add(runs, "\t--retry");
	if (from)
		text_addf(runs, "\t--continue-from\t./%s", slurm_run_name(from));
	text_add(runs, "\n");
}

/* What the tasks of an array go on from comes to its end before it: the arrays of one depth less, and
 * what an earlier command has in the queue. */
static void wait_for_chains(struct submission *submission, const struct slurm_array *array)
{
	const struct item *items = &submission->items[array->first];

	if (array->first && items[0].depth != items[-1].depth && !submission->throttle) {
		text_clean(&submission->after);
		submission->after = submission->level;
		submission->level = (struct text){0};
	}
	for (size_t i = 0; i < array->count; i++) {
		const struct task *ahead = task_ahead(submission->campaign, items[i].task);

		if (ahead && ahead->queue.job[0])
			add_array(&submission->after, ahead->queue.job);
	}
}

static int submit_array(struct submission *submission, size_t *first, struct error *err)
{
	const struct slurm_array array = make_array(submission, *first);
	struct text runs = {0};
	char job[SLURM_JOB_SIZE];
	int result;

	for (size_t i = 0; i < array.count; i++)
		add_run(submission->campaign, submission->items[*first + i].task, &runs);
	wait_for_chains(submission, &array);
	result = slurm_submit(&array, &runs, &submission->after, job, err);
	text_clean(&runs);
	TRY(result);
	for (size_t i = 0; i < array.count; i++)
		submission->items[*first + i].task->state = TASK_QUEUED;
	if (submission->throttle) /* which is one array's: the next one begins after it */
		text_clean(&submission->after);
	add_array(submission->throttle ? &submission->after : &submission->level, job);
	tell(submission, "job %s: %zu run%s (%s)", job, array.count, array.count == 1 ? "" : "s",
		array.name);
	*first += array.count;
	return 0;
}

static int submit_all(struct submission *submission, struct error *err)
{
	if (!submission->count)
		return 0;
	TRY(slurm_array_size(&submission->array_size, err));
	TRY(prepare_tasks(submission, err));
	for (size_t first = 0; first < submission->count;)
		TRY(submit_array(submission, &first, err));
	return 0;
}

/* The queue is asked before the runs are looked at: what leaves it in between has left its result. */
static int submit(struct submission *submission, struct error *err)
{
	const struct experiment *experiment = submission->campaign->experiment;
	struct queue_entry *entries = calloc(experiment->run_count, sizeof *entries);
	int result;

	if (!entries)
		return error_memory(err, experiment->run_count * sizeof *entries);
	result = slurm_queue(experiment, entries, err);
	if (result == 0)
		result = choose_tasks(submission, entries, err);
	if (result == 0)
		result = submit_all(submission, err);
	free(entries);
	return result;
}

int slurm_execute(struct campaign *campaign, struct error *err)
{
	struct submission submission = {0};
	struct lock lock = {-1};
	int result = -1;

	if (!slurm_check(err) && !submission_init(&submission, campaign, err) &&
		!slurm_lock(campaign->experiment, &lock, err))
		result = submit(&submission, err);
	lock_release(&lock);
	submission_clean(&submission);
	return result;
}

static void print_scripts(struct submission *submission, struct text *out)
{
	size_t arrays = 0;

	for (size_t first = 0; first < submission->count; arrays++) {
		const struct slurm_array array = make_array(submission, first);

		slurm_script_write(&array, out);
		first += array.count;
	}
	tell(submission, "%zu run%s to submit in %zu array%s, %zu in the queue", submission->count,
		submission->count == 1 ? "" : "s", arrays, arrays == 1 ? "" : "s",
		campaign_count(submission->campaign, TASK_QUEUED));
}

/* The scripts are worth a look also where there is no Slurm to ask. */
int slurm_plan(struct campaign *campaign, struct text *out, struct error *err)
{
	struct queue_entry *entries = calloc(campaign->experiment->run_count, sizeof *entries);
	struct submission submission = {0};
	struct error silence = {0};
	int result = -1;

	if (!entries) {
		error_memory(err, campaign->experiment->run_count * sizeof *entries);
		goto done;
	}
	if (submission_init(&submission, campaign, err))
		goto done;
	if (slurm_check(&silence) || slurm_array_size(&submission.array_size, &silence) ||
		slurm_queue(campaign->experiment, entries, &silence))
		tell(&submission, "%s; an empty queue and arrays of %zu tasks are assumed", silence.text,
			submission.array_size);
	result = choose_tasks(&submission, entries, err);
	if (result == 0)
		print_scripts(&submission, out);
done:
	submission_clean(&submission);
	free(entries);
	return result;
}
