#include "campaign/beginning.h"

#include <dirent.h>
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "campaign/expand.h"

/* A run by what it computes: alike are those that differ by their end. */
struct candidate {
	char alike[CONFIG_HASH_SIZE];
	int repeat;
	double end;
	size_t task;  /* SIZE_MAX: the experiment does not name it */
	char *folder; /* then its folder, owned */
};

struct list {
	struct candidate *items; /* [count] */
	size_t count, capacity;
};

int beginning_hash(const struct config *config, char hash[CONFIG_HASH_SIZE], struct error *err)
{
	struct config alike = *config;

	alike.time.end = 0;
	return config_hash(&alike, hash, err);
}

static int add(
	struct list *list, const struct config *config, struct candidate candidate, struct error *err)
{
	if (list->count == list->capacity) {
		size_t capacity = list->capacity ? 2 * list->capacity : 64;
		struct candidate *items = realloc(list->items, capacity * sizeof *items);

		if (!items) {
			error_memory(err, capacity * sizeof *items);
			return -1;
		}
		list->items = items;
		list->capacity = capacity;
	}
	candidate.end = config->time.end;
	TRY(beginning_hash(config, candidate.alike, err));
	list->items[list->count++] = candidate;
	return 0;
}

/* A folder that the experiment does not name: is it a run that is complete or on its way? What cannot be
 * read is no beginning, and no reason to stop. */
static int add_folder(struct list *list, const char *folder, const char *name, struct error *err)
{
	struct text path = {0}, file = {0};
	struct error unreadable = {0};
	struct run_report report;
	struct config config;
	int result = 0;

	if (file_path(&path, folder, name, err) ||
		file_path(&file, text_string(&path), "config.yaml", err)) {
		result = -1;
		goto done;
	}
	if (!file_exists(text_string(&file)) ||
		config_read(&config, text_string(&file), NULL, 0, &unreadable)) {
		if (unreadable.code == EX_SOFTWARE) {
			*err = unreadable;
			result = -1;
		}
		goto done;
	}
	run_report_read(text_string(&path), &report);
	if (report.unknown) {
		result = error_memory(err, sizeof report);
		goto done;
	}
	if (report.state != RUN_STATE_COMPLETE && report.state != RUN_STATE_INTERRUPTED)
		goto done;
	result = add(list, &config, (struct candidate){.task = SIZE_MAX}, err);
	if (!result) {
		struct candidate *last = &list->items[list->count - 1];

		last->folder = strdup(text_string(&path));
		result = last->folder ? 0 : error_memory(err, path.length);
	}
done:
	text_clean(&path);
	text_clean(&file);
	return result;
}

static int add_folders(struct list *list, const struct experiment *experiment, struct error *err)
{
	struct dirent **entries = NULL;
	int count = scandir(experiment->folder, &entries, NULL, alphasort), result = 0;

	if (count < 0 && errno == ENOMEM)
		return error_memory(err, sizeof **entries);
	for (int i = 0; i < count; i++) {
		const char *name = entries[i]->d_name;

		if (!result && name[0] != '.' && !experiment_owns(experiment, name))
			result = add_folder(list, experiment->folder, name, err);
		free(entries[i]);
	}
	free(entries);
	return result;
}

static int compare(const void *a, const void *b)
{
	const struct candidate *x = a, *y = b;
	int order = strcmp(x->alike, y->alike);

	if (!order)
		order = (x->end > y->end) - (x->end < y->end);
	return order ? order : (x->repeat > y->repeat) - (x->repeat < y->repeat);
}

/* What comes before `list->items[i]` with the same config and an earlier end: a run of this campaign
 * with the same repeat, else the folder with the latest end. */
static int look_back(
	struct campaign *campaign, const struct list *list, size_t i, struct error *err)
{
	const struct candidate *own = &list->items[i];
	struct task *task = &campaign->tasks[own->task];

	while (i-- > 0 && !strcmp(list->items[i].alike, own->alike)) {
		const struct candidate *other = &list->items[i];

		if (other->end >= own->end)
			continue;
		if (other->task != SIZE_MAX && other->repeat == own->repeat && task->before == SIZE_MAX)
			task->before = other->task;
		if (other->task == SIZE_MAX && !task->from) {
			task->from = strdup(other->folder);
			if (!task->from)
				return error_memory(err, strlen(other->folder));
		}
	}
	return 0;
}

/* Nothing can begin with another where all ends are one and no other folder is there. */
static bool do_ends_differ(const struct experiment *experiment)
{
	for (size_t i = 1; i < experiment->run_count; i++)
		if (experiment->runs[i].config.time.end != experiment->runs[0].config.time.end)
			return true;
	return false;
}

int beginning_find(struct campaign *campaign, struct error *err)
{
	const struct experiment *experiment = campaign->experiment;
	struct list list = {0};
	int result = 0;

	if (experiment->timing)
		return 0;
	result = add_folders(&list, experiment, err);
	if (list.count || do_ends_differ(experiment))
		for (size_t i = 0; !result && i < experiment->run_count; i++)
			result = add(&list, &experiment->runs[i].config,
				(struct candidate){.repeat = experiment->runs[i].repeat, .task = i}, err);
	if (list.count)
		qsort(list.items, list.count, sizeof *list.items, compare);
	for (size_t i = 0; !result && i < list.count; i++)
		if (list.items[i].task != SIZE_MAX &&
			campaign->tasks[list.items[i].task].report.state == RUN_STATE_PENDING)
			result = look_back(campaign, &list, i, err);
	for (size_t i = 0; i < list.count; i++)
		free(list.items[i].folder);
	free(list.items);
	return result;
}
