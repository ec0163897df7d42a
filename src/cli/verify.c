/* talus verify: are these run files good? */
#include <getopt.h>
#include <string.h>

#include "base/file.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "run/run_file_parts.h"
#include "run/verify.h"

static const char help[] =
	"Check run files: their digest, times that grow, lengths that fit, mass that is conserved.\n\n"
	"usage: talus verify PATH...\n"
	"example: talus verify results/granular-collapse\n\n"
	"PATH is a run file, or a run folder: then both generations are checked, run.h5 and\n"
	"run.previous.h5, and a run goes on from the newest that is good.\n\n"
	"options:\n"
	"  -h, --help  print this\n\n"
	"exit: 0 all are good, 65 one is damaged or is no run file\n";

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

/* Both generations of a folder, those that exist. */
static int add_folder(const char *folder, struct text *out, bool *good, struct error *err)
{
	static const char *const names[] = {RUN_FILE_NEWEST, RUN_FILE_PREVIOUS};
	struct text path = {0};
	bool all = true, any = false;
	int result = 0;

	for (size_t i = 0; i < 2 && result == 0; i++) {
		result = file_path(&path, folder, names[i], err);
		if (result != 0 || !file_exists(text_string(&path)))
			continue;
		result = add_verdict(text_string(&path), out, good, err);
		all &= *good;
		any = true;
	}
	if (!any)
		text_addf(out, "%s: holds no run file\n", folder);
	*good = all && any;
	text_clean(&path);
	return result;
}

static int verify_path(const char *path)
{
	struct error err = {0};
	struct text out = {0};
	bool good = false;
	int result = file_is_folder(path) ? add_folder(path, &out, &good, &err)
									  : add_verdict(path, &out, &good, &err);
	int code = result ? 0 : command_print(&out);

	text_clean(&out);
	if (result != 0)
		return command_fail(&err);
	return code ? code : good ? 0 : EX_DATAERR;
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
