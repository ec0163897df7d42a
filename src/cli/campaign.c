/* talus campaign: bring the runs of an experiment to their end, and tell how they are. */
#include "cli/campaign.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/commands.h"
#include "config/quantity.h"
#include "talus/plots.h"
#include "talus/tables.h"

static const struct campaign_action *const actions[] = {&campaign_action_run,
	&campaign_action_status, &campaign_action_watch, &campaign_action_why, &campaign_action_retry,
	&campaign_action_cancel, &campaign_action_prune, NULL};

static void print_help(const struct campaign_action *action, struct text *out)
{
	if (action) {
		text_addf(out, "%s\n\nusage: talus campaign %s %s\n%s", action->summary, action->name,
			action->usage, action->help);
		return;
	}
	text_add(out,
		"Run an experiment: every run in a process of its own, resumed where it was stopped.\n\n"
		"usage: talus campaign ACTION [OPTION]... EXPERIMENT\n"
		"example: talus campaign run -j 2 experiments/quickstart.yaml\n\n"
		"actions:\n");
	for (size_t i = 0; actions[i]; i++)
		text_addf(out, "  %-8s %s\n", actions[i]->name, actions[i]->summary);
	text_add(out,
		"\n"
		"`talus campaign ACTION --help` has the options; `talus tables --reference` the keys of\n"
		"an experiment.\n\n"
		"exit: 0 done, 1 a run failed, 64 wrong usage, 65 bad experiment, 75 stopped and resumable\n");
}

static const char common[] = ":s:o:h"; /* ':' first: see command_option_error */

/* Letters without a short option. */
enum { OPTION_JSON = 'J', OPTION_ORDER = 'O' };

static int read_count(const char *option, const char *text, int min, int max, int *count)
{
	if (!text_to_integer(text, count) || *count < min || *count > max)
		return command_usage(
			"campaign", "%s %s: a whole number from %d to %d is wanted", option, text, min, max);
	return 0;
}

/* "90 s", "2 h"; a bare number is seconds. */
static int read_span(const char *option, const char *text, double *seconds)
{
	struct error err = {0};

	if (quantity_read(text, "s", seconds, &err) || !(*seconds > 0))
		return command_usage("campaign", "%s %s: a time above 0 such as 90 s or 2 h is wanted%s%s",
			option, text, err.code ? ": " : "", err.text);
	return 0;
}

static int read_order(const char *text, struct campaign_options *options)
{
	options->in_order = !strcmp(text, "given");
	if (!options->in_order && strcmp(text, "longest") != 0)
		return command_usage("campaign", "--order %s: longest or given is wanted", text);
	return 0;
}

static int read_option(int option, struct campaign_arguments *arguments, char **argv)
{
	struct campaign_options *options = &arguments->options;
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
		return read_count("-j", optarg, 1, 4096, &options->jobs);
	case 'r':
		return read_count("--retry", optarg, 0, 1000, &options->retry);
	case 'm':
		return read_count("--max-failures", optarg, 1, EXPERIMENT_RUNS_MAX, &options->max_failures);
	case 't':
		return read_span("--timeout", optarg, &options->timeout);
	case 'i':
		return read_span("--interval", optarg, &arguments->every);
	case OPTION_ORDER:
		return read_order(optarg, options);
	case 'n':
		arguments->dry_run = true;
		return 0;
	case 'a':
		arguments->all = true;
		return 0;
	case 'y':
		arguments->yes = true;
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

static const char *option_name(const struct option *list, int letter)
{
	while (list->val != letter)
		list++;
	return list->name;
}

static int read_options(int argc, char **argv, const struct campaign_action *action,
	struct campaign_arguments *arguments)
{
	static const struct option list[] = {
		{"set", required_argument, NULL, 's'},
		{"output", required_argument, NULL, 'o'},
		{"executor", required_argument, NULL, 'e'},
		{"jobs", required_argument, NULL, 'j'},
		{"dry-run", no_argument, NULL, 'n'},
		{"retry", required_argument, NULL, 'r'},
		{"timeout", required_argument, NULL, 't'},
		{"max-failures", required_argument, NULL, 'm'},
		{"order", required_argument, NULL, OPTION_ORDER},
		{"interval", required_argument, NULL, 'i'},
		{"all", no_argument, NULL, 'a'},
		{"yes", no_argument, NULL, 'y'},
		{"json", no_argument, NULL, OPTION_JSON},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	int option, code;

	while ((option = getopt_long(argc, argv, ":s:o:e:j:nr:t:m:i:ayh", list, NULL)) != -1) {
		if (action && option != ':' && option != '?' && !strchr(common, option) &&
			!strchr(action->options, option))
			return command_usage(
				"campaign", "%s takes no option --%s", action->name, option_name(list, option));
		code = read_option(option, arguments, argv);
		if (code)
			return code;
	}
	if (arguments->help || !action)
		return 0;
	if (optind == argc)
		return command_usage("campaign", "no EXPERIMENT given");
	if (optind + 1 < argc && !action->names)
		return command_usage("campaign", "one EXPERIMENT at a time, not also %s", argv[optind + 1]);
	arguments->experiment = argv[optind];
	arguments->names = argv + optind + 1;
	arguments->name_count = argc - optind - 1;
	return 0;
}

static const struct campaign_action *find_action(const char *name)
{
	for (size_t i = 0; actions[i]; i++)
		if (!strcmp(name, actions[i]->name))
			return actions[i];
	return NULL;
}

/* A table that could never be built is refused before hours of computing. */
static int act(const struct campaign_action *action, const struct campaign_arguments *arguments)
{
	struct experiment experiment;
	struct error err = {0};
	int code;

	if (experiment_read(&experiment, arguments->experiment, arguments->folder,
			arguments->settings.list, arguments->settings.count, &err) ||
		table_check(&experiment, &err) || plots_check(&experiment, &err))
		code = command_fail(&err);
	else
		code = action->main(arguments, &experiment);
	experiment_clean(&experiment);
	return code;
}

static int campaign_main(int argc, char **argv)
{
	static const char which[] = "run, status, watch, why, retry, cancel or prune?";
	struct campaign_arguments arguments = {.executor = "local", .every = 1};
	const struct campaign_action *action = NULL;
	struct text out = {0};
	int code;

	if (argc < 2)
		return command_usage("campaign", "%s", which);
	if (argv[1][0] != '-') {
		action = find_action(argv[1]);
		if (!action)
			return command_usage("campaign", "unknown action '%s'; %s", argv[1], which);
		argc--;
		argv++;
	}
	code = read_options(argc, argv, action, &arguments);
	if (code == 0 && arguments.help) {
		print_help(action, &out);
		code = command_print(&out);
	} else if (code == 0 && !action) {
		code = command_usage("campaign", "%s", which);
	} else if (code == 0) {
		code = act(action, &arguments);
	}
	command_settings_clean(&arguments.settings);
	return code;
}

void campaign_screen(int fd, int *columns, int *rows)
{
	struct winsize size = {0};

	*columns = *rows = 0;
	if (!isatty(fd) || ioctl(fd, TIOCGWINSZ, &size) != 0)
		return;
	*columns = size.ws_col;
	*rows = size.ws_row;
}

char *campaign_short_name(const char *name, int width, char buffer[256])
{
	int length = (int)strlen(name), tail = 12;

	if (width <= 0 || length <= width || width < tail + 4)
		(void)snprintf(buffer, 256, "%s", name);
	else
		(void)snprintf(buffer, 256, "%.*s...%s", width - tail - 3, name, name + length - tail);
	return buffer;
}

double campaign_progress(const struct experiment_run *run, const struct run_report *report)
{
	if (report->state == RUN_STATE_COMPLETE)
		return 1;
	return run->config.time.end > 0 ? fmin(report->time / run->config.time.end, 1) : 0;
}

void campaign_add_queue(const struct queue_entry *entry, struct text *out)
{
	if (!entry->job[0])
		return;
	text_addf(out, "%s %s", entry->state, entry->job);
	if (entry->reason[0] && strcmp(entry->reason, "None") != 0)
		text_addf(out, " (%s)", entry->reason);
}

/* A word as a shell takes it. */
static void add_word(struct text *out, const char *word)
{
	if (word[strspn(word,
			"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=,:+-")] == '\0' &&
		*word) {
		text_addf(out, " %s", word);
		return;
	}
	text_add(out, " '");
	for (; *word; word++)
		text_addf(out, *word == '\'' ? "'\\''" : "%c", *word);
	text_add(out, "'");
}

void campaign_command(
	const struct campaign_arguments *arguments, const char *action, struct text *out)
{
	text_addf(out, "talus campaign %s", action);
	if (arguments->folder) {
		text_add(out, " -o");
		add_word(out, arguments->folder);
	}
	for (int i = 0; i < arguments->settings.count; i++) {
		text_add(out, " -s");
		add_word(out, arguments->settings.list[i]);
	}
	add_word(out, arguments->experiment);
}

const struct command command_campaign = {
	"campaign", "run the experiments of a file, and tell how they are", campaign_main};
