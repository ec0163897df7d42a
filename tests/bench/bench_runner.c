/* What the campaign runner itself costs: CPU time per run, over 1,000 runs of a tenth of a second eight at
 * a time (promise: under 1 % of theirs), and its memory with 10,000 runs (promise: under 50 MB). The runs
 * are a shell script that sleeps and leaves a finished run behind. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "talus/campaign.h"

static const char base[] = "slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: 1\n"
						   "pressure: hydrostatic\ndomain: {x_min: 0 m, x_max: 1 m, cells: 3}\n"
						   "time: {end: 0.01 s}\n";

static const char program[] = "#!/bin/sh\nsleep 0.1\ncp run.h5 \"$4\"\n";

static int write_file(const char *name, const char *text, struct error *err)
{
	return file_replace(&(struct file_place){.folder = ".", .name = name},
		&(struct file_part){text, strlen(text)}, 1, err);
}

/* An experiment of ten times `tens` runs, and a finished run file for each to leave behind. */
static int prepare(int tens, struct error *err)
{
	struct text study = {0};
	struct config config;
	int result;

	text_add(
		&study, "base: base.yaml\nruns:\n- layers: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n  slope: [");
	for (int i = 0; i < tens; i++)
		text_addf(&study, "%s%d.%03d deg", i ? ", " : "", 10 + i / 1000, i % 1000);
	text_add(&study, "]\n");
	result = write_file("study.yaml", text_string(&study), err);
	text_clean(&study);
	TRY(result);
	TRY(write_file("base.yaml", base, err));
	TRY(write_file("program", program, err));
	if (chmod("program", 0700) != 0)
		return error_set(err, EX_CANTCREAT, "program cannot be made executable");
	TRY(config_parse(&config, base, strlen(base), "base", NULL, 0, err));
	TRY(run_execute(&config, "made", &(struct run_options){.quiet = true}, err));
	return rename("made/run.h5", "run.h5") == 0 ? 0 : error_set(err, EX_IOERR, "no run file");
}

/* Of this process: in all, and in the kernel alone, which makes folders, files and processes. */
struct cpu {
	double all, kernel;
};

static struct cpu own_cpu(void)
{
	struct rusage usage = {0};
	double kernel;

	(void)getrusage(RUSAGE_SELF, &usage);
	kernel = (double)usage.ru_stime.tv_sec + 1e-6 * (double)usage.ru_stime.tv_usec;
	return (struct cpu){
		kernel + (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec, kernel};
}

/* In a process of its own, for its peak of memory. */
static int measure(int tens, bool execute, struct error *err)
{
	const struct campaign_options options = {.jobs = 8, .program = "./program"};
	struct experiment experiment = {0};
	struct campaign campaign = {0};
	struct rusage usage = {0};
	struct cpu before, after;
	double start = clock_wall();
	int result;

	TRY(prepare(tens, err));
	result = experiment_read(&experiment, "study.yaml", NULL, NULL, 0, err);
	if (result == 0)
		result = campaign_create(&campaign, &experiment, &options, err);
	if (result == 0)
		(void)printf("plan of %zu runs: %.2f s\n", experiment.run_count, clock_wall() - start);
	start = clock_wall();
	before = own_cpu();
	if (result == 0 && execute) {
		double count = (double)experiment.run_count;

		result = campaign_execute(&campaign, executor_find("local"), err);
		after = own_cpu();
		(void)printf("%zu of %.0f runs in %.1f s: %.2f ms of CPU each for the runner (%.2f in the "
					 "kernel), %.2f %% of 0.1 s\n",
			campaign_count(&campaign, TASK_COMPLETE), count, clock_wall() - start,
			1e3 * (after.all - before.all) / count, 1e3 * (after.kernel - before.kernel) / count,
			1e3 * (after.all - before.all) / count);
	}
	(void)getrusage(RUSAGE_SELF, &usage);
	(void)printf(
		"runner with %d runs: peak of %.1f MB\n", 10 * tens, 1.024e-3 * (double)usage.ru_maxrss);
	campaign_clean(&campaign);
	experiment_clean(&experiment);
	return result;
}

static int measure_in_child(int tens, bool execute)
{
	char message[3072];
	struct error err = {0};
	int status = 0;
	pid_t pid;

	(void)fflush(stdout);
	pid = fork();
	if (pid == 0) {
		if (measure(tens, execute, &err) != 0)
			(void)fprintf(stderr, "%s\n", error_format(&err, message, sizeof message));
		(void)fflush(stdout);
		_exit(err.code);
	}
	if (pid < 0 || waitpid(pid, &status, 0) != pid)
		return EX_SOFTWARE;
	return WIFEXITED(status) ? WEXITSTATUS(status) : EX_SOFTWARE;
}

int main(void)
{
	char folder[] = "bench-runner-XXXXXX", command[64];
	int code;

	if (!mkdtemp(folder) || chdir(folder) != 0) {
		perror(folder);
		return EX_CANTCREAT;
	}
	code = measure_in_child(100, true);
	if (code == 0)
		code = measure_in_child(1000, false);
	(void)snprintf(command, sizeof command, "rm -rf ../'%s'", folder);
	return system(command) == 0 ? code : EX_IOERR; /* NOLINT(cert-env33-c): a folder of our own */
}
