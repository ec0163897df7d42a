/* talus info: what is this run? */
#include <getopt.h>
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/file.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "run/run_file_parts.h"
#include "tables/metric.h"
#include "talus/config.h"

static const char help[] =
	"Tell what a run is and how far it has come.\n\n"
	"usage: talus info [--config] PATH...\n"
	"example: talus info results/granular-collapse\n\n"
	"PATH is a run folder or a run file.\n\n"
	"options:\n"
	"  -c, --config  print the config that the run was made with, which can be run again\n"
	"                (default: off)\n"
	"  -h, --help    print this\n\n"
	"exit: 0, or 65 for a PATH that is no good run file\n";

struct info_options {
	bool config, help;
};

static int read_options(int argc, char **argv, struct info_options *options)
{
	static const struct option list[] = {
		{"config", no_argument, NULL, 'c'},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	int option;

	while ((option = getopt_long(argc, argv, ":ch", list, NULL)) != -1) {
		if (option == ':' || option == '?')
			return command_option_error("info", option, argv);
		options->config |= option == 'c';
		options->help |= option == 'h';
	}
	if (!options->help && optind == argc)
		return command_usage("info", "no PATH given");
	return 0;
}

static int add_attribute(
	struct run_file *file, const char *name, struct text *out, struct error *err)
{
	text_addf(out, "  %-23s", name);
	TRY(run_file_text(file, name, out, err));
	text_add(out, "\n");
	return 0;
}

/* What the run came to, as tables have it; what a model has no dataset for is passed over. */
static int add_outcome(
	struct run_file *file, const struct config *config, struct text *out, struct error *err)
{
	static const char *const names[] = {"runout", "front-stopping-time", "stopping-time",
		"final-thickness", "energy-loss", "energy-rise"};

	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		const char *nearest;
		const struct metric *metric = metric_find(names[i], &nearest);
		const struct sample sample = {
			.file = file, .config = config, .at = config->time.end, .metric = metric};
		struct error refusal = {0};
		double value;
		bool has;

		TRY(run_file_has(file, metric->dataset, &has, err));
		if (!has)
			continue;
		if (metric->value(&sample, &value, &refusal) == 0 && !isfinite(value))
			text_addf(out, "  %-23snone\n", names[i]);
		else if (!refusal.code)
			text_addf(
				out, "  %-23s%.4g%s%s\n", names[i], value, *metric->unit ? " " : "", metric->unit);
		else if (refusal.code == EX_DATAERR)
			text_addf(out, "  %-23s%s\n", names[i], refusal.text);
		else
			*err = refusal;
	}
	return err->code ? -1 : 0;
}

/* Of a config that another version wrote and this one cannot read nothing is told. */
static int add_config(struct run_file *file, struct text *out, struct error *err)
{
	struct text stored = {0};
	struct error other_version = {0};
	struct config config;
	int result = run_file_text(file, "config", &stored, err);

	if (result == 0 && config_parse(&config, text_string(&stored), stored.length,
						   run_file_path(file), NULL, 0, &other_version) == 0) {
		result = add_outcome(file, &config, out, err);
		config_print_leading(&config, out);
	}
	text_clean(&stored);
	if (other_version.code == EX_SOFTWARE) {
		*err = other_version;
		return -1;
	}
	return result;
}

static int add_summary(struct run_file *file, struct text *out, struct error *err)
{
	const struct run_summary *summary = run_file_summary(file);
	char span[CLOCK_SPAN_SIZE], size_text[FILE_SIZE_TEXT];
	double cpu, attempts;
	struct dataset times;
	size_t size;

	(void)run_file_image(file, &size);
	TRY(run_file_real(file, "cpu_seconds", &cpu, err));
	TRY(run_file_real(file, "attempts", &attempts, err));
	TRY(run_file_dataset(file, "/time", &times, err));
	free(times.values);
	text_addf(out, "%s\n  %-23s%s\n  %-23s%llu steps to t = %g s\n", run_file_path(file), "status",
		run_status_name(summary->status), "done", (unsigned long long)summary->step, summary->time);
	if (summary->status == RUN_FAILED)
		TRY(add_attribute(file, "reason", out, err));
	text_addf(out, "  %-23s%s in %g attempt%s\n", "CPU time", clock_span(cpu, span), attempts,
		attempts == 1 ? "" : "s");
	text_addf(out, "  %-23s%s, %zu recorded times\n", "size",
		file_size_text((double)size, size_text), times.extent[0]);
	TRY(add_attribute(file, "created", out, err));
	TRY(add_attribute(file, "host", out, err));
	TRY(add_attribute(file, "talus_version", out, err));
	TRY(add_attribute(file, "git_revision", out, err));
	TRY(add_attribute(file, "compiler", out, err));
	TRY(add_attribute(file, "model", out, err));
	TRY(add_attribute(file, "config_hash", out, err));
	return add_config(file, out, err);
}

static int tell(const char *path, bool config)
{
	struct text out = {0};
	struct run_file *file = NULL;
	struct error err = {0};
	int code;

	if (command_open_run(path, &file, &err) == 0)
		(void)(config ? run_file_text(file, "config", &out, &err) : add_summary(file, &out, &err));
	run_file_close(file);
	code = err.code ? command_fail(&err) : command_print(&out);
	text_clean(&out);
	return code;
}

static int info_main(int argc, char **argv)
{
	struct info_options options = {0};
	struct text out = {0};
	int code = read_options(argc, argv, &options);

	if (code != 0)
		return code;
	if (options.help) {
		text_add(&out, help);
		return command_print(&out);
	}
	for (int i = optind; i < argc; i++) {
		int result = tell(argv[i], options.config);

		code = result ? result : code;
	}
	return code;
}

const struct command command_info = {
	"info", "tell what a run is and how far it has come", info_main};
