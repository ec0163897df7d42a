/* Uniform two-phase flows of grains in a fluid with dilatancy (P4 3.4): the state and what its parts
 * share. Letters follow the paper, but for theta, which is positive downhill here.
 *
 * Layers are counted from 0 at the bottom. Interface a is the one below layer a, interface N the
 * surface of the mixture, which carries no solid stress. */
#ifndef TALUS_IMMERSED_H
#define TALUS_IMMERSED_H

#include <stdbool.h>

#include "linear/block_tridiagonal.h"
#include "talus/config.h"
#include "talus/model.h"

/* Constants of a run. */
struct immersed_parameters {
	double pull;         /* (rho_s - rho_f) g sin(theta): drives the grains downhill, Pa/m */
	double weight;       /* (rho_s - rho_f) g cos(theta): presses them together, Pa/m */
	double tan_slope;    /* 1 */
	double rho_s, rho_f; /* kg/m3 */
	double eta;          /* eta_f, Pa s */
	double drag;         /* 150 eta_f/d_s^2 in the momentum equations, or 0, Pa s/m2 */
	double seepage;      /* 150 eta_f/d_s^2 in the pore pressure, Pa s/m2 */
	bool linear;         /* mu = mu_s + K_1 I, else mu(I) */
	double mu_s, k_1, mu_2, i_0;
	double k, k_2, phi_c; /* dilatancy: K, K_2, phi_c^stat */
	double wall;          /* 2 mu_w/W, 1/m */
	double lambda;        /* P4 (21): 2 without slip, 1 with friction */
	bool backward;   /* phi at an interface is that of the layer above, else the mean of the two */
	bool keeps_mass; /* PGM, else PH */
	double delta_strain, delta_velocity; /* 1/s, m/s */
};

/* One value per layer of each unknown. */
struct immersed_column {
	double *phi; /* volume share of the grains, 1 */
	double *v;   /* velocity of the grains, m/s */
	double *u;   /* velocity of the fluid, m/s */
	double *p;   /* solid pressure at the interface below, Pa */
	double *S;   /* sum of phi h Phi from the bottom up to this layer, m/s */
};

enum { IMMERSED_PHI, IMMERSED_V, IMMERSED_U, IMMERSED_P, IMMERSED_S, IMMERSED_UNKNOWNS };

/* A way through time; a row of the table in model.c. */
struct immersed_scheme {
	const char *name;
	/* What the state holds beyond the flow at rest, before the first step. */
	void (*begin)(struct model_state *s);
	/* The step that is next, s. */
	double (*time_step)(const struct model_state *s);
	/* Advance by at most dt and put what was taken into s->taken. EX_FAILED leaves the state alone. */
	int (*step)(struct model_state *s, double dt, struct error *err);
};

extern const struct immersed_scheme scheme_tr_bdf2, scheme_semi_implicit;

/* How the steps went; part of the exact state. */
struct immersed_record {
	double next;              /* step that the error control asks for, s */
	double steps;             /* taken */
	double rejected;          /* tried and not taken */
	double newton_iterations; /* of all steps */
};

struct model_state {
	struct immersed_parameters par;
	int layers;
	double *l;    /* share of the height of each layer, [layers] */
	double mass;  /* sum of l phi h at t = 0, m */
	double depth; /* h at t = 0, m */
	const struct immersed_scheme *scheme;
	double tolerance, fixed_step;
	double steady_surface; /* F at the surface of the exact flow with walls, m */

	/* The exact state. */
	struct immersed_column now;
	double *rates; /* d/dt of phi, v, u, [3][layers] */
	struct immersed_record record;

	double taken; /* length of the last step, s */

	struct immersed_column trial, known; /* scratch of the implicit stages */
	double *work[8];                     /* scratch, [layers + 1] */
	struct block_tridiagonal blocks;
	double *right; /* right side and solution, [layers][unknowns] */
	double *layer_middle, *layer_interface;
	double *memory;
};

/* What happens at an interface below a layer (flow.c), and how it changes with phi, v and p there. */
struct immersed_interface {
	double shear; /* V of P4 (21), 1/s */
	double slope; /* d shear/dv, 1/m */
	double X;     /* phi h Phi of the layer above it, m/s */
	double X_phi, X_shear, X_p;
	double stress; /* solid, against the flow of the layer above it, Pa */
	double stress_phi, stress_shear, stress_p; /* stress_phi: by phi of the interface */
};

void immersed_interface(const struct model_state *s, const struct immersed_column *c, double h,
	int a, struct immersed_interface *out);

/* Height of the mixture with these phi, m: exact in both models. */
double immersed_height(const struct model_state *s, const double *phi);

/* Distance over which the shear at the interface below layer a is taken, m. */
static inline double immersed_spacing(const struct model_state *s, double h, int a)
{
	return a ? 0.5 * (s->l[a] + s->l[a - 1]) * h : s->l[0] * h / s->par.lambda;
}

/* A_a of P4 3.4.4 over h: how dilatancy below acts on the pressure, Pa s/m2. */
static inline double immersed_seepage(const struct immersed_parameters *par, double phi)
{
	double voids = 1 - phi;

	return par->seepage * phi / (voids * voids * voids);
}

/* Inertial number, P4 (22); 0 where nothing presses. */
static inline double immersed_inertia(const struct immersed_parameters *par, double shear, double p)
{
	double speed = par->eta * __builtin_fabs(shear);

	return speed > 0 ? speed / p : 0;
}

/* mu of P4 (5) or (7). */
static inline double immersed_mu(const struct immersed_parameters *par, double inertia)
{
	return par->linear ? par->mu_s + par->k_1 * inertia
					   : par->mu_s + (par->mu_2 - par->mu_s) * inertia / (par->i_0 + inertia);
}

/* One Newton iteration on (45) from the pressure `from`, which is the paper's linearisation: p and S
 * of `c` from its phi and v. */
void immersed_pressure(
	const struct model_state *s, struct immersed_column *c, double h, const double *from);

/* The root of (45) in c->p and c->S, from c->p, to rounding. Returns the iterations, or -1. */
int immersed_pressure_exact(const struct model_state *s, struct immersed_column *c, double h);

/* The equations of an implicit stage x = known + w dx/dt with the pressure (newton.c): minus the
 * residual into s->right, and the Jacobian into s->blocks. */
void immersed_assemble(struct model_state *s, const struct immersed_column *x,
	const struct immersed_column *known, double w);

/* Units of p and S in that system, Pa and m/s. */
void immersed_units(const struct model_state *s, double *p, double *S);

/* Series and profiles (observe.c), as struct model describes them. */
enum { IMMERSED_SERIES_COUNT = 18, IMMERSED_PROFILE_COUNT = 7 };
extern const struct series immersed_series[IMMERSED_SERIES_COUNT];
extern const struct profile immersed_profiles[IMMERSED_PROFILE_COUNT];
void immersed_observe(const struct model_state *s, double *values);
void immersed_profile(const struct model_state *s, size_t index, double *values);

/* The steady flow of the present height (exact.c): averages over each layer of v and phi; NaN where
 * it cannot be computed. */
void immersed_exact(const struct model_state *s, double *v, double *phi);

#endif
