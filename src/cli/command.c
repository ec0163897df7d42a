#include "cli/command.h"

#include <errno.h>
#include <getopt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config/yaml.h"
#include "run/run_file_parts.h"

int command_fail(const struct error *err)
{
	char message[sizeof err->text + sizeof err->file + 32];

	(void)fflush(stdout);
	(void)fprintf(stderr, "talus: %s\n", error_format(err, message, sizeof message));
	return err->code ? err->code : EX_SOFTWARE;
}

int command_config_fail(const char *path, const struct error *err)
{
	struct error ignored = {0};
	struct node root = {0};
	bool experiment = err->code == EX_DATAERR && yaml_load(&root, path, &ignored) == 0 &&
					  root.kind == NODE_MAPPING && node_find(&root, "base");

	node_clean(&root);
	if (!experiment)
		return command_fail(err);
	(void)fflush(stdout);
	(void)fprintf(stderr,
		"talus: %s: is an experiment, not a config; `talus campaign run %s` runs it\n", path, path);
	return EX_DATAERR;
}

int command_usage(const char *command, const char *format, ...)
{
	va_list args;

	(void)fprintf(stderr, "talus %s: ", command);
	va_start(args, format);
	(void)vfprintf(stderr, format, args);
	va_end(args);
	(void)fprintf(stderr, "; see `talus %s --help`\n", command);
	return EX_USAGE;
}

int command_option_error(const char *command, int option, char **argv)
{
	const char *word = argv[optind - 1];

	if (option == ':')
		return command_usage(command, "%s needs a value", word);
	if (!strncmp(word, "--", 2) && optopt)
		return command_usage(command, "%s: this option takes no value", word);
	if (!strncmp(word, "--", 2))
		return command_usage(command, "unknown option %s", word);
	return command_usage(command, "unknown option -%c", optopt);
}

int command_settings_add(struct command_settings *settings, const char *text, struct error *err)
{
	size_t bytes = ((size_t)settings->count + 1) * sizeof *settings->list;
	const char **list = realloc(settings->list, bytes);

	if (!list)
		return error_memory(err, bytes);
	settings->list = list;
	list[settings->count++] = text;
	return 0;
}

void command_settings_clean(struct command_settings *settings)
{
	free(settings->list);
	*settings = (struct command_settings){0};
}

bool command_settings_choose(const struct command_settings *settings, const char *text)
{
	for (int i = 0; i < settings->count; i++)
		if (!strcmp(settings->list[i], text))
			return true;
	return settings->count == 0;
}

int command_open_run(const char *path, struct run_file **file, struct error *err)
{
	struct text warning = {0};
	int result = run_file_open_any(path, file, &warning, err);

	if (result == 0 && warning.length)
		(void)fprintf(stderr, "talus: warning: %s\n", text_string(&warning));
	text_clean(&warning);
	if (err->code == EX_NOINPUT)
		err->code = EX_DATAERR;
	return result;
}

int command_flush(int code)
{
	struct error err = {0};

	if (fflush(stdout) == 0 && !ferror(stdout))
		return code;
	(void)error_set(&err, EX_IOERR, "standard output cannot be written: %s", strerror(errno));
	clearerr(stdout);
	return code ? code : command_fail(&err);
}

int command_print(struct text *text)
{
	struct error err = {0};
	int code;

	if (text->failed) {
		(void)error_memory(&err, text->capacity);
		code = command_fail(&err);
	} else {
		text_tame(text->data);
		(void)fwrite(text_string(text), 1, text->length, stdout);
		code = command_flush(0);
	}
	text_clean(text);
	return code;
}
