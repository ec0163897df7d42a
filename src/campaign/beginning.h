/* Runs that begin with another: the same config but for an earlier time.end. */
#ifndef TALUS_BEGINNING_H
#define TALUS_BEGINNING_H

#include "talus/campaign.h"

/* Tell every task that has no run file yet what it can go on from: `before`, the run of this campaign with
 * the latest end that comes before its own, or `from`, the folder of a run that the experiment no longer
 * names. Runs that are timed begin with nothing. EX_SOFTWARE. */
int beginning_find(struct campaign *campaign, struct error *err);

/* config_hash of a config without its time.end. */
int beginning_hash(const struct config *config, char hash[CONFIG_HASH_SIZE], struct error *err);

#endif
