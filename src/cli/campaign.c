/* talus campaign: bring the runs of an experiment to their end, and tell how they are. */
#include "cli/campaign.h"

#include <getopt.h>
#include <string.h>

#include "cli/commands.h"
#include "talus/tables.h"

static const char help[] =
	"Run an experiment: every run in a process of its own, resumed where it was stopped.\n\n"
	"usage: talus campaign run [OPTION]... EXPERIMENT\n"
	"       talus campaign status [OPTION]... EXPERIMENT\n"
	"example: talus campaign run -j 2 experiments/quickstart.yaml\n\n"
	"options:\n"
	"  -o, --output FOLDER  folder of the run folders (default: results/<name of EXPERIMENT>)\n"
	"  -s, --set KEY=VALUE  override a config key of every run; repeatable (default: none)\n"
	"  -h, --help           print this\n\n"
	"options of run:\n"
	"  -j, --jobs N         runs at a time; an experiment with `timing: true` makes it 1\n"
	"                       (default: the number of processors; slurm: that of the experiment)\n"
	"  -n, --dry-run        print what would be done and change nothing (default: off)\n"
	"  -r, --retry          start failed runs anew (default: off)\n"
	"  -e, --executor NAME  how runs are executed: local, as processes of this machine, or slurm,\n"
	"                       as job arrays of a cluster (default: local)\n\n"
	"options of status:\n"
	"      --json           print JSON (default: a table)\n\n"
	"Ctrl-C stops all runs with their checkpoints written; the same command goes on from there.\n\n"
	"exit: 0 all runs are complete or in a queue, 1 one failed, 65 bad experiment, 69 Slurm is "
	"not\n"
	"there or refuses, 75 stopped and resumable\n";

enum { OPTION_JSON = 256 };

static int read_jobs(const char *text, int *jobs)
{
	if (!text_to_integer(text, jobs) || *jobs < 1 || *jobs > 4096)
		return command_usage("campaign", "-j %s: a whole number from 1 to 4096 is wanted", text);
	return 0;
}

static int read_option(int option, struct campaign_arguments *arguments, char **argv)
{
	struct error err = {0};

	switch (option) {
	case 's':
		return command_settings_add(&arguments->settings, optarg, &err) ? command_fail(&err) : 0;
	case 'o':
		if (!*optarg)
			return command_usage("campaign", "the folder of -o is empty");
		arguments->folder = optarg;
		return 0;
	case 'e':
		arguments->executor = optarg;
		return 0;
	case 'j':
		return read_jobs(optarg, &arguments->options.jobs);
	case 'n':
		arguments->dry_run = true;
		return 0;
	case 'r':
		arguments->options.retry = true;
		return 0;
	case OPTION_JSON:
		arguments->json = true;
		return 0;
	case 'h':
		arguments->help = true;
		return 0;
	default:
		return command_option_error("campaign", option, argv);
	}
}

static int read_options(int argc, char **argv, struct campaign_arguments *arguments)
{
	static const struct option list[] = {
		{"set", required_argument, NULL, 's'},
		{"output", required_argument, NULL, 'o'},
		{"executor", required_argument, NULL, 'e'},
		{"jobs", required_argument, NULL, 'j'},
		{"dry-run", no_argument, NULL, 'n'},
		{"retry", no_argument, NULL, 'r'},
		{"json", no_argument, NULL, OPTION_JSON},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	int option, code;

	while ((option = getopt_long(argc, argv, ":s:o:e:j:nrh", list, NULL)) != -1) {
		code = read_option(option, arguments, argv);
		if (code)
			return code;
	}
	if (arguments->help)
		return 0;
	if (optind == argc)
		return command_usage("campaign", "no EXPERIMENT given");
	if (optind + 1 < argc)
		return command_usage("campaign", "one EXPERIMENT at a time, not also %s", argv[optind + 1]);
	arguments->experiment = argv[optind];
	return 0;
}

static const struct action {
	const char *name;
	int (*main)(const struct campaign_arguments *arguments, const struct experiment *experiment);
} actions[] = {
	{"run", campaign_run_main},
	{"status", campaign_status_main},
};

static const struct action *find_action(const char *name)
{
	for (size_t i = 0; i < sizeof actions / sizeof *actions; i++)
		if (!strcmp(name, actions[i].name))
			return &actions[i];
	return NULL;
}

/* A table that could never be built is refused before hours of computing. */
static int act(const struct action *action, const struct campaign_arguments *arguments)
{
	struct experiment experiment;
	struct error err = {0};
	int code;

	if (experiment_read(&experiment, arguments->experiment, arguments->folder,
			arguments->settings.list, arguments->settings.count, &err) ||
		table_check(&experiment, &err))
		code = command_fail(&err);
	else
		code = action->main(arguments, &experiment);
	experiment_clean(&experiment);
	return code;
}

static int campaign_main(int argc, char **argv)
{
	struct campaign_arguments arguments = {.executor = "local"};
	const struct action *action = NULL;
	struct text out = {0};
	int code;

	if (argc < 2)
		return command_usage("campaign", "run or status?");
	if (argv[1][0] != '-') {
		action = find_action(argv[1]);
		if (!action)
			return command_usage("campaign", "unknown action '%s'", argv[1]);
		argc--;
		argv++;
	}
	code = read_options(argc, argv, &arguments);
	if (code == 0 && arguments.help) {
		text_add(&out, help);
		code = command_print(&out);
	} else if (code == 0 && !action) {
		code = command_usage("campaign", "run or status?");
	} else if (code == 0) {
		code = act(action, &arguments);
	}
	command_settings_clean(&arguments.settings);
	return code;
}

const struct command command_campaign = {
	"campaign", "run the experiments of a file, and tell how they are", campaign_main};
