/* The names of runs: what a person reads, and the digits of the hash by which a run is found. */
#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/expand.h"
#include "talus/text.h"

enum {
	READABLE_MAX = 150, /* bytes of a name before repeat and hash; file systems take 255 in all */
	DIGITS = 8          /* of the hash, more where two runs of the experiment begin alike */
};

static const struct setting *find_setting(const struct experiment_run *run, const char *key)
{
	for (size_t i = 0; i < run->settings.count; i++)
		if (!strcmp(run->settings.items[i].key, key))
			return &run->settings.items[i];
	return NULL;
}

/* Does the value of `key` differ between the runs, or is it absent from some? */
static bool varies(const struct experiment *experiment, const char *key)
{
	const struct setting *first = find_setting(&experiment->runs[0], key);

	for (size_t i = 1; i < experiment->run_count; i++) {
		const struct setting *other = find_setting(&experiment->runs[i], key);

		if (!first != !other || (first && strcmp(first->value, other->value) != 0))
			return true;
	}
	return false;
}

static const char *last_part(const char *key)
{
	const char *dot = strrchr(key, '.');

	return dot ? dot + 1 : key;
}

/* The last part of a dotted key, or all of it where two keys of the run end alike. */
static const char *short_key(const struct experiment_run *run, const char *key)
{
	for (size_t i = 0; i < run->settings.count; i++) {
		const char *other = run->settings.items[i].key;

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

static void add_readable(
	const struct experiment *experiment, const struct experiment_run *run, struct text *out)
{
	for (size_t i = 0; i < run->settings.count; i++) {
		const struct setting *setting = &run->settings.items[i];

		if (!varies(experiment, setting->key))
			continue;
		text_addf(out, "%s%s-", out->length ? "_" : "", short_key(run, setting->key));
		add_safe(out, setting->value);
	}
	if (!out->length)
		text_add(out, "base");
	if (out->length > READABLE_MAX)
		out->data[out->length = READABLE_MAX] = '\0';
}

static int name_run(
	const struct experiment *experiment, struct experiment_run *run, int digits, struct error *err)
{
	struct text id = {0};

	add_readable(experiment, run, &id);
	if (experiment->repeat > 1)
		text_addf(&id, "_repeat-%d", run->repeat);
	text_addf(&id, "-%.*s", digits, run->hash);
	run->id = id.data;
	return id.failed ? error_memory(err, id.length) : 0;
}

/* Enough digits of the hash to tell the runs apart. */
static int digits_needed(const struct experiment *experiment)
{
	for (size_t i = 0; i < experiment->run_count; i++)
		for (size_t k = 0; k < i; k++)
			if (!strncmp(experiment->runs[i].hash, experiment->runs[k].hash, DIGITS) &&
				strcmp(experiment->runs[i].hash, experiment->runs[k].hash) != 0)
				return CONFIG_HASH_SIZE - 1;
	return DIGITS;
}

/* Is `name` that of a folder for this run, whatever it begins with? No `_repeat-K` is the first. */
static bool name_belongs(const char *name, const struct experiment_run *run, int digits)
{
	static const char mark[] = "_repeat-";
	size_t length = strlen(name), tail = (size_t)digits + 1;
	const char *end = name + length - tail, *start;
	int repeat = 1;

	if (length <= tail || *end != '-' || strncmp(end + 1, run->hash, (size_t)digits) != 0)
		return false;
	start = end;
	while (start > name && isdigit((unsigned char)start[-1]))
		start--;
	if (start < end && start - name >= (long)strlen(mark) &&
		!strncmp(start - strlen(mark), mark, strlen(mark)))
		repeat = atoi(start); /* NOLINT(cert-err34-c): digits only; a huge one matches no repeat */
	return repeat == run->repeat;
}

/* The name of an existing folder of this run: its own id if that exists, else the first in order. */
static const char *find_folder(
	struct dirent **entries, int count, const struct experiment_run *run, int digits)
{
	const char *found = NULL;

	for (int i = 0; i < count; i++) {
		const char *name = entries[i]->d_name;

		if (!strcmp(name, run->id))
			return name;
		if (!found && name_belongs(name, run, digits))
			found = name;
	}
	return found;
}

int experiment_name_runs(struct experiment *experiment, struct error *err)
{
	struct dirent **entries = NULL;
	int digits = digits_needed(experiment), count, result = -1;

	/* a folder that is not there, or cannot be read, has no runs yet */
	count = scandir(experiment->folder, &entries, NULL, alphasort);
	for (size_t i = 0; i < experiment->run_count; i++) {
		struct experiment_run *run = &experiment->runs[i];
		const char *name;

		if (name_run(experiment, run, digits, err))
			goto done;
		name = find_folder(entries, count, run, digits);
		if (asprintf(&run->folder, "%s/%s", experiment->folder, name ? name : run->id) < 0) {
			run->folder = NULL;
			error_memory(err, strlen(experiment->folder) + strlen(run->id));
			goto done;
		}
	}
	result = 0;
done:
	for (int i = 0; i < count; i++)
		free(entries[i]);
	free(entries);
	return result;
}
