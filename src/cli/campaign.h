/* The parts of `talus campaign`. */
#ifndef TALUS_CLI_CAMPAIGN_H
#define TALUS_CLI_CAMPAIGN_H

#include <stdbool.h>

#include "cli/command.h"
#include "talus/campaign.h"

struct campaign_arguments {
	struct command_settings settings;
	const char *experiment, *folder, *executor;
	struct campaign_options options;
	bool dry_run, json, help;
};

int campaign_status_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment);
int campaign_run_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment);

#endif
