/* What strangers may hand us, for libFuzzer and AFL++ (`make fuzz`, fuzz.c) and for `make check`, which
 * replays the committed corpora (test_corpus.c). Whatever the bytes are: no crash, no leak, and what is
 * accepted keeps its promises. */
#ifndef TALUS_FUZZ_TARGETS_H
#define TALUS_FUZZ_TARGETS_H

#include <assert.h>
#include <dirent.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "run/compare.h"
#include "run/run_file_parts.h"
#include "run/verify.h"
#include "talus/config.h"
#include "talus/experiment.h"
#include "talus/tables.h"

/* Also where assert is compiled out. */
static inline void require(bool holds, const char *what)
{
	if (holds)
		return;
	(void)fprintf(stderr, "broken promise: %s\n", what);
	abort();
}

/* A refusal has a code and says why. */
static inline void require_refusal(const struct error *err)
{
	require(err->code == EX_DATAERR || err->code == EX_NOINPUT || err->code == EX_IOERR ||
				err->code == EX_SOFTWARE,
		"the code of a refusal");
	require(err->text[0] != '\0', "the text of a refusal");
}

/* What is accepted prints to a config that reads back the same. */
static inline int fuzz_config(const uint8_t *bytes, size_t size)
{
	struct config config, again;
	struct text first = {0}, second = {0};
	struct error err = {0};

	if (config_parse(&config, (const char *)bytes, size, "fuzz", NULL, 0, &err) != 0) {
		require_refusal(&err);
		return 0;
	}
	config_print(&config, &first);
	require(config_parse(&again, text_string(&first), first.length, "again", NULL, 0, &err) == 0,
		"an effective config is one that is accepted");
	config_print(&again, &second);
	require(!strcmp(text_string(&first), text_string(&second)), "a config reads back the same");
	text_clean(&first);
	text_clean(&second);
	return 0;
}

/* A folder of our own to work in, made once, with a base config. */
static inline void enter_folder(void)
{
	static const char base[] = "slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: 4\n"
							   "output: {profiles_at: [0.5 s, 1 s]}\ntime: {end: 1 s}\n";
	static char folder[] = "/tmp/talus-fuzz-XXXXXX";
	static bool there;
	FILE *file;

	if (there)
		return;
	there = mkdtemp(folder) && chdir(folder) == 0;
	require(there, "a folder to work in");
	file = fopen("base.yaml", "w");
	require(file && fputs(base, file) >= 0 && fclose(file) == 0, "a base config");
}

static inline void write_input(const char *name, const uint8_t *bytes, size_t size)
{
	int fd = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0600);

	require(fd >= 0 && write(fd, bytes, size) == (ssize_t)size && close(fd) == 0, "an input file");
}

/* Nothing of what is accepted lies outside of the results. */
static inline int fuzz_experiment(const uint8_t *bytes, size_t size)
{
	struct experiment experiment;
	struct error err = {0};

	enter_folder();
	write_input("fuzz.yaml", bytes, size);
	if (experiment_read(&experiment, "fuzz.yaml", NULL, NULL, 0, &err) != 0 ||
		table_check(&experiment, &err) != 0)
		require_refusal(&err);
	else
		for (size_t i = 0; i < experiment.run_count; i++) {
			const char *id = experiment.runs[i].id;

			require(*id && *id != '.' && *id != '-' && !strchr(id, '/') && strlen(id) < 255,
				"the id of a run is a plain name");
			require(!strncmp(experiment.runs[i].folder, "results/fuzz/", 13), "a run's folder");
			require(!strchr(experiment.runs[i].folder + 13, '/'), "a run's folder");
		}
	experiment_clean(&experiment);
	return 0;
}

static inline int fuzz_run_file(const uint8_t *bytes, size_t size)
{
	struct run_file *file = NULL;
	struct run_summary summary;
	const char *warning;
	struct text out = {0};
	struct error err = {0}, unpeeked = {0};

	enter_folder();
	write_input("run.h5", bytes, size);
	(void)run_file_peek("run.h5", &summary, &unpeeked);
	if (run_file_open("run.h5", &file, &warning, &err) != 0)
		require_refusal(&err);
	else if (verify_run_file(file, &out, &err) == 0)
		require(compare_run_files(file, file, &out, &err) == 0 || err.code, "a file equals itself");
	run_file_close(file);
	text_clean(&out);
	return 0;
}

#endif
