/* From the `runs` of an experiment to its list of runs. */
#ifndef TALUS_EXPAND_H
#define TALUS_EXPAND_H

#include "config/yaml.h"
#include "talus/experiment.h"

/* Fill experiment->runs from the node of `runs` (NULL or blank: one run of the base): configs, hashes,
 * names and folders. */
int experiment_expand(struct experiment *experiment, const struct node *runs, struct error *err);

/* Give every run its id and folder. */
int experiment_name_runs(struct experiment *experiment, struct error *err);

/* Whether a run of the experiment has the folder of this name. */
bool experiment_owns(const struct experiment *experiment, const char *name);

/* The index of the run that a folder of this name belongs to, whatever the name begins with: by the
 * digits of its hash at the end, and by its `_repeat-K`, of which none is the first. run_count if there
 * is no such run. */
size_t run_name_find(const struct experiment *experiment, const char *name);

#endif
