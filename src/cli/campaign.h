/* The parts of `talus campaign`. */
#ifndef TALUS_CLI_CAMPAIGN_H
#define TALUS_CLI_CAMPAIGN_H

#include <stdbool.h>

#include "cli/command.h"
#include "talus/campaign.h"

#define CAMPAIGN_OPTIONS_OF_ALL                                                                    \
	"  -o, --output FOLDER   folder of the run folders (default: results/<name of EXPERIMENT>)\n"  \
	"  -s, --set KEY=VALUE   override a config key of every run; repeatable (default: none)\n"     \
	"  -h, --help            print this\n\n"

struct campaign_arguments {
	struct command_settings settings;
	const char *experiment, *folder, *executor;
	char **names; /* [name_count], of runs or, for prune, of further experiments */
	int name_count;
	struct campaign_options options;
	double every; /* s between two looks of watch */
	bool dry_run, json, all, yes, help;
};

/* One action of `talus campaign`, in a file of its own. */
struct campaign_action {
	const char *name;
	const char *summary;
	const char *usage;   /* what follows `talus campaign NAME` */
	const char *help;    /* what it does beyond the summary, its options and exit codes */
	const char *options; /* letters of the options that it takes beside -o, -s and -h */
	bool names;          /* whether runs may be named after the experiment */
	int (*main)(const struct campaign_arguments *arguments, const struct experiment *experiment);
};

extern const struct campaign_action campaign_action_run, campaign_action_status,
	campaign_action_watch, campaign_action_retry, campaign_action_cancel, campaign_action_prune,
	campaign_action_why;

/* Columns and rows of the terminal at `fd`; 0: it is none. */
void campaign_screen(int fd, int *columns, int *rows);

/* `name` in at most `width` columns, cut in the middle so that the hash at its end stays. */
char *campaign_short_name(const char *name, int width, char buffer[256]);

/* Share of the simulated time that is done. */
double campaign_progress(const struct experiment_run *run, const struct run_report *report);

/* Wall clock to the end of the campaign, s, by what was done since `began` when `done_began` was done. */
double campaign_left(const struct campaign *campaign, double began, double done_began);

/* What the queue of a cluster says of a run: "PENDING 12_4 (Resources)", or nothing. */
void campaign_add_queue(const struct queue_entry *entry, struct text *out);

/* What `run` would do with the run, in words. */
void campaign_describe_plan(
	const struct campaign *campaign, const struct task *task, struct text *out);

/* "talus campaign ACTION ..." as this command was given, for hints. */
void campaign_command(
	const struct campaign_arguments *arguments, const char *action, struct text *out);

#endif
