#include "campaign/leftover.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/lock.h"
#include "campaign/beginning.h"
#include "campaign/expand.h"

/* What a run writes into its folder, the lock last: as long as that is there, nobody else begins. */
static const char *const patterns[] = {"run.h5", "run.previous.h5", "run.end-*.h5",
	"run.damaged.h5", "run.previous.damaged.h5", "run.log", "status.yaml", "*.tmp",
	"config.[0-9]*.yaml", "config.yaml", "run.lock"};

static bool is_ours(const char *name)
{
	for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
		if (fnmatch(patterns[i], name, FNM_NOESCAPE) == 0)
			return true;
	return false;
}

/* Whether the folder holds only regular files of a run, and how many bytes. */
static bool is_run_folder(const char *folder, double *bytes, struct error *err)
{
	struct dirent **entries = NULL;
	struct stat st;
	int fd = open(folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
	int count = fd < 0 ? -1 : scandir(folder, &entries, NULL, NULL);
	bool good = count >= 0;

	if (fd >= 0 && count < 0 && errno == ENOMEM)
		error_memory(err, sizeof **entries);
	*bytes = 0;
	for (int i = 0; i < count; i++) {
		const char *name = entries[i]->d_name;

		if (strcmp(name, ".") != 0 && strcmp(name, "..") != 0) {
			good = good && is_ours(name) && fstatat(fd, name, &st, AT_SYMLINK_NOFOLLOW) == 0 &&
				   S_ISREG(st.st_mode);
			*bytes += good ? (double)st.st_size : 0;
		}
		free(entries[i]);
	}
	free(entries);
	if (fd >= 0)
		(void)close(fd);
	return good;
}

/* Whether the name ends with digits of the hash of the config that lies in the folder. */
static bool has_its_hash(
	const char *folder, const char *name, struct config *config, struct error *err)
{
	const char *digits = strrchr(name, '-');
	struct text path = {0};
	struct error unreadable = {0};
	char hash[CONFIG_HASH_SIZE];
	bool good = digits && (strlen(digits + 1) == 8 || strlen(digits + 1) == CONFIG_HASH_SIZE - 1);

	good = good && file_path(&path, folder, "config.yaml", &unreadable) == 0 &&
		   config_read(config, text_string(&path), NULL, 0, &unreadable) == 0 &&
		   config_hash(config, hash, &unreadable) == 0;
	if (good)
		hash[strlen(digits + 1)] = '\0';
	good = good && !strcmp(hash, digits + 1);
	if (unreadable.code == EX_SOFTWARE)
		*err = unreadable;
	text_clean(&path);
	return good;
}

static bool is_owned(const struct experiment *experiments, size_t count, const char *name)
{
	for (size_t i = 0; i < count; i++)
		if (experiment_owns(&experiments[i], name))
			return true;
	return false;
}

/* Does a run that is not complete yet begin with this one? */
static int is_beginning(const struct experiment *experiments, size_t count,
	const struct config *config, bool *is, struct error *err)
{
	char hash[CONFIG_HASH_SIZE], other[CONFIG_HASH_SIZE];
	struct run_report report;

	*is = false;
	TRY(beginning_hash(config, hash, err));
	for (size_t e = 0; e < count; e++)
		for (size_t i = 0; i < experiments[e].run_count && !*is; i++) {
			const struct experiment_run *run = &experiments[e].runs[i];

			if (run->config.time.end <= config->time.end || run->config.layers != config->layers)
				continue; /* most differ by this, which costs nothing to see */
			TRY(beginning_hash(&run->config, other, err));
			if (strcmp(hash, other) != 0)
				continue;
			run_report_read(run->folder, &report);
			if (report.unknown)
				return error_memory(err, sizeof report);
			*is = report.state != RUN_STATE_COMPLETE;
		}
	return 0;
}

static int add(const struct experiment *experiments, size_t count, const char *name,
	struct leftover_list *out, struct error *err)
{
	struct leftover leftover = {0}, *items;
	struct config config;
	bool beginning = false;

	if (asprintf(&leftover.folder, "%s/%s", experiments[0].folder, name) < 0)
		return error_memory(err, strlen(name));
	if (!is_run_folder(leftover.folder, &leftover.bytes, err) ||
		!has_its_hash(leftover.folder, name, &config, err)) {
		free(leftover.folder);
		return err->code ? -1 : 0;
	}
	items = realloc(out->items, (out->count + 1) * sizeof *items);
	run_report_read(leftover.folder, &leftover.report);
	if (!items || leftover.report.unknown ||
		is_beginning(experiments, count, &config, &beginning, err)) {
		free(leftover.folder);
		out->items = items ? items : out->items;
		return err->code ? -1 : error_memory(err, (out->count + 1) * sizeof *items);
	}
	out->items = items;
	if (leftover.report.state == RUN_STATE_RUNNING)
		leftover.kept = "a process works on it";
	else if (beginning && leftover.report.state != RUN_STATE_FAILED)
		leftover.kept = "a run with a later time.end goes on from it";
	items[out->count++] = leftover;
	return 0;
}

int leftover_list_read(const struct experiment *experiments, size_t count,
	struct leftover_list *out, struct error *err)
{
	struct dirent **entries = NULL;
	int found, result = 0;

	*out = (struct leftover_list){0};
	found = scandir(experiments[0].folder, &entries, NULL, alphasort);
	if (found < 0 && errno == ENOMEM)
		return error_memory(err, sizeof **entries);
	for (int i = 0; i < found; i++) {
		const char *name = entries[i]->d_name;

		if (!result && name[0] != '.' && !is_owned(experiments, count, name))
			result = add(experiments, count, name, out, err);
		free(entries[i]);
	}
	free(entries);
	return result;
}

void leftover_list_clean(struct leftover_list *list)
{
	for (size_t i = 0; i < list->count; i++)
		free(list->items[i].folder);
	free(list->items);
	*list = (struct leftover_list){0};
}

/* Unlink the files of a run in the folder `fd`, those of `pattern` alone. */
static int unlink_files(
	int fd, const struct leftover *leftover, const char *pattern, struct error *err)
{
	struct dirent **entries = NULL;
	int count = scandir(leftover->folder, &entries, NULL, NULL), result = 0;

	if (count < 0 && errno == ENOMEM)
		return error_memory(err, sizeof **entries);
	for (int i = 0; i < count; i++) {
		const char *name = entries[i]->d_name;

		if (!result && fnmatch(pattern, name, FNM_NOESCAPE) == 0 && unlinkat(fd, name, 0) != 0 &&
			errno != ENOENT)
			result = error_at(err, EX_IOERR, leftover->folder, 0, 0, "cannot remove %s: %s", name,
				strerror(errno));
		free(entries[i]);
	}
	free(entries);
	return result;
}

int leftover_remove(const struct leftover *leftover, struct error *err)
{
	struct text path = {0};
	struct lock lock = {-1};
	int fd = open(leftover->folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC), result = -1;

	if (fd < 0) {
		error_at(err, EX_IOERR, leftover->folder, 0, 0, "cannot be opened: %s", strerror(errno));
		goto done;
	}
	if (file_path(&path, leftover->folder, "run.lock", err) ||
		lock_take(&lock, text_string(&path), err))
		goto done;
	for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
		if (unlink_files(fd, leftover, patterns[i], err))
			goto done;
	if (rmdir(leftover->folder) != 0)
		error_at(err, EX_IOERR, leftover->folder, 0, 0, "cannot be removed: %s", strerror(errno));
	else
		result = 0;
done:
	lock_release(&lock);
	if (fd >= 0)
		(void)close(fd);
	text_clean(&path);
	return result;
}
