/* The names of runs: what a person reads, and the digits of the hash by which a run is found. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "campaign/expand.h"
#include "campaign/run_key.h"
#include "talus/text.h"

enum {
	READABLE_MAX = 60, /* bytes of a name before repeat and hash */
	DIGITS = 8         /* of the hash, more where two runs of the experiment begin alike */
};

/* The keys that names are made of: those that tell runs apart which the keys before them do not. */
struct naming {
	const struct experiment *experiment;
	size_t runs;       /* without repeats */
	const char **keys; /* [key_count] */
	size_t key_count;
	uint64_t *classes; /* [runs], equal where the keys so far do not tell runs apart */
	uint64_t *sorted;  /* [runs] */
	size_t class_count;
};

static const struct setting *find_setting(const struct experiment_run *run, const char *key)
{
	for (size_t i = 0; i < run->settings.count; i++)
		if (!strcmp(run->settings.items[i].key, key))
			return &run->settings.items[i];
	return NULL;
}

static int compare_classes(const void *a, const void *b)
{
	uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

	return (x > y) - (x < y);
}

/* Split the classes by the values of `key`; NULL: by the point of a sample. Left as they are when that
 * tells nothing new. */
static bool split(struct naming *naming, const char *key)
{
	size_t count = 0;

	for (size_t i = 0; i < naming->runs; i++) {
		const struct experiment_run *run = &naming->experiment->runs[i];
		const struct setting *setting = key ? find_setting(run, key) : NULL;

		naming->sorted[i] = naming->classes[i];
		if (setting)
			naming->sorted[i] =
				XXH3_64bits_withSeed(setting->value, strlen(setting->value), naming->classes[i]);
		else if (!key && run->point)
			naming->sorted[i] =
				XXH3_64bits_withSeed(&run->point, sizeof run->point, naming->classes[i]);
	}
	memcpy(naming->classes + naming->runs, naming->sorted, naming->runs * sizeof *naming->sorted);
	qsort(naming->sorted, naming->runs, sizeof *naming->sorted, compare_classes);
	for (size_t i = 0; i < naming->runs; i++)
		count += i == 0 || naming->sorted[i] != naming->sorted[i - 1];
	if (count <= naming->class_count)
		return false;
	memcpy(naming->classes, naming->classes + naming->runs, naming->runs * sizeof *naming->classes);
	naming->class_count = count;
	return true;
}

static bool is_known(const struct naming *naming, const char *key, size_t asked)
{
	for (size_t i = 0; i < asked; i++)
		if (!strcmp(naming->keys[i], key))
			return true;
	return false;
}

static void naming_clean(struct naming *naming)
{
	free(naming->keys);
	free(naming->classes);
	free(naming->sorted);
}

/* The keys in the order in which the runs bring them. */
static int naming_init(
	struct naming *naming, const struct experiment *experiment, struct error *err)
{
	size_t runs = experiment->run_count / (size_t)experiment->repeat, asked = 0, most = 1;

	*naming = (struct naming){.experiment = experiment, .runs = runs, .class_count = 1};
	for (size_t i = 0; i < runs; i++)
		most =
			experiment->runs[i].settings.count > most ? experiment->runs[i].settings.count : most;
	most += 128; /* no config has so many keys; duplicates are refused */
	naming->keys = calloc(most, sizeof *naming->keys);
	naming->classes = calloc(2 * runs + 1, sizeof *naming->classes);
	naming->sorted = calloc(runs + 1, sizeof *naming->sorted);
	if (!naming->keys || !naming->classes || !naming->sorted)
		return error_memory(err, 2 * runs * sizeof *naming->classes);
	(void)split(naming, NULL);
	for (size_t i = 0; i < runs; i++)
		for (size_t k = 0; k < experiment->runs[i].settings.count; k++) {
			const char *key = experiment->runs[i].settings.items[k].key;

			if (asked < most && !is_known(naming, key, asked))
				naming->keys[asked++] = key;
		}
	for (size_t i = 0; i < asked; i++)
		if (split(naming, naming->keys[i]))
			naming->keys[naming->key_count++] = naming->keys[i];
	return 0;
}

static const char *last_part(const char *key)
{
	const char *dot = strrchr(key, '.');

	return dot ? dot + 1 : key;
}

/* The last part of a dotted key, or all of it where two keys of the names end alike. */
static const char *short_key(const struct naming *naming, const char *key)
{
	for (size_t i = 0; i < naming->key_count; i++) {
		const char *other = naming->keys[i];

		if (strcmp(other, key) != 0 && !strcmp(last_part(other), last_part(key)))
			return key;
	}
	return last_part(key);
}

/* Blanks go, what else a file name or a shell would trip over becomes one '-' between what stays. */
static void add_safe(struct text *out, const char *value)
{
	size_t start = out->length;

	for (bool gap = false; *value; value++) {
		bool plain = isalnum((unsigned char)*value) || strchr("._+-", *value);

		if (isspace((unsigned char)*value))
			continue;
		if (plain && gap && out->length > start)
			text_add(out, "-");
		if (plain)
			text_add_bytes(out, value, 1);
		gap = !plain;
	}
}

static void add_setting(
	const struct naming *naming, const struct setting *setting, struct text *out)
{
	if (!setting)
		return;
	text_addf(out, "%s%s-", out->length ? "_" : "", short_key(naming, setting->key));
	add_safe(out, setting->value);
}

static void add_readable(
	const struct naming *naming, const struct experiment_run *run, struct text *out)
{
	bool lacks;

	if (run->point)
		text_addf(out, "point-%d", run->point);
	for (size_t i = 0; i < naming->key_count; i++)
		add_setting(naming, find_setting(run, naming->keys[i]), out);
	lacks = !out->length;
	/* apart from the others by what it lacks: what it has says more */
	for (size_t i = 0; lacks && i < run->settings.count; i++)
		add_setting(naming, &run->settings.items[i], out);
	if (!out->length)
		text_add(out, "base");
	if (out->length > READABLE_MAX)
		out->data[out->length = READABLE_MAX] = '\0';
}

static int name_run(const struct naming *naming, struct experiment_run *run, struct error *err)
{
	struct text id = {0};

	add_readable(naming, run, &id);
	if (naming->experiment->repeat > 1)
		text_addf(&id, "_repeat-%d", run->repeat);
	text_addf(&id, "-%.*s", naming->experiment->digits, run->hash);
	run->id = id.data;
	return id.failed ? error_memory(err, id.length) : 0;
}

size_t run_name_find(const struct experiment *experiment, const char *name)
{
	static const char mark[] = "_repeat-";
	size_t length = strlen(name), digits = (size_t)experiment->digits, tail = digits + 1;
	const char *end = name + length - tail, *start;
	int repeat = 1;

	if (length <= tail || *end != '-' || strspn(end + 1, "0123456789abcdef") != digits)
		return experiment->run_count;
	start = end;
	while (start > name && isdigit((unsigned char)start[-1]))
		start--;
	if (start < end && start - name >= (long)strlen(mark) &&
		!strncmp(start - strlen(mark), mark, strlen(mark)))
		repeat = atoi(start); /* NOLINT(cert-err34-c): digits only; a huge one matches no repeat */
	return run_key_find(experiment, end + 1, repeat);
}

/* The folders that exist, by their names: an own id before any other, and the first of those. */
static int find_folders(struct experiment *experiment, struct error *err)
{
	struct dirent **entries = NULL;
	/* a folder that is not there, or cannot be read, has no runs yet */
	int count = scandir(experiment->folder, &entries, NULL, alphasort), result = 0;

	if (count < 0 && errno == ENOMEM)
		return error_memory(err, sizeof **entries);
	for (int i = 0; i < count; i++) {
		size_t index = run_name_find(experiment, entries[i]->d_name);
		struct experiment_run *run = &experiment->runs[index];

		if (!result && index < experiment->run_count &&
			(!run->folder || !strcmp(entries[i]->d_name, run->id))) {
			free(run->folder);
			if (asprintf(&run->folder, "%s/%s", experiment->folder, entries[i]->d_name) < 0) {
				run->folder = NULL;
				result = error_memory(err, strlen(experiment->folder));
			}
		}
		free(entries[i]);
	}
	free(entries);
	return result;
}

int experiment_name_runs(struct experiment *experiment, struct error *err)
{
	struct naming naming;
	int result = -1;

	if (naming_init(&naming, experiment, err) || run_key_sort(experiment, err))
		goto done;
	experiment->digits = run_key_digits(experiment, DIGITS);
	for (size_t i = 0; i < experiment->run_count; i++)
		if (name_run(&naming, &experiment->runs[i], err))
			goto done;
	if (find_folders(experiment, err))
		goto done;
	for (size_t i = 0; i < experiment->run_count; i++) {
		struct experiment_run *run = &experiment->runs[i];

		if (!run->folder && asprintf(&run->folder, "%s/%s", experiment->folder, run->id) < 0) {
			run->folder = NULL;
			error_memory(err, strlen(experiment->folder) + strlen(run->id));
			goto done;
		}
	}
	result = 0;
done:
	naming_clean(&naming);
	return result;
}

bool experiment_owns(const struct experiment *experiment, const char *name)
{
	return run_name_find(experiment, name) < experiment->run_count;
}
