/* What the queue of Slurm says of the runs of an experiment, by squeue alone. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/lock.h"
#include "base/process.h"
#include "campaign/slurm.h"

/* The runs of a NAME.runs. */
struct array_runs {
	char name[SLURM_NAME_SIZE];
	char *text;         /* cut into lines; NULL: there is no such file */
	const char **lines; /* [count]; NULL as well */
	size_t count;
	struct array_runs *next;
};

/* A run by the name of its folder. */
struct named_run {
	const char *name;
	size_t index;
};

struct lookup {
	const struct experiment *experiment;
	struct named_run *runs;    /* [experiment->run_count], by name */
	struct array_runs *arrays; /* read so far */
};

static int compare_names(const void *a, const void *b)
{
	return strcmp(((const struct named_run *)a)->name, ((const struct named_run *)b)->name);
}

const char *slurm_run_name(const char *folder)
{
	return strrchr(folder, '/') + 1;
}

static int lookup_init(
	struct lookup *lookup, const struct experiment *experiment, struct error *err)
{
	*lookup = (struct lookup){.experiment = experiment};
	lookup->runs = calloc(experiment->run_count, sizeof *lookup->runs);
	if (!lookup->runs)
		return error_memory(err, experiment->run_count * sizeof *lookup->runs);
	for (size_t i = 0; i < experiment->run_count; i++)
		lookup->runs[i] = (struct named_run){slurm_run_name(experiment->runs[i].folder), i};
	qsort(lookup->runs, experiment->run_count, sizeof *lookup->runs, compare_names);
	return 0;
}

static void lookup_clean(struct lookup *lookup)
{
	for (struct array_runs *array = lookup->arrays, *next; array; array = next) {
		next = array->next;
		free(array->text);
		free(array->lines);
		free(array);
	}
	free(lookup->runs);
}

static int cut_lines(struct array_runs *array, struct error *err)
{
	size_t count = 0;

	for (const char *c = array->text; *c; c++)
		count += *c == '\n';
	array->lines = calloc(count + 1, sizeof *array->lines);
	if (!array->lines)
		return error_memory(err, (count + 1) * sizeof *array->lines);
	for (char *line = array->text, *end; (end = strchr(line, '\n')); line = end + 1) {
		*end = '\0';
		line[strcspn(line, "\t")] = '\0';
		array->lines[array->count++] = line;
	}
	return 0;
}

/* The runs of the array with this name; NULL with `err` when memory is short. A job of another folder has
 * none here. */
static struct array_runs *find_array(struct lookup *lookup, const char *name, struct error *err)
{
	struct array_runs *array = lookup->arrays;
	unsigned char *bytes = NULL;
	struct error absent = {0};
	struct text path = {0};
	size_t size;

	while (array && strcmp(array->name, name) != 0)
		array = array->next;
	if (array)
		return array;
	array = calloc(1, sizeof *array);
	if (!array) {
		error_memory(err, sizeof *array);
		return NULL;
	}
	(void)snprintf(array->name, sizeof array->name, "%s", name);
	array->next = lookup->arrays;
	lookup->arrays = array;
	text_addf(&path, "%s/" SLURM_FOLDER "/%s.runs", lookup->experiment->folder, name);
	if (!path.failed && !file_read(path.data, &bytes, &size, &absent)) {
		array->text = (char *)bytes;
		if (cut_lines(array, err))
			array = NULL; /* the list has it */
	} else if (path.failed || absent.code == EX_SOFTWARE) {
		error_memory(err, path.length);
		array = NULL;
	}
	text_clean(&path);
	return array;
}

/* A line "12_3 PENDING NAME (Reason)" of squeue. */
static int read_line(
	struct lookup *lookup, const char *line, struct queue_entry *entries, struct error *err)
{
	struct queue_entry entry = {0};
	char name[SLURM_NAME_SIZE];
	const struct array_runs *array;
	const struct named_run *run;
	const char *task;
	size_t index;

	if (sscanf(line, "%31s %31s %63s %127[^\n]", entry.job, entry.state, name, entry.reason) < 3)
		return 0;
	task = strchr(entry.job, '_');
	if (!task || strchr(name, '/'))
		return 0;
	array = find_array(lookup, name, err);
	if (!array)
		return -1;
	index = strtoul(task + 1, NULL, 10);
	if (index >= array->count)
		return 0;
	run = bsearch(&(struct named_run){array->lines[index], 0}, lookup->runs,
		lookup->experiment->run_count, sizeof *run, compare_names);
	/* should a run be there twice, the task that works on it is the one to know of */
	if (run && (!entries[run->index].job[0] || !strcmp(entry.state, "RUNNING")))
		entries[run->index] = entry;
	return 0;
}

static int read_lines(
	struct lookup *lookup, char *lines, struct queue_entry *entries, struct error *err)
{
	char *rest = NULL;

	for (char *line = strtok_r(lines, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
		TRY(read_line(lookup, line, entries, err));
	return 0;
}

static bool was_submitted(const struct experiment *experiment)
{
	struct error ignored = {0};
	struct text path = {0};
	bool there =
		!file_path(&path, experiment->folder, SLURM_FOLDER, &ignored) && file_is_folder(path.data);

	text_clean(&path);
	return there;
}

int slurm_queue(const struct experiment *experiment, struct queue_entry *entries, struct error *err)
{
	char user[32];
	const char *const squeue[] = {
		"squeue", "--noheader", "--array", "--user", user, "--format=%i %T %j %r", NULL};
	struct lookup lookup = {0};
	struct text out = {0};
	int result = -1;

	if (!was_submitted(experiment))
		return 0;
	(void)snprintf(user, sizeof user, "%lu", (unsigned long)getuid());
	if (process_run(squeue, SLURM_PATIENCE, &out, err) || lookup_init(&lookup, experiment, err))
		goto done;
	text_add(&out, ""); /* not NULL */
	text_tame(out.data);
	result =
		out.failed ? error_memory(err, out.capacity) : read_lines(&lookup, out.data, entries, err);
done:
	lookup_clean(&lookup);
	text_clean(&out);
	return result;
}

int slurm_lock(const struct experiment *experiment, struct lock *lock, struct error *err)
{
	struct text folder = {0}, path = {0};
	int result = -1;

	lock->fd = -1;
	if (!file_path(&folder, experiment->folder, SLURM_FOLDER, err) &&
		!file_make_folders(folder.data, err) && !file_path(&path, folder.data, "submit.lock", err))
		result = lock_take(lock, path.data, err);
	text_clean(&folder);
	text_clean(&path);
	return result;
}

enum { BATCH = 1000 }; /* jobs that one scancel is given */

static int cancel_batch(const char **jobs, size_t count, struct error *err)
{
	struct text ignored = {0};
	int result;

	jobs[0] = "scancel";
	jobs[count + 1] = NULL;
	result = count ? process_run(jobs, SLURM_PATIENCE, &ignored, err) : 0;
	text_clean(&ignored);
	return result;
}

static int cancel_entries(const struct experiment *experiment, const bool *chosen,
	const struct queue_entry *entries, size_t *cancelled, struct error *err)
{
	const char *jobs[BATCH + 2];
	size_t count = 0;

	for (size_t i = 0; i < experiment->run_count; i++) {
		if (!entries[i].job[0] || (chosen && !chosen[i]))
			continue;
		jobs[++count] = entries[i].job;
		if (count == BATCH) {
			TRY(cancel_batch(jobs, count, err));
			*cancelled += count;
			count = 0;
		}
	}
	TRY(cancel_batch(jobs, count, err));
	*cancelled += count;
	return 0;
}

int slurm_cancel(
	const struct experiment *experiment, const bool *chosen, size_t *count, struct error *err)
{
	struct queue_entry *entries;
	struct lock lock;
	int result;

	*count = 0;
	if (!was_submitted(experiment))
		return 0;
	entries = calloc(experiment->run_count, sizeof *entries);
	if (!entries)
		return error_memory(err, experiment->run_count * sizeof *entries);
	result = slurm_lock(experiment, &lock, err);
	if (result == 0)
		result = slurm_queue(experiment, entries, err);
	if (result == 0)
		result = cancel_entries(experiment, chosen, entries, count, err);
	lock_release(&lock);
	free(entries);
	return result;
}
