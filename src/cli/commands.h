/* Every subcommand, in the order of `talus help`. */
#ifndef TALUS_COMMANDS_H
#define TALUS_COMMANDS_H

#include "cli/command.h"

extern const struct command command_check;
extern const struct command command_run;
extern const struct command command_info;
extern const struct command command_diff;
extern const struct command command_verify;
extern const struct command command_campaign;
extern const struct command command_plot;
extern const struct command command_tables;

#define COMMANDS                                                                                   \
	&command_check, &command_run, &command_info, &command_diff, &command_verify,                   \
		&command_campaign, &command_plot, &command_tables,

#endif
