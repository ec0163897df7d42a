/* talus: run, resume, inspect and tabulate campaigns of granular-flow simulations. */
#include <stdio.h>
#include <string.h>

#include "base/build.h"
#include "cli/command.h"
#include "cli/commands.h"

static const struct command *const commands[] = {COMMANDS};

static void print_help(FILE *stream)
{
	(void)fprintf(stream, "Run campaigns of granular-flow simulations.\n\n"
						  "usage: talus COMMAND [ARGUMENT]...\n"
						  "example: talus run configs/granular-collapse.yaml\n\n"
						  "commands:\n");
	for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++)
		(void)fprintf(stream, "  %-10s %s\n", commands[i]->name, commands[i]->summary);
	(void)fprintf(
		stream, "\n`talus COMMAND --help` tells more; `talus --version` tells the build.\n");
}

int main(int argc, char **argv)
{
	if (argc < 2) {
		print_help(stderr);
		return EX_USAGE;
	}
	if (!strcmp(argv[1], "help") || !strcmp(argv[1], "--help") || !strcmp(argv[1], "-h")) {
		print_help(stdout);
		return 0;
	}
	if (!strcmp(argv[1], "--version")) {
		printf("talus %s (%s, %s)\n", TALUS_VERSION, build_revision(), build_compiler());
		return 0;
	}
	for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++)
		if (!strcmp(argv[1], commands[i]->name))
			return commands[i]->main(argc - 1, argv + 1);
	(void)fprintf(stderr, "talus: unknown command '%s'; see `talus help`\n", argv[1]);
	return EX_USAGE;
}
