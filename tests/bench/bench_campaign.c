/* CPU time and wall clock to plan a campaign of 10,000 runs, and to tell its status when all have run
 * folders (promise: under a second each). The runs share one run file by hard links. */
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "talus/campaign.h"

static const char base[] = "slope: 22 deg\nerodible_bed_thickness: 2 mm\nlayers: 2\n"
						   "domain: {x_min: -0.1 m, x_max: 0.3 m, cells: 20}\n"
						   "initial: {height: 0.05 m, front: 0 m}\ntime: {end: 0.3 s}\n";
static const char study[] = "base: base.yaml\nruns:\n"
							"  - sample: {method: sobol, points: 1000}\n"
							"    slope: {from: 20 deg, to: 24 deg}\n"
							"    grains.diameter: {from: 0.5 mm, to: 1 mm, scale: log}\n"
							"    layers: {from: 1, to: 10, steps: 10}\n";

struct watch {
	double wall, cpu;
};

static struct watch begin(void)
{
	return (struct watch){clock_wall(), clock_cpu()};
}

static void tell(const char *what, const struct watch *start)
{
	struct rusage usage;

	(void)getrusage(RUSAGE_SELF, &usage);
	(void)printf("%s: %.2f s (%.2f s CPU), %.0f MB at most\n", what, clock_wall() - start->wall,
		clock_cpu() - start->cpu, 1e-3 * (double)usage.ru_maxrss);
}

static int write_text(const char *name, const char *text, struct error *err)
{
	return file_replace(&(struct file_place){.folder = ".", .name = name},
		&(struct file_part){text, strlen(text)}, 1, err);
}

/* Give every run the files of one that is complete. */
static int fill(const struct experiment *experiment, struct error *err)
{
	static const char *const names[] = {
		"run.h5", "run.previous.h5", "run.log", "status.yaml", "run.lock"};
	const struct run_options options = {.quiet = true};
	struct text from = {0}, to = {0};

	TRY(run_execute(&experiment->runs[0].config, "one", &options, err));
	for (size_t i = 0; i < experiment->run_count; i++) {
		TRY(file_make_folders(experiment->runs[i].folder, err));
		for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
			TRY(file_path(&from, "one", names[k], err));
			TRY(file_path(&to, experiment->runs[i].folder, names[k], err));
			if (link(text_string(&from), text_string(&to)) != 0)
				return error_at(err, EX_IOERR, text_string(&to), 0, 0, "cannot be linked");
		}
	}
	text_clean(&from);
	text_clean(&to);
	return 0;
}

static int measure(const char *what, bool filled, struct error *err)
{
	const struct campaign_options options = {.jobs = 2};
	struct experiment experiment;
	struct campaign campaign = {0};
	struct watch start = begin();
	int result = experiment_read(&experiment, "study.yaml", NULL, NULL, 0, err);

	if (!result)
		result = campaign_create(&campaign, &experiment, &options, err);
	if (!result)
		tell(what, &start);
	if (!result && !filled)
		result = fill(&experiment, err);
	else if (!result && campaign_count(&campaign, TASK_COMPLETE) != experiment.run_count)
		result = error_set(err, EX_SOFTWARE, "not all runs are complete");
	if (campaign.tasks)
		campaign_clean(&campaign);
	experiment_clean(&experiment);
	return result;
}

static int remove_entry(const char *path, const struct stat *st, int kind, struct FTW *at)
{
	(void)st;
	(void)kind;
	(void)at;
	return remove(path);
}

int main(void)
{
	char folder[] = "bench-campaign-XXXXXX", message[3072];
	struct error err = {0};

	if (!mkdtemp(folder) || chdir(folder)) {
		perror(folder);
		return EX_CANTCREAT;
	}
	if (write_text("base.yaml", base, &err) != 0 || write_text("study.yaml", study, &err) != 0 ||
		measure("plan of 10,000 runs", false, &err) != 0 ||
		measure("status of 10,000 runs", true, &err) != 0)
		(void)fprintf(stderr, "%s\n", error_format(&err, message, sizeof message));
	(void)chdir("..");
	(void)nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
	return err.code;
}
