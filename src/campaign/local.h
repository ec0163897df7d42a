/* The executor of this machine: a pool of child processes. */
#ifndef TALUS_LOCAL_H
#define TALUS_LOCAL_H

#include "talus/campaign.h"

int local_execute(struct campaign *campaign, struct error *err);

#endif
