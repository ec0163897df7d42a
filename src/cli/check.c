/* talus check: is a config right, and what does it say in full? */
#include <getopt.h>
#include <stdbool.h>

#include "case/initial.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "talus/config.h"

static const char help[] =
	"Check configs and print what they say in full, in SI units.\n\n"
	"usage: talus check [--set KEY=VALUE]... FILE...\n"
	"       talus check --reference[=MODEL]\n"
	"example: talus check --set layers=20 configs/granular-collapse.yaml\n\n"
	"options:\n"
	"  -s, --set KEY=VALUE  override a key of every FILE, such as time.cfl=0.5; repeatable\n"
	"                       (default: none)\n"
	"  -q, --quiet          print nothing of what is right (default: off)\n"
	"  -r, --reference[=MODEL]\n"
	"                       print every key of MODEL, dry (default) or immersed, with its\n"
	"                       default, unit, range and meaning, and read no FILE (default: off)\n"
	"  -h, --help           print this\n\n"
	"exit: 0 all are right, 65 one is wrong (the message tells file, line and column)\n";

struct check_options {
	struct command_settings settings;
	const char *reference; /* a model; NULL: none */
	bool quiet, help;
};

static int read_options(int argc, char **argv, struct check_options *options)
{
	static const struct option list[] = {
		{"set", required_argument, NULL, 's'},
		{"quiet", no_argument, NULL, 'q'},
		{"reference", optional_argument, NULL, 'r'},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	struct error err = {0};
	int option;

	while ((option = getopt_long(argc, argv, ":s:qr::h", list, NULL)) != -1) {
		if (option == 's' && command_settings_add(&options->settings, optarg, &err) != 0)
			return command_fail(&err);
		if (option == ':' || option == '?')
			return command_option_error("check", option, argv);
		options->quiet |= option == 'q';
		if (option == 'r')
			options->reference = optarg ? optarg : "dry";
		options->help |= option == 'h';
	}
	if (options->help)
		return 0;
	if (options->reference && (options->settings.count > 0 || optind < argc))
		return command_usage("check", "--reference takes neither --set nor FILE");
	if (!options->reference && optind == argc)
		return command_usage("check", "no FILE given");
	return 0;
}

/* Several files make several YAML documents. */
static int check_file(const char *path, const struct check_options *options, bool several)
{
	struct config config;
	struct error err = {0};
	struct text out = {0};

	if (config_read(&config, path, options->settings.list, options->settings.count, &err) != 0)
		return command_config_fail(path, &err);
	if (config.model == MODEL_DRY && initial_check(&config, &err) != 0) {
		(void)error_context(&err, "%s", path);
		return command_fail(&err);
	}
	if (options->quiet)
		return 0;
	if (several)
		text_addf(&out, "--- # %s\n", path);
	config_print(&config, &out);
	return command_print(&out);
}

static int check_main(int argc, char **argv)
{
	struct check_options options = {0};
	struct error err = {0};
	struct text out = {0};
	int code = read_options(argc, argv, &options);

	if (code == 0 && options.help) {
		text_add(&out, help);
		code = command_print(&out);
	} else if (code == 0 && options.reference) {
		code = config_print_reference(options.reference, &out, &err) ? command_fail(&err)
																	 : command_print(&out);
	} else if (code == 0) {
		for (int i = optind; i < argc && (code == 0 || code == EX_DATAERR); i++) {
			int result = check_file(argv[i], &options, argc - optind > 1);

			code = result ? result : code;
		}
	}
	command_settings_clean(&options.settings);
	return code;
}

const struct command command_check = {
	"check", "check configs and print them in full, in SI units", check_main};
