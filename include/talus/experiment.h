/* An experiment: the runs that one YAML file asks for, and the tables it wants of them. */
#ifndef TALUS_EXPERIMENT_H
#define TALUS_EXPERIMENT_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/config.h"
#include "talus/error.h"

/* A text of the experiment file and its place there; line 0: from the command line. */
struct term {
	const char *text; /* owned by the experiment */
	int line, column;
};

struct term_list {
	struct term *items; /* [count] */
	size_t count;
};

/* One key of a config and the value it gets, both as the author wrote them. */
struct setting {
	char *key;        /* dotted */
	char *value;      /* as config_parse reads it after "key=" */
	int line, column; /* of the value; the key is named by the message */
};

struct setting_list {
	struct setting *items; /* [count] */
	size_t count;
};

struct experiment_run {
	char *id;                     /* readable, ends with digits of the hash: name of the folder */
	char *folder;                 /* where its files are or will be */
	struct config config;         /* effective */
	char hash[CONFIG_HASH_SIZE];  /* config_hash of it */
	struct setting_list settings; /* of its entry in `runs`, in order */
	int point;                    /* of the sampled design that it belongs to, from 1; 0: of none */
	int repeat;                   /* counted from 1 */
};

struct node;
struct run_key;

/* A table as the file asks for it; src/tables gives it its meaning. */
struct experiment_table {
	struct term name;
	const char *title;             /* "": that of the experiment */
	struct term_list rows;         /* keys whose values make the rows */
	struct term_list columns;      /* the same for columns; may be empty */
	struct term_list metrics;      /* what a cell shows */
	struct term_list at;           /* profile times for the metrics that need one; empty: the end */
	struct term_list at_x;         /* positions for the metrics that need one */
	struct setting_list baseline;  /* makes of a run's config that of the run it is timed against */
	struct setting_list reference; /* makes of a run's config that of the exact one */
	struct setting_list only;      /* runs without these values are left out */
	bool dimensionless;            /* lengths by h_0, times by tau_c, velocities by v_0 */
	const struct node *published;  /* rows of columns of metrics, NULL: none */
};

/* A file of measured values, for tables and plots; src/tables reads it. */
struct experiment_observation {
	struct term file;         /* as written */
	char *path;               /* of the file: the written one lies beside the experiment */
	const char *title;        /* of the legend, "": "observed" */
	struct setting_list only; /* values of the runs that it is of */
};

/* Published values that a panel shows beside ours. */
struct experiment_points {
	const char *title;     /* of the legend, "": that of the source */
	struct term_list line; /* values of `lines`: drawn in the colour of that line; may be empty */
	double *x, *y;         /* in the units of the axes, [count] */
	size_t count;
};

/* A panel of a figure as the file asks for it; src/plots gives it its meaning. */
struct experiment_panel {
	struct term kind;
	const char *title;          /* "": made from what it shows */
	struct term_list y;         /* datasets, or metrics */
	struct term x;              /* what they are drawn over, where the kind leaves a choice */
	struct term_list at;        /* profile times; empty: the last */
	struct term_list at_x;      /* positions */
	struct term_list layer;     /* numbers of layers, or of interfaces, from the bed */
	struct term_list lines;     /* keys in whose values the lines differ */
	struct term_list split;     /* the same for panels: one for every value */
	struct term_list log;       /* axes with a logarithmic scale */
	struct term_list ranges[2]; /* of x and y: two numbers each, or empty */
	struct term units[2];       /* of x and y; text NULL: SI */
	const char *labels[2];      /* of x and y; "": made from what is drawn */
	bool dimensionless;         /* lengths by h_0, times by tau_c, velocities by v_0 */
	int coordinates;            /* enum given_kind: of thicknesses over x */
	bool above_bed;             /* the thickness without the erodible bed */
	struct setting_list baseline, reference, only; /* as those of a table */
	const struct node *names;                      /* legend names of values, NULL: none */
	struct experiment_points *published;           /* [published_count] */
	size_t published_count;
};

struct experiment_plot {
	struct term name;
	const char *title;               /* "": that of the experiment */
	int columns;                     /* panels beside one another; 0: as fits */
	struct experiment_panel *panels; /* [panel_count] */
	size_t panel_count;
};

/* How a cluster runs the tasks; what is empty or 0 is left to the cluster. */
struct experiment_slurm {
	const char *partition;          /* "" */
	long time;                      /* limit of a task, s */
	int grace;                      /* how long before the limit a run is asked to stop, s */
	char memory[24];                /* of a task, as Slurm writes it: "4G" */
	int throttle;                   /* tasks at a time */
	struct setting_list directives; /* more options of sbatch; one without a value is "true" */
};

struct experiment {
	char *path;        /* of its file, as given */
	char *folder;      /* that holds the run folders */
	const char *title; /* "" if none */
	const char *source;
	int repeat;
	bool timing;                 /* one run at a time */
	struct experiment_run *runs; /* [run_count], every run once, then every run again, ... */
	size_t run_count;
	struct experiment_table *tables; /* [table_count] */
	size_t table_count;
	struct experiment_observation *observations; /* [observation_count] */
	size_t observation_count;
	struct experiment_plot *plots; /* [plot_count] */
	size_t plot_count;
	struct experiment_slurm slurm;

	char *base; /* path of the base config, and what it says */
	struct node *base_root;
	struct setting_list set;       /* for all runs, before their own */
	struct setting_list overrides; /* of the command line, after them */
	struct node *root;             /* the file; terms point into it */
	struct run_key *keys;          /* [run_count], sorted: runs by hash and repeat */
	int digits;                    /* of the hashes, which names end with */
};

enum { EXPERIMENT_RUNS_MAX = 10000 };

/* Read an experiment file and every config that it asks for. Run folders lie in `folder`, NULL: in
 * results/<stem of path>; a folder there that ends with the hash and repeat of a run belongs to it,
 * whatever its name began with. `overrides` are "key=value" for all runs. Errors: EX_DATAERR with the
 * place in the experiment or the base config, EX_SOFTWARE. Clean in every case. */
int experiment_read(struct experiment *experiment, const char *path, const char *folder,
	const char *const *overrides, int count, struct error *err);

void experiment_clean(struct experiment *experiment);

/* Every key of an experiment file, in Markdown. */
void experiment_reference(struct text *out);

/* The config of `run` with `more` on top. A bad one among `more` is cited with its place. */
int experiment_vary(const struct experiment *experiment, const struct experiment_run *run,
	const struct setting_list *more, struct config *config, struct error *err);

/* Does the run have all these values, however they are written? Values that it cannot have are not its
 * own. */
int experiment_has(const struct experiment *experiment, const struct experiment_run *run,
	const struct setting_list *values, bool *has, struct error *err);

/* The index of the run with this config and repeat; run_count if the experiment has none. */
int experiment_find(const struct experiment *experiment, const struct config *config, int repeat,
	size_t *index, struct error *err);

#endif
