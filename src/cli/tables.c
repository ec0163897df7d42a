/* talus tables, and the whole of talus-tables: finished run files -> tables. */
#include "talus/tables.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/commands.h"
#include "talus/experiment.h"

static const char help[] =
	"Print the tables of an experiment from its run files, published values beside ours.\n\n"
	"usage: talus-tables [OPTION]... EXPERIMENT\n"
	"       talus tables [OPTION]... EXPERIMENT\n"
	"example: talus-tables --format markdown experiments/quickstart.yaml\n\n"
	"options:\n"
	"  -f, --format NAME    text, markdown or csv (default: text)\n"
	"  -t, --table NAME     only this table; repeatable (default: all of the experiment)\n"
	"  -o, --output FOLDER  folder of the run folders (default: results/<name of EXPERIMENT>)\n"
	"  -s, --set KEY=VALUE  as given to `talus campaign run`; repeatable (default: none)\n"
	"  -h, --help           print this\n\n"
	"exit: 0 the tables are whole, 1 cells are missing (stderr names the runs), 65 bad "
	"experiment\n";

struct tables_options {
	struct command_settings settings, names;
	const char *experiment, *folder;
	const struct table_format *format;
	bool help;
};

static int read_format(const char *name, struct tables_options *options)
{
	struct text names = {0};

	options->format = table_format_find(name);
	if (options->format)
		return 0;
	table_format_names(&names);
	(void)command_usage("tables", "--format %s: known are %s", name, text_string(&names));
	text_clean(&names);
	return EX_USAGE;
}

static int read_option(int option, struct tables_options *options, char **argv)
{
	struct error err = {0};

	switch (option) {
	case 's':
		return command_settings_add(&options->settings, optarg, &err) ? command_fail(&err) : 0;
	case 't':
		return command_settings_add(&options->names, optarg, &err) ? command_fail(&err) : 0;
	case 'o':
		if (!*optarg)
			return command_usage("tables", "the folder of -o is empty");
		options->folder = optarg;
		return 0;
	case 'f':
		return read_format(optarg, options);
	case 'h':
		options->help = true;
		return 0;
	default:
		return command_option_error("tables", option, argv);
	}
}

static int read_options(int argc, char **argv, struct tables_options *options)
{
	static const struct option list[] = {
		{"format", required_argument, NULL, 'f'},
		{"table", required_argument, NULL, 't'},
		{"output", required_argument, NULL, 'o'},
		{"set", required_argument, NULL, 's'},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	int option, code;

	while ((option = getopt_long(argc, argv, ":f:t:o:s:h", list, NULL)) != -1) {
		code = read_option(option, options, argv);
		if (code)
			return code;
	}
	if (options->help)
		return 0;
	if (optind == argc)
		return command_usage("tables", "no EXPERIMENT given");
	if (optind + 1 < argc)
		return command_usage("tables", "one EXPERIMENT at a time, not also %s", argv[optind + 1]);
	options->experiment = argv[optind];
	return 0;
}

static bool is_asked(const struct tables_options *options, const char *name)
{
	for (int i = 0; i < options->names.count; i++)
		if (!strcmp(options->names.list[i], name))
			return true;
	return options->names.count == 0;
}

/* Every name of --table is a table of the experiment, and the format can hold them all. */
static int check_names(const struct tables_options *options, const struct experiment *experiment)
{
	size_t asked = 0;

	if (!experiment->table_count)
		return command_usage("tables", "%s asks for no table", experiment->path);
	for (int i = 0; i < options->names.count; i++) {
		size_t k = 0;

		while (k < experiment->table_count &&
			   strcmp(options->names.list[i], experiment->tables[k].name.text) != 0)
			k++;
		if (k == experiment->table_count)
			return command_usage(
				"tables", "%s has no table '%s'", experiment->path, options->names.list[i]);
	}
	for (size_t i = 0; i < experiment->table_count; i++)
		asked += is_asked(options, experiment->tables[i].name.text);
	if (options->format->single && asked > 1)
		return command_usage("tables",
			"--format %s holds one table and %s has %zu; choose with --table",
			options->format->name, experiment->path, asked);
	return 0;
}

static void add_option(struct text *command, const char *option, const char *value)
{
	text_addf(command, " %s ", option);
	text_add_word(command, value);
}

/* The command that prints this table again. */
static void write_command(
	const struct tables_options *options, const char *table, struct text *command)
{
	text_addf(
		command, "talus-tables %s", options->experiment && *options->experiment == '-' ? "./" : "");
	text_add_word(command, options->experiment);
	if (options->folder)
		add_option(command, "-o", options->folder);
	for (int i = 0; i < options->settings.count; i++)
		add_option(command, "--set", options->settings.list[i]);
	add_option(command, "--table", table);
}

/* One table to stdout and what it misses to stderr; EX_FAILED if that is anything. */
static int print_one(const struct tables_options *options, const struct experiment *experiment,
	const struct experiment_table *wanted, bool first)
{
	struct text command = {0}, out = {0};
	struct table table = {0};
	struct error err = {0};
	int code;

	write_command(options, wanted->name.text, &command);
	if (command.failed)
		(void)error_memory(&err, command.length);
	if (command.failed || table_build(&table, experiment, wanted, text_string(&command), &err)) {
		code = command_fail(&err);
	} else {
		text_add(&out, first ? "" : "\n");
		options->format->print(&table, &out);
		code = command_print(&out);
		if (table.missing.length)
			(void)fprintf(stderr, "%s", text_string(&table.missing));
		if (table.missing.length && !code)
			code = EX_FAILED;
	}
	table_clean(&table);
	text_clean(&command);
	return code;
}

static int print_tables(const struct tables_options *options)
{
	struct experiment experiment;
	struct error err = {0};
	bool first = true;
	int code, worst = 0;

	if (experiment_read(&experiment, options->experiment, options->folder, options->settings.list,
			options->settings.count, &err))
		code = command_fail(&err);
	else
		code = check_names(options, &experiment);
	for (size_t i = 0; !code && i < experiment.table_count; i++) {
		if (!is_asked(options, experiment.tables[i].name.text))
			continue;
		code = print_one(options, &experiment, &experiment.tables[i], first);
		first = false;
		if (code == EX_FAILED) { /* the other tables may be whole */
			worst = code;
			code = 0;
		}
	}
	experiment_clean(&experiment);
	return code ? code : worst;
}

static int tables_main(int argc, char **argv)
{
	struct tables_options options = {.format = table_format_find("text")};
	struct text out = {0};
	int code = read_options(argc, argv, &options);

	if (code == 0 && options.help) {
		text_add(&out, help);
		code = command_print(&out);
	} else if (code == 0) {
		code = print_tables(&options);
	}
	command_settings_clean(&options.settings);
	command_settings_clean(&options.names);
	return code;
}

const struct command command_tables = {
	"tables", "print the tables of an experiment from its run files", tables_main};
