/* talus verify: are these run files good? */
#include <dirent.h>
#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "run/run_file_parts.h"
#include "run/verify.h"

static const char help[] =
	"Check run files: their digest, times that grow, lengths that fit, mass that is conserved, and\n"
	"that what campaigns go by is what the file says.\n\n"
	"usage: talus verify PATH...\n"
	"example: talus verify results/granular-collapse\n\n"
	"PATH is a run file, a run folder, or a folder of run folders, as a campaign has it. Of a run\n"
	"both generations are checked, run.h5 and run.previous.h5; it goes on from the newest that is good.\n\n"
	"options:\n"
	"  -h, --help  print this\n\n"
	"exit: 0 all are good, 65 one is damaged or is no run file\n";

/* Run files, and those that are not good. */
struct verdict {
	size_t files, bad;
};

/* A line about one run file, and one for each thing that is wrong with its content. */
static int add_verdict(const char *path, struct text *out, bool *good, struct error *err)
{
	struct run_file *file = NULL;
	const struct run_summary *summary;
	const char *warning;
	struct error damage = {0};
	struct text breaches = {0};
	char message[sizeof damage.text + sizeof damage.file];
	int result = -1;

	*good = false;
	if (run_file_open(path, &file, &warning, &damage) != 0) {
		if (damage.code == EX_SOFTWARE)
			*err = damage;
		else
			result = 0;
		text_addf(out, "%s\n", error_format(&damage, message, sizeof message));
		goto done;
	}
	result = verify_run_file(file, &breaches, err);
	if (result != 0 && err->code == EX_DATAERR) {
		text_addf(&breaches, "%s\n", err->text);
		*err = (struct error){0};
		result = 0;
	}
	summary = run_file_summary(file);
	*good = breaches.length == 0;
	text_addf(out, "%s: %s, %s, %llu steps to t = %g s%s%s\n", path,
		*good ? "good" : "its content is wrong", run_status_name(summary->status),
		(unsigned long long)summary->step, summary->time, warning ? "; " : "",
		warning ? warning : "");
	text_add(out, text_string(&breaches));
done:
	run_file_close(file);
	text_clean(&breaches);
	return result;
}

/* Both generations of a run folder, those that exist, and which of them a run goes on from. */
static int add_folder(
	const char *folder, struct text *out, struct verdict *verdict, struct error *err)
{
	static const char *const names[] = {RUN_FILE_NEWEST, RUN_FILE_PREVIOUS};
	const char *newest = NULL;
	struct text path = {0};
	bool good = false;

	for (size_t i = 0; i < 2; i++) {
		if (file_path(&path, folder, names[i], err) != 0 ||
			(file_exists(text_string(&path)) &&
				add_verdict(text_string(&path), out, &good, err) != 0)) {
			text_clean(&path);
			return -1;
		}
		if (!file_exists(text_string(&path)))
			continue;
		verdict->files++;
		verdict->bad += !good;
		newest = good && !newest ? names[i] : newest;
	}
	if (newest)
		text_addf(out, "%s: %s is the newest good generation\n", folder, newest);
	else
		text_addf(out, "%s: no generation is good\n", folder);
	text_clean(&path);
	return 0;
}

static bool is_run_folder(const char *folder, struct error *err)
{
	static const char *const names[] = {RUN_FILE_NEWEST, RUN_FILE_PREVIOUS};
	struct text path = {0};
	bool found = false;

	for (size_t i = 0; i < 2 && !found; i++)
		found = file_path(&path, folder, names[i], err) == 0 && file_exists(text_string(&path));
	text_clean(&path);
	return found;
}

/* The run folders in `folder`, as a campaign has them. */
static int add_folders(
	const char *folder, struct text *out, struct verdict *verdict, struct error *err)
{
	struct dirent **entries = NULL;
	int count = scandir(folder, &entries, NULL, alphasort), result = 0;

	if (count < 0)
		return error_at(err, EX_DATAERR, folder, 0, 0, "cannot be read: %s", strerror(errno));
	for (int i = 0; i < count; i++) {
		struct text path = {0};

		if (!result && entries[i]->d_name[0] != '.') {
			result = file_path(&path, folder, entries[i]->d_name, err);
			if (!result && is_run_folder(text_string(&path), err))
				result = add_folder(text_string(&path), out, verdict, err);
			result = err->code ? -1 : result;
		}
		text_clean(&path);
		free(entries[i]);
	}
	free(entries);
	if (!result && !verdict->files)
		text_addf(out, "%s: holds no run file\n", folder);
	return result;
}

static int verify_path(const char *path)
{
	struct verdict verdict = {0};
	struct error err = {0};
	struct text out = {0};
	bool good = false;
	int code;

	if (!file_is_folder(path)) {
		(void)add_verdict(path, &out, &good, &err);
		verdict = (struct verdict){1, !good};
	} else if (is_run_folder(path, &err)) {
		(void)add_folder(path, &out, &verdict, &err);
	} else if (!err.code) {
		(void)add_folders(path, &out, &verdict, &err);
	}
	code = err.code ? command_fail(&err) : command_print(&out);
	text_clean(&out);
	return code ? code : verdict.files && !verdict.bad ? 0 : EX_DATAERR;
}

static int verify_main(int argc, char **argv)
{
	static const struct option list[] = {{"help", no_argument, NULL, 'h'}, {0}};
	struct text out = {0};
	int option, code = 0;

	while ((option = getopt_long(argc, argv, ":h", list, NULL)) != -1) {
		if (option != 'h')
			return command_option_error("verify", option, argv);
		text_add(&out, help);
		return command_print(&out);
	}
	if (optind == argc)
		return command_usage("verify", "no PATH given");
	for (int i = optind; i < argc; i++) {
		int result = verify_path(argv[i]);

		code = result ? result : code;
	}
	return code;
}

const struct command command_verify = {
	"verify", "check that run files are whole and make sense", verify_main};
