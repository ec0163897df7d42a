/* talus diff: do two runs hold the same bits? */
#include <getopt.h>

#include "cli/command.h"
#include "cli/commands.h"
#include "run/compare.h"
#include "run/run_file_parts.h"

static const char help[] =
	"Compare two runs bit by bit.\n\n"
	"usage: talus diff A B\n"
	"example: talus diff results/granular-collapse results/granular-collapse-again\n\n"
	"A and B are run folders or run files. Every dataset counts, the checkpoint included, but for\n"
	"those whose names begin with cpu_ or wall_. Indices count from 0.\n\n"
	"options:\n"
	"  -q, --quiet  print nothing, only exit (default: off)\n"
	"  -h, --help   print this\n\n"
	"exit: 0 the same bits, 1 different, 65 one is no good run file\n";

struct diff_options {
	bool quiet, help;
};

static int read_options(int argc, char **argv, struct diff_options *options)
{
	static const struct option list[] = {
		{"quiet", no_argument, NULL, 'q'},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	int option;

	while ((option = getopt_long(argc, argv, ":qh", list, NULL)) != -1) {
		if (option == ':' || option == '?')
			return command_option_error("diff", option, argv);
		options->quiet |= option == 'q';
		options->help |= option == 'h';
	}
	if (!options->help && argc - optind != 2)
		return command_usage("diff", "two runs are needed, and %d given", argc - optind);
	return 0;
}

static int compare(const char *a, const char *b, bool quiet)
{
	struct run_file *first = NULL, *second = NULL;
	struct error err = {0};
	struct text out = {0};
	int code;

	if (command_open_run(a, &first, &err) == 0 && command_open_run(b, &second, &err) == 0)
		(void)compare_run_files(first, second, &out, &err);
	run_file_close(first);
	run_file_close(second);
	if (err.code)
		code = command_fail(&err);
	else if (!out.length || quiet)
		code = out.length ? EX_FAILED : 0;
	else
		code = command_print(&out) ? EX_IOERR : EX_FAILED;
	text_clean(&out);
	return code;
}

static int diff_main(int argc, char **argv)
{
	struct diff_options options = {0};
	struct text out = {0};
	int code = read_options(argc, argv, &options);

	if (code != 0)
		return code;
	if (options.help) {
		text_add(&out, help);
		return command_print(&out);
	}
	return compare(argv[optind], argv[optind + 1], options.quiet);
}

const struct command command_diff = {"diff", "compare two runs bit by bit", diff_main};
