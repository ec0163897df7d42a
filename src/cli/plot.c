/* talus plot: runs and experiments -> figures. */
#include "talus/plots.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "talus/experiment.h"

static const char help[] =
	"Draw runs, or the figures of an experiment, as SVG, PNG and PDF through gnuplot.\n\n"
	"usage: talus plot [OPTION]... RUN...\n"
	"       talus plot [OPTION]... EXPERIMENT\n"
	"example: talus plot results/granular-collapse\n\n"
	"RUN is a run folder or a run file (.h5); several are drawn together. EXPERIMENT is a YAML file.\n\n"
	"options:\n"
	"  -d, --dimensionless  of RUNs: lengths over h_0, times over tau_c, velocities over v_0 (P1)\n"
	"                       (default: SI units)\n"
	"  -f, --format NAMES   svg, png and pdf, those wanted with commas between (default: all three)\n"
	"  -o, --output FOLDER  where the figures go (default: RUN/figures of the first run, or\n"
	"                       results/<name of EXPERIMENT>/figures)\n"
	"  -p, --plot NAME      only this figure of the experiment; repeatable (default: all)\n"
	"  -r, --runs FOLDER    folder of the run folders (default: results/<name of EXPERIMENT>)\n"
	"  -s, --set KEY=VALUE  as given to `talus campaign run`; repeatable (default: none)\n"
	"  -h, --help           print this\n\n"
	"exit: 0 the figures are whole, 1 something is missing in them (stderr names it), 65 bad run or\n"
	"experiment, 69 gnuplot is missing, 73 and 74 the figures cannot be written\n";

struct plot_options {
	struct command_settings settings, names;
	const char *folder, *runs;
	unsigned formats;
	bool dimensionless, help;
};

static int read_formats(const char *names, struct plot_options *options)
{
	options->formats = 0;
	for (const char *at = names;;) {
		size_t length = strcspn(at, ",");
		char *name = strndup(at, length);
		unsigned format = name ? plots_format_find(name) : 0;
		struct error err = {0};

		if (!name) {
			error_memory(&err, length);
			return command_fail(&err);
		}
		if (!format) {
			(void)command_usage("plot", "--format %s: known are svg, png and pdf", name);
			free(name);
			return EX_USAGE;
		}
		free(name);
		options->formats |= format;
		if (!at[length])
			return 0;
		at += length + 1;
	}
}

static int read_folder(const char *option, const char **folder)
{
	if (!*optarg)
		return command_usage("plot", "the folder of %s is empty", option);
	*folder = optarg;
	return 0;
}

static int read_option(int option, struct plot_options *options, char **argv)
{
	struct error err = {0};

	switch (option) {
	case 's':
		return command_settings_add(&options->settings, optarg, &err) ? command_fail(&err) : 0;
	case 'p':
		return command_settings_add(&options->names, optarg, &err) ? command_fail(&err) : 0;
	case 'o':
		return read_folder("-o", &options->folder);
	case 'r':
		return read_folder("-r", &options->runs);
	case 'f':
		return read_formats(optarg, options);
	case 'd':
		options->dimensionless = true;
		return 0;
	case 'h':
		options->help = true;
		return 0;
	default:
		return command_option_error("plot", option, argv);
	}
}

static int read_options(int argc, char **argv, struct plot_options *options)
{
	static const struct option list[] = {
		{"dimensionless", no_argument, NULL, 'd'},
		{"format", required_argument, NULL, 'f'},
		{"output", required_argument, NULL, 'o'},
		{"plot", required_argument, NULL, 'p'},
		{"runs", required_argument, NULL, 'r'},
		{"set", required_argument, NULL, 's'},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	int option, code;

	while ((option = getopt_long(argc, argv, ":df:o:p:r:s:h", list, NULL)) != -1) {
		code = read_option(option, options, argv);
		if (code)
			return code;
	}
	if (!options->help && optind == argc)
		return command_usage("plot", "no RUN or EXPERIMENT given");
	return 0;
}

static int check_names(const struct plot_options *options, const struct experiment *experiment)
{
	if (!experiment->plot_count)
		return command_usage("plot", "%s asks for no plot", experiment->path);
	for (int i = 0; i < options->names.count; i++) {
		size_t k = 0;

		while (k < experiment->plot_count &&
			   strcmp(options->names.list[i], experiment->plots[k].name.text) != 0)
			k++;
		if (k == experiment->plot_count)
			return command_usage(
				"plot", "%s has no plot '%s'", experiment->path, options->names.list[i]);
	}
	return 0;
}

/* What was drawn to stdout, what is missing to stderr. */
static int tell(struct plots_output *output)
{
	int code = command_print(&output->written);

	if (output->notes.length)
		(void)fprintf(stderr, "%s", text_string(&output->notes));
	if (output->missing.length)
		(void)fprintf(stderr, "%s", text_string(&output->missing));
	return !code && output->missing.length ? EX_FAILED : code;
}

static int draw_experiment(const struct plot_options *options, const char *path)
{
	struct experiment experiment;
	struct plots_output output = {.formats = options->formats};
	struct text folder = {0};
	struct error err = {0};
	int code = 0, told;

	if (options->dimensionless)
		return command_usage(
			"plot", "--dimensionless goes with runs; a plot of an EXPERIMENT has the key");
	if (experiment_read(&experiment, path, options->runs, options->settings.list,
			options->settings.count, &err))
		code = command_fail(&err);
	if (!code)
		code = check_names(options, &experiment);
	if (!code && plots_check(&experiment, &err))
		code = command_fail(&err);
	if (!code && file_path(&folder, experiment.folder, "figures", &err))
		code = command_fail(&err);
	output.folder = options->folder ? options->folder : text_string(&folder);
	for (size_t i = 0; !code && i < experiment.plot_count; i++)
		if (command_settings_choose(&options->names, experiment.plots[i].name.text) &&
			plots_draw(&experiment, &experiment.plots[i], &output, &err))
			code = command_fail(&err);
	told = tell(&output);
	plots_output_clean(&output);
	text_clean(&folder);
	experiment_clean(&experiment);
	return code ? code : told;
}

/* The folder of the run that a path names. */
static int default_folder(const char *path, struct text *folder, struct error *err)
{
	const char *slash = strrchr(path, '/');
	char *parent;
	int result;

	if (file_is_folder(path))
		return file_path(folder, path, "figures", err);
	parent = slash ? strndup(path, (size_t)(slash - path) + (slash == path)) : strdup(".");
	result = parent ? file_path(folder, parent, "figures", err) : error_memory(err, strlen(path));
	free(parent);
	return result;
}

static int draw_runs(const struct plot_options *options, char **paths, int count)
{
	struct plots_output output = {
		.formats = options->formats, .dimensionless = options->dimensionless};
	struct text folder = {0};
	struct error err = {0};
	int code = 0, told;

	if (options->names.count || options->settings.count || options->runs)
		return command_usage(
			"plot", "--plot, --runs and --set go with an EXPERIMENT, not with runs");
	if (default_folder(paths[0], &folder, &err))
		code = command_fail(&err);
	output.folder = options->folder ? options->folder : text_string(&folder);
	if (!code && plots_draw_runs((const char *const *)paths, (size_t)count, &output, &err))
		code = command_fail(&err);
	told = tell(&output);
	plots_output_clean(&output);
	text_clean(&folder);
	return code ? code : told;
}

static bool is_experiment(const char *path)
{
	const char *dot = strrchr(path, '.');

	return dot && (!strcmp(dot, ".yaml") || !strcmp(dot, ".yml")) && !file_is_folder(path);
}

static int draw(const struct plot_options *options, char **paths, int count)
{
	for (int i = 0; i < count; i++)
		if (is_experiment(paths[i]) && count > 1)
			return command_usage("plot", "one EXPERIMENT at a time: %s", paths[i]);
	return is_experiment(paths[0]) ? draw_experiment(options, paths[0])
								   : draw_runs(options, paths, count);
}

static int plot_main(int argc, char **argv)
{
	struct plot_options options = {.formats = PLOTS_ALL};
	struct text out = {0};
	int code = read_options(argc, argv, &options);

	if (code == 0 && options.help) {
		text_add(&out, help);
		code = command_print(&out);
	} else if (code == 0) {
		code = draw(&options, argv + optind, argc - optind);
	}
	command_settings_clean(&options.settings);
	command_settings_clean(&options.names);
	return code;
}

const struct command command_plot = {
	"plot", "draw runs, or the figures of an experiment", plot_main};
