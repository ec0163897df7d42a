/* The multilayer dry model (P1; P2 for one layer; P3 for hydrostatic pressure): its state, shared by
 * the three steps of a time step. Letters follow the papers.
 *
 * Layout: a field of cells is one row of `grid.stride` values per layer, bottom layer first, with a
 * ghost cell at either end; a field of faces is one row of `grid.faces` values per layer. A step goes
 * over the cells in chunks (chunk.h) that are short enough to stay in the second-level cache with all
 * their layers: memory is read once per step and not once per loop. Within a chunk the layers are
 * outside and x is inside, in plain loops over rows that do not overlap and that the compiler turns
 * into vectors of whichever width the processor has (kernel.h). Such a loop writes one value per cell
 * or face and never sums along x, so its bits do not depend on that width; sums over the layers are
 * kept in rows of cells, one term per layer and always from the bottom up; what is summed along x, for
 * the series, is summed cell by cell in order. What all layers of a face or cell share (wave speeds,
 * reconstructions, the thickness that carries the friction) is in rows on the stack, in the
 * first-level cache. A chunk writes its own cells only, and what it needs of its neighbours it works
 * out again: threads take chunks and wait for each other only between the parts of a step. */
#ifndef TALUS_DRY_H
#define TALUS_DRY_H

#include <stdint.h>

#include "base/kernel.h"
#include "case/grid.h"
#include "linear/pressure_solver.h"
#include "talus/config.h"
#include "talus/model.h"

/* Where a thin layer of grains stops being a flow, m. */
#define DRY_NO_MOMENTUM 1e-10 /* thinner cells keep their mass and carry no momentum */
#define DRY_ONE_LAYER 1e-6    /* thinner cells slide as one layer (P1 Remark 2) */
#define DRY_NO_PRESSURE 1e-5  /* faces next to thinner cells have no non-hydrostatic pressure */

/* Grains are at rest on slopes of up to mu_s (exactly 1 would lose those at the limit) while they are
 * slower than so many delta: what moves then is the regularisation. With a large delta that would be a
 * flow, and nothing is held that is as fast as this. */
#define DRY_REST_SLOPE (1 + 1e-9)
#define DRY_REST_SPEED 100
#define DRY_HELD_SPEED 1e-3 /* m/s */

/* Constants of a run. */
struct dry_parameters {
	double gc;              /* g cos(theta), or g in Cartesian coordinates, m/s2 */
	double tan_slope;       /* tan(theta), 1 */
	double rho;             /* phi_s rho_s, kg/m3 */
	double mu_s, mu_2, i_0; /* a constant law has mu_2 = mu_s */
	double inertia;         /* d_s / sqrt(phi_s): I = inertia |d_z u| / sqrt(p/rho), m */
	double delta_strain, delta_velocity; /* 1/s, m/s */
	double largest_viscosity;            /* over rho sqrt(gc h^3), 1 */
	double walls;                        /* 2 mu_w / W, 1/m; 0: none */
	double bottom_gap; /* part of the lowest layer that the shear at the bottom is taken over, 1 */
	struct friction_choice { /* all false: P1 */
		bool no_slip;        /* the bottom holds the grains: a viscous stress, not Coulomb's */
		bool second_order;   /* strain rate with d_x u, P3 (55) */
		bool bounded;        /* by largest_viscosity instead of delta_strain, P3 (8) */
		bool walls;          /* P1 (36) */
	} friction;
	double bed; /* h_i, m */
	double cfl;
	double front_threshold, static_speed; /* m, m/s */
	bool fastest;                         /* wave speed: max over the layers, not the mean */
	int reconstruction;                   /* enum reconstruction_kind: where dC balances */
	bool upwind;                          /* layers exchange the velocity of the one that gives */
	bool coulomb;                         /* friction slows down or stops one layer (P2) */
	int viscosity_updates;                /* times that step 2 is done again */
	bool plain_thickness;                 /* friction is carried by h, not by P1 (25) */
	bool non_hydrostatic;
};

/* A pressure operator assembles the system of the projection from the state of a column of layers. */
struct pressure_input {
	const struct grid *grid;
	int layers;
	double dt;
	const double *h, *b; /* rows of cells */
	const double *u, *w; /* velocities, [layers][stride] */
	const bool *dry;     /* [faces], true: q~ = 0 there */
	double *const *rows; /* six scratch rows of faces */
};

struct pressure_operator {
	const char *name;
	bool symmetric;
	/* Right side and matrix: bands where the system has them, the cells of a symmetric one. */
	void (*assemble)(const struct pressure_input *input, struct pressure_system *system);
};

extern const struct pressure_operator operator_symmetric, operator_pointwise;

/* One elliptic problem: the full one, or the coarse one behind the first guess (P1 4.1). */
struct projection {
	int layers;
	struct pressure_system system;
	void *memory;  /* of the solver */
	double *u, *w; /* layer averages, [layers][stride]; NULL in the full problem */
};

struct model_state {
	struct dry_parameters par;
	struct grid grid;
	int layers;
	int threads;     /* that share the chunks */
	int chunk_cells; /* in a chunk at most, a multiple of LANES */

	/* The exact state. */
	double *h;    /* thickness, [stride], m */
	double *U;    /* h u_a, [layers][stride], m2/s */
	double *W;    /* h w_a, [layers][stride], m2/s */
	double *q;    /* p_nh/rho below layer a, [layers][faces], m2/s2 */
	double *dq;   /* the last fluctuation of q, [layers][faces], m2/s2 */
	double *mass; /* [2], initial mass and what has left through the ends, kg/m */

	/* What the energy is held against, counted from the lowest point of the bed (check.c). */
	struct {
		double base;        /* height of that point above the right end of the plane, m */
		double most;        /* what a kilogram can have, m2/s2 */
		double first;       /* at time 0, J/m */
		double least, rise; /* since grains last came in, and the largest rise from there, J/m; both
		                       since the state was made or restored */
	} energy;
	char remedy[192]; /* what may help a run that fails with these settings */

	double *b; /* bed above the reference plane, [stride], m */
	double *
		bed; /* what d_x b of the pressure force is of: b, or with the plane in Cartesian coordinates */

	/* Velocities u_a, w_a: at t^n through transport and friction, then of the new state,
	 * [layers][stride], m/s. */
	double *u, *w;
	double *mean;    /* u over the layers, [stride], m/s */
	double *fastest; /* largest |u| of the layers, [stride], m/s */
	double *squares; /* sum of u^2 + w^2 over the layers, [stride], m2/s2 */

	double *next;        /* thickness after transport, [stride], m */
	double end_flux[2];  /* of mass at the ends in the last step, m2/s */
	const double *force; /* the pressure whose force is being added */
	double *face[6];     /* scratch rows of faces, [faces] */
	double *work;        /* scratch of friction, [layers][stride] */
	double *before;      /* U before friction, [layers][stride]; NULL without viscosity_updates */
	bool *dry;           /* [faces], q is 0 there */

	const struct pressure_operator *operator_;
	const struct pressure_solver *solver;
	struct stopping_rule rule;
	bool start_previous;
	struct projection full, coarse; /* coarse.layers = 0: no coarse guess */

	/* Of the last step. */
	double cpu[3]; /* transport, friction, pressure, s */
	int iterations, coarse_iterations;
	double residual;
	int method; /* enum method_kind that solved the full system; 0 before the first step */

	double *level; /* of interface a in mean layers, [layers + 1]: a where all are equal, 1 */
	double *x, *layer_middle, *layer_interface; /* axes of the run file */
	/* The exact steady flow of the initial height, dry_exact; NaN where that is not uniform. */
	double *steady_u, *steady_strain, *steady_mu; /* [layers], m/s; [layers + 1], 1/s and 1 */
	double *memory;
};

/* Thickness of a layer in mean layers: exactly 1 where all are equal. */
static inline double dry_layer(const struct model_state *s, int a)
{
	return s->level[a + 1] - s->level[a];
}

/* 1/l_a, and that of what the shear at the bottom is taken over. */
static inline double dry_layers_of(const struct model_state *s, int a)
{
	return s->layers / dry_layer(s, a);
}

static inline double dry_bottom_layers(const struct model_state *s)
{
	return dry_layers_of(s, 0) / s->par.bottom_gap;
}

/* mu(I) of P1 2.1, from the shear |d_z u| in 1/s and p/rho in m2/s2. */
KERNEL_PART double dry_mu(const struct dry_parameters *par, double shear, double p)
{
	/* I = d |d_z u| sqrt(rho_s/p); at p = 0 the largest friction, and no stress either way */
	double inertia = par->inertia * shear;

	return par->mu_s +
		   (par->mu_2 - par->mu_s) * inertia / (par->i_0 * __builtin_sqrt(p) + inertia + 1e-300);
}

/* Beside a cell of thickness `h` on a bed `b`: does the bed of the other cell stand out of the grains, dry? */
KERNEL_PART bool dry_emerges(double h, double b, double other_h, double other_b)
{
	return (other_h <= DRY_NO_MOMENTUM) & (h + b < other_b);
}

/* Velocities from discharges, zero where the cell is dry, with ghosts; and what their layers sum up to. */
void dry_velocities(struct model_state *s);

/* Set the cells under DRY_NO_PRESSURE back to slow: U and W times a factor that vanishes with h. */
void dry_damp(struct model_state *s);

/* Step 1 (P1 18-22): advance h, U, W explicitly; u, w stay those of t^n. */
void dry_transport(struct model_state *s, double dt);

/* Step 2 (P1 23-25): friction between the layers and at the bottom, implicit with frozen viscosity. */
void dry_friction(struct model_state *s, double dt);

/* What friction takes from the flow now, with the coefficients of step 2 (P1 Theorem 1): at the bottom,
 * or between the layers, [cells], W/m2. */
void dry_dissipation(const struct model_state *s, bool between_layers, double *values);

/* Step 3 (P1 26-33): make the velocity free of divergence. EX_FAILED when the solver does not
 * converge. */
int dry_pressure(struct model_state *s, double dt, struct error *err);

/* Add dt T(p) to U and W (P1 9b, 9c), with p a [layers][faces] field in p/rho units. */
void dry_add_pressure_force(struct model_state *s, const double *p, double dt);

/* The velocities at the middle of the layers [layers], and the strain rates and mu(I) at the interfaces
 * [layers + 1], of the steady uniform flow of thickness h. NaN where grains would gain speed for ever. */
void dry_exact(const struct model_state *s, double h, double *u, double *strain, double *mu);

/* Note what may help where these settings fail. */
void dry_note_remedy(struct model_state *s, const struct config *config);

/* Note what the energy of the state at time 0 allows; and begin to watch a state that was restored. */
void dry_check_begin(struct model_state *s, const struct config *config);
void dry_check_again(struct model_state *s);

/* P1 Theorem 1 times rho, summed over the domain and counted from `base` above the right end of the plane, J/m. */
double dry_energy(const struct model_state *s, double base, double *kinetic);

/* EX_FAILED where the numbers of the last step are no longer a flow. */
int dry_check(struct model_state *s, struct error *err);

/* The energy rose where it cannot: what to say of it. */
bool dry_doubt(const struct model_state *s, char text[MODEL_DOUBT_SIZE]);

/* Series and profiles (observe.c), as struct model describes them. */
enum { DRY_SERIES_COUNT = 18, DRY_PROFILE_COUNT = 13 };
extern const struct series dry_series[DRY_SERIES_COUNT];
extern const struct profile dry_profiles[DRY_PROFILE_COUNT];
void dry_observe(const struct model_state *s, double *values);
void dry_profile(const struct model_state *s, size_t index, double *values);

/* CPU seconds that a run takes, roughly. */
double dry_cost(const struct config *config);

#endif
