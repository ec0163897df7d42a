/* Fields at the positions that a config names, recorded with the series: the thickness at output.gauges,
 * and at output.velocity_at, the stations, that and the velocities of all layers. */
#ifndef TALUS_PROBES_H
#define TALUS_PROBES_H

#include "run/image.h"
#include "talus/model.h"
#include "talus/run_file.h"

/* One dataset: a profile of the model, linear between the cell centres. */
struct probe {
	const char *name, *axis; /* of the dataset; its second axis */
	const struct profile *profile;
	size_t index; /* of the profile in the model */
	const struct real_list *at;
	size_t layers; /* 1: of a profile along x alone */
	double *rows;  /* [rows][positions][layers] */
};

enum { PROBES_MAX = 4 };

struct probes {
	struct probe items[PROBES_MAX]; /* [count] */
	size_t count, cells;
	const double *x; /* [cells] */
	double *field;   /* the largest profile */
};

/* `config` and `axes` must outlive the probes. EX_SOFTWARE. */
int probes_init(struct probes *probes, const struct model *model, const struct config *config,
	const struct axes *axes, struct error *err);
void probes_clean(struct probes *probes);

/* Room for so many rows. EX_SOFTWARE. */
int probes_reserve(struct probes *probes, size_t rows, struct error *err);

/* Values of a row. */
size_t probes_width(const struct probes *probes);

void probes_observe(
	struct probes *probes, const struct model *model, const struct model_state *state, size_t row);

/* After the axes `time` and `layer`. */
void probes_write(const struct probes *probes, size_t rows, struct image *image);

/* EX_DATAERR, EX_SOFTWARE. */
int probes_read(struct probes *probes, struct run_file *file, size_t rows, struct error *err);

#endif
