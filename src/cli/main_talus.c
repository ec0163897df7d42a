/* talus: run, resume, inspect and tabulate campaigns of granular-flow simulations. */
#include <stdio.h>
#include <string.h>

#include "base/build.h"
#include "base/crash.h"
#include "cli/command.h"
#include "cli/commands.h"

static const struct command *const commands[] = {COMMANDS};

static void add_help(struct text *out)
{
	text_add(out, "Run campaigns of granular-flow simulations.\n\n"
				  "usage: talus COMMAND [ARGUMENT]...\n"
				  "example: talus run configs/granular-collapse.yaml\n\n"
				  "commands:\n");
	for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++)
		text_addf(out, "  %-10s %s\n", commands[i]->name, commands[i]->summary);
	text_add(out, "\n`talus COMMAND --help` tells more; `talus --version` tells the build.\n");
}

static int run_command(int argc, char **argv)
{
	struct text out = {0};

	if (argc < 2) {
		add_help(&out);
		(void)fprintf(stderr, "%s", text_string(&out));
		text_clean(&out);
		return EX_USAGE;
	}
	if (!strcmp(argv[1], "help") || !strcmp(argv[1], "--help") || !strcmp(argv[1], "-h")) {
		add_help(&out);
		return command_print(&out);
	}
	if (!strcmp(argv[1], "--version")) {
		text_addf(&out, "talus %s (%s, %s)\n", TALUS_VERSION, build_revision(), build_compiler());
		return command_print(&out);
	}
	for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++)
		if (!strcmp(argv[1], commands[i]->name))
			return commands[i]->main(argc - 1, argv + 1);
	(void)fprintf(stderr, "talus: unknown command '%s'; see `talus help`\n", argv[1]);
	return EX_USAGE;
}

int main(int argc, char **argv)
{
	crash_install();
	crash_exit(run_command(argc, argv));
}
