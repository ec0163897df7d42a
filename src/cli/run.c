/* talus run: bring a run to its end, from wherever it stands. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/stop.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "talus/config.h"
#include "talus/run.h"

static const char help[] =
	"Run a config, or go on with a run that was stopped, until it is complete.\n\n"
	"usage: talus run [-o DIR] [--set KEY=VALUE]... FILE\n"
	"example: talus run configs/granular-collapse.yaml\n\n"
	"options:\n"
	"  -o, --output DIR     folder of the run (default: results/ and the name of FILE without .yaml)\n"
	"  -s, --set KEY=VALUE  override a key of FILE, such as time.cfl=0.5; repeatable\n"
	"                       (default: none)\n"
	"  -r, --retry          start a run that has failed anew (default: off)\n"
	"  -c, --continue-from DIR\n"
	"                       where the folder has no run yet, go on from the one in DIR, which may\n"
	"                       differ by an earlier time.end and in nothing else (default: none)\n"
	"  -n, --no-progress    no progress line on a terminal (default: off)\n"
	"  -q, --quiet          print nothing but errors and warnings (default: off)\n"
	"  -h, --help           print this\n\n"
	"The same command starts a run, resumes it and finds it complete. With a later time.end and\n"
	"nothing else changed it goes on from what was computed, to the bits of a run that had that end\n"
	"from the start; a finished run then stays as run.end-SECONDS.h5. SIGINT, SIGTERM and\n"
	"SIGUSR1 finish the step and write a checkpoint; a second SIGINT leaves at once.\n\n"
	"exit: 0 complete, 1 the simulation failed, 65 bad config or run file, 73 cannot create the\n"
	"folder, 74 input or output error, 75 stopped or locked: the same command goes on\n";

struct run_command {
	struct command_settings settings;
	struct run_options run;
	const char *folder; /* NULL: the default */
	const char *file;   /* NULL: only help is asked for */
	bool help;
};

/* The progress line is written over in place, and taken away before any other line. */
static void say(enum run_voice voice, const char *line)
{
	if (voice == RUN_VOICE_RESULT)
		(void)printf("%s\n", line);
	else if (voice == RUN_VOICE_WARNING)
		(void)fprintf(stderr, "talus: warning: %s\n", line);
	else
		(void)fprintf(stderr, "\r%s\033[K", line);
}

static int read_options(int argc, char **argv, struct run_command *command)
{
	static const struct option list[] = {
		{"output", required_argument, NULL, 'o'},
		{"set", required_argument, NULL, 's'},
		{"retry", no_argument, NULL, 'r'},
		{"continue-from", required_argument, NULL, 'c'},
		{"no-progress", no_argument, NULL, 'n'},
		{"quiet", no_argument, NULL, 'q'},
		{"help", no_argument, NULL, 'h'},
		{0},
	};
	struct error err = {0};
	int option;

	command->run.progress = isatty(STDERR_FILENO) == 1;
	while ((option = getopt_long(argc, argv, ":o:s:rc:nqh", list, NULL)) != -1) {
		if (option == 's' && command_settings_add(&command->settings, optarg, &err) != 0)
			return command_fail(&err);
		if (option == ':' || option == '?')
			return command_option_error("run", option, argv);
		if (option == 'o')
			command->folder = optarg;
		if (option == 'c')
			command->run.from = optarg;
		command->run.retry |= option == 'r';
		command->run.progress &= option != 'n' && option != 'q';
		command->run.quiet |= option == 'q';
		command->help |= option == 'h';
	}
	if (command->help)
		return 0;
	if (optind + 1 != argc)
		return command_usage("run", optind == argc ? "no FILE given" : "only one FILE can be run");
	if (command->folder && !*command->folder)
		return command_usage("run", "the folder of -o is empty");
	command->file = argv[optind];
	return 0;
}

/* Threads of a run that have nothing to do are to sleep, not to spin on a processor that another run may
 * have. OpenMP reads that from the environment before main begins: begin anew, with it set. Goes on
 * spinning where FILE can be read only once. */
static void sleep_when_idle(const struct config *config, const char *file, char **argv)
{
	struct stat info;

	if (config->threads > 1 && !getenv("OMP_WAIT_POLICY") && stat(file, &info) == 0 &&
		S_ISREG(info.st_mode) && setenv("OMP_WAIT_POLICY", "passive", false) == 0 && !stop_signal())
		(void)execv("/proc/self/exe", argv);
}

static int execute(struct run_command *command, char **argv)
{
	struct text folder = {0};
	struct config config;
	struct error err = {0};
	int code = 0;

	text_add(&folder, command->folder ? command->folder : "results/");
	if (!command->folder && !file_stem(command->file, &folder)) {
		text_clean(&folder);
		return command_usage("run",
			"the name of %s is none for a folder of results; name one with -o", command->file);
	}
	command->run.say = say;
	stop_install();
	if (folder.failed)
		(void)error_memory(&err, folder.capacity);
	else if (config_read(&config, command->file, command->settings.list, command->settings.count,
				 &err) != 0) {
		code = command_config_fail(command->file, &err);
	} else {
		sleep_when_idle(&config, command->file, argv);
		(void)run_execute(&config, text_string(&folder), &command->run, &err);
	}
	if (err.code && !code)
		code = command_fail(&err);
	text_clean(&folder);
	return command_flush(code);
}

static int run_main(int argc, char **argv)
{
	struct run_command command = {0};
	struct text out = {0};
	int code = read_options(argc, argv, &command);

	if (code == 0 && command.file) {
		code = execute(&command, argv - 1); /* with the name of the program */
	} else if (code == 0) {
		text_add(&out, help);
		code = command_print(&out);
	}
	command_settings_clean(&command.settings);
	return code;
}

const struct command command_run = {"run", "run a config, or go on where it was stopped", run_main};
