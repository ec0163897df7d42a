/* Every subcommand, in the order of `talus help`. */
#ifndef TALUS_COMMANDS_H
#define TALUS_COMMANDS_H

#include "cli/command.h"

extern const struct command command_check;

#define COMMANDS &command_check,

#endif
