/* Run folders that no experiment names any more. */
#ifndef TALUS_LEFTOVER_H
#define TALUS_LEFTOVER_H

#include "talus/experiment.h"
#include "talus/run.h"

struct leftover {
	char *folder;
	struct run_report report;
	double bytes;     /* of its files */
	const char *kept; /* why it is not removed, static; NULL: it is */
};

struct leftover_list {
	struct leftover *items; /* [count], by name */
	size_t count;
};

/* The folders among the runs of `experiments[0]` that are run folders, of which none of the experiments has
 * a run. A run folder is one whose name ends with the hash of the config.yaml in it, and which holds
 * nothing but the files of a run; symbolic links are none. Clean in every case. EX_SOFTWARE. */
int leftover_list_read(const struct experiment *experiments, size_t count,
	struct leftover_list *out, struct error *err);
void leftover_list_clean(struct leftover_list *list);

/* Remove the files of a run and their folder. EX_INTERRUPTED: a process works on it; EX_IOERR. */
int leftover_remove(const struct leftover *leftover, struct error *err);

#endif
