/* A physical model as the run loop, recorder and campaign see it: they do not know which one runs. */
#ifndef TALUS_MODEL_H
#define TALUS_MODEL_H

#include <stdbool.h>
#include <stddef.h>

#include "talus/config.h"
#include "talus/error.h"

/* One scalar per recorded time. */
struct series {
	const char *name, *units, *long_name;
	bool whole;        /* counts: stored as integers */
	int slope_of;      /* index of the series whose slope in time this one is (filled by the
	                      recorder); -1: the model observes it */
	double window;     /* trailing time over which that slope is taken, s */
	bool per_step_sum; /* summed over the steps since the last recorded time, not sampled */
};

enum profile_shape {
	PROFILE_X,           /* [cells] */
	PROFILE_LAYER_X,     /* [layers][cells] */
	PROFILE_INTERFACE_X, /* [layers + 1][cells] */
	PROFILE_LAYER,       /* [layers] */
	PROFILE_INTERFACE,   /* [layers + 1] */
};

/* One field per profile time, or one for the whole run. */
struct profile {
	const char *name, *units, *long_name;
	enum profile_shape shape;
	bool constant; /* does not change with time: stored once */
};

/* A part of the exact state: everything that the next step needs is in one of these. */
struct array {
	const char *name;
	double *data;     /* owned by the model's state, contiguous */
	size_t extent[2]; /* rows, columns; a scalar is 1 by 1 */
};

/* Where things are, for the axes of a run file. */
struct axes {
	int cells, layers;       /* cells 0: the model knows no x */
	const double *x;         /* [cells], cell centres, m */
	const double *layer;     /* [layers], relative height of the middle of each layer, 1 */
	const double *interface; /* [layers + 1], relative height, 1 */
};

struct model_state; /* private to the model */

enum { MODEL_DOUBT_SIZE = 512 };

struct model {
	const char *name;
	int numerics_version; /* raised whenever the same config would give other numbers */
	const struct series *series;
	size_t series_count;
	const struct profile *profiles;
	size_t profile_count;
	bool keeps_state; /* a step that fails leaves the state as it was, which is then saved */

	/* Allocate a state at t = 0 from a checked config. EX_SOFTWARE out of memory. */
	int (*create)(const struct config *config, struct model_state **out, struct error *err);
	/* The largest stable time step of the present state, s; a NaN in the state comes out as NaN. */
	double (*time_step)(const struct model_state *state);
	/* Advance by dt. EX_FAILED where the numbers are no longer a flow: says what and where; the
	 * state is then useless, unless the model keeps it. Allocates nothing. */
	int (*step)(struct model_state *state, double dt, struct error *err);
	/* What may help where the steps become too short, or NULL: nobody knows. */
	const char *(*remedy)(const struct model_state *state);
	/* What is doubtful in the steps since the state was made or restored, if anything is. NULL: nothing. */
	bool (*doubt)(const struct model_state *state, char text[MODEL_DOUBT_SIZE]);
	/* How far the last step went, s: not beyond its dt. NULL for a model that takes every step as
	 * asked; one with this chooses its steps itself, and tries shorter ones where need be. */
	double (*taken)(const struct model_state *state);
	/* All series (but those with slope_of) of the present state and the last step,
	 * [series_count]. Before the first step the per-step values are 0. */
	void (*observe)(const struct model_state *state, double *values);
	/* Field `index` of the present state, shape as profiles[index] says. */
	void (*profile)(const struct model_state *state, size_t index, double *values);
	struct axes (*axes)(const struct model_state *state);
	/* The parts of the exact state; returns how many, at most MODEL_ARRAYS_MAX. */
	size_t (*arrays)(struct model_state *state, struct array *list);
	/* To be called after the arrays were overwritten: rebuilds what follows from them. */
	void (*restored)(struct model_state *state);
	void (*free)(struct model_state *state); /* NULL-safe */
	/* CPU seconds that a whole run takes, roughly: known before it begins. NULL: nobody knows. */
	double (*cost)(const struct config *config);
};

enum { MODEL_ARRAYS_MAX = 16 };

extern const struct model dry_model, immersed_model;

/* The model that a config names. */
const struct model *model_find(const struct config *config);

/* CPU seconds that a run of this config takes, roughly; where its model does not know, a guess from
 * cells and layers that at least tells a long run from a short one. */
double model_cost(const struct config *config);

#endif
