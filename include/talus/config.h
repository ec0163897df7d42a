/* The configuration of one run, in SI units, as read from YAML. */
#ifndef TALUS_CONFIG_H
#define TALUS_CONFIG_H

#include <stdbool.h>
#include <stdint.h>

#include "talus/error.h"
#include "talus/text.h"

enum model_kind { MODEL_DRY, MODEL_IMMERSED };
enum pressure_kind { PRESSURE_HYDROSTATIC, PRESSURE_NON_HYDROSTATIC };
enum boundary_kind { BOUNDARY_WALL, BOUNDARY_OUTFLOW, BOUNDARY_PERIODIC };
enum shape_kind {
	SHAPE_COLUMN,
	SHAPE_HEAP,
	SHAPE_TRIANGLE,
	SHAPE_LEVEL,
	SHAPE_CAP,
	SHAPE_UNIFORM,
	SHAPE_FILE,
};
enum coordinates_kind { COORDINATES_LOCAL, COORDINATES_CARTESIAN };
enum given_kind { GIVEN_SAME, GIVEN_LOCAL, GIVEN_CARTESIAN };
enum topography_kind { TOPOGRAPHY_PLANE, TOPOGRAPHY_BUMP, TOPOGRAPHY_RANDOM, TOPOGRAPHY_FILE };
enum exchange_kind { EXCHANGE_MEAN, EXCHANGE_UPWIND };
enum friction_kind { FRICTION_VISCOUS, FRICTION_COULOMB };
enum thickness_kind { THICKNESS_WELL_BALANCED, THICKNESS_PLAIN };
enum law_kind { LAW_MU_I, LAW_CONSTANT, LAW_LINEAR };
enum strain_rate_kind { STRAIN_RATE_FIRST_ORDER, STRAIN_RATE_SECOND_ORDER };
enum viscosity_kind { VISCOSITY_DELTA, VISCOSITY_BOUNDED };
enum wave_speed_kind { WAVE_SPEED_FASTEST, WAVE_SPEED_MEAN };
enum reconstruction_kind { RECONSTRUCTION_RESTING, RECONSTRUCTION_STATIC, RECONSTRUCTION_PRINTED };
enum method_kind {
	METHOD_AUTO,
	METHOD_BLOCK_GAUSS_SEIDEL,
	METHOD_BLOCK_GAUSS_SEIDEL_FACTORED,
	METHOD_RED_BLACK_LINE_RELAXATION,
	METHOD_CONJUGATE_GRADIENTS,
	METHOD_BLOCK_DIRECT,
	METHOD_LAPACK_BAND,
};
enum operator_kind { OPERATOR_SYMMETRIC, OPERATOR_POINTWISE };
enum start_kind { START_ZERO, START_PREVIOUS };
enum criterion_kind { CRITERION_RESIDUAL, CRITERION_INCREMENT };
enum norm_kind { NORM_L1, NORM_L2, NORM_LINF };
enum preserved_kind { PRESERVED_GRANULAR_MASS, PRESERVED_HEIGHT };
enum bottom_kind { BOTTOM_NO_SLIP, BOTTOM_FRICTION };
enum interface_kind { INTERFACE_BACKWARD, INTERFACE_MEAN };
enum switch_kind { SWITCH_ON, SWITCH_OFF };
enum time_scheme_kind { TIME_SCHEME_TR_BDF2, TIME_SCHEME_SEMI_IMPLICIT };

/* A short list of numbers. A config is a plain value: the numbers are never changed and never freed. */
struct real_list {
	int count;
	const double *values; /* [count] */
};
enum { REAL_LIST_MAX = 512, POINTS_MAX = 8192 };

/* Keys that the model does not have hold their defaults. */
struct config {
	int model;                     /* enum model_kind */
	int pressure;                  /* enum pressure_kind */
	double slope;                  /* angle of the reference plane, positive downhill in +x, rad */
	double erodible_bed_thickness; /* h_i, m */
	int layers;                    /* N */
	struct real_list layer_fractions; /* l_a from the bed up, sums to 1; empty: equal */
	int coordinates; /* enum coordinates_kind: in which the model is integrated over the depth */
	int n_ini_guess; /* layers of the coarse system behind the first guess; 0: none */
	int preserves;   /* enum preserved_kind: what the mixture keeps (PGM or PH of P4) */
	int bottom; /* enum bottom_kind: how far from the bottom the lowest layer is; lambda of P4 (21) */
	int drag;   /* enum switch_kind: beta (u - v) in the momentum equations */
	struct {
		double x_min, x_max; /* m */
		int cells;
		int left, right; /* enum boundary_kind */
	} domain;
	struct {
		int shape;               /* enum topography_kind */
		int coordinates;         /* enum given_kind: in which bed and grains are given */
		double plane_height;     /* of the reference plane at x_max, over the datum of heights, m */
		double bump;             /* kappa of P1 5.4, m */
		double roughness;        /* largest random height, m */
		int seed;                /* of the random heights */
		struct real_list points; /* of a file: x, b, x, b, m */
	} topography;
	struct {
		int shape;               /* enum shape_kind */
		double height;           /* of the column, the top of the heap, or the mixture, m */
		double front;            /* position of the gate, m */
		double centre;           /* of the heap, m */
		double width;            /* of the heap: where its height has fallen to 1/e, m */
		double surface_slope;    /* of a level surface, positive downhill in +x, rad */
		struct real_list points; /* of a file: x, h, x, h, m */
		double solid_fraction;   /* phi_0, 1 */
	} initial;
	struct {
		double speed; /* of the gate upwards, V_b of P2 (30), m/s; 0: it is gone at once */
		double width; /* of the grains behind it that it takes along, m */
	} gate;
	struct {
		double diameter;       /* d_s, m */
		double density;        /* rho_s, kg/m3 */
		double solid_fraction; /* phi_s, 1 */
	} grains;
	struct {
		double density;   /* rho_f, kg/m3 */
		double viscosity; /* eta_f, Pa s */
	} fluid;
	struct {
		int law;                     /* enum law_kind */
		int strain_rate;             /* enum strain_rate_kind */
		double mu_s, mu_2, i_0, k_1; /* 1 */
	} rheology;
	struct {
		double k, k_2;            /* K and K_2 of P4 (10), 1 */
		double critical_fraction; /* phi_c^stat, 1 */
		int interface_fraction;   /* enum interface_kind: reading of phi in the stress */
	} dilatancy;
	struct {
		double mu_w;  /* friction with the side walls, 1; 0: none */
		double width; /* of the channel, W, m */
	} walls;
	struct {
		int viscosity;            /* enum viscosity_kind: what keeps it finite */
		double largest_viscosity; /* over rho sqrt(g cos(slope) h^3), 1 */
		double strain_rate;       /* delta in the viscosity, 1/s */
		double velocity;          /* delta in the friction with bottom and walls, m/s */
	} regularisation;
	struct {
		double end;       /* s */
		double cfl;       /* 1 */
		int wave_speed;   /* enum wave_speed_kind */
		int scheme;       /* enum time_scheme_kind */
		double tolerance; /* of the error of a step, relative */
		double step;      /* of the schemes with a fixed one, s */
	} time;
	struct {
		int friction_reconstruction; /* enum reconstruction_kind: where dC of P1 (21) balances */
		int exchange;                /* enum exchange_kind: velocity of what layers exchange */
		int friction;                /* enum friction_kind: how step 2 takes it */
		int friction_thickness;      /* enum thickness_kind: what carries the friction, P1 (25) */
		int viscosity_updates;       /* coefficients of step 2 taken anew, times per step */
	} scheme;
	struct {
		int method;         /* enum method_kind */
		int operator_;      /* enum operator_kind; key `operator` */
		int start;          /* enum start_kind */
		int criterion;      /* enum criterion_kind */
		double residual;    /* true relative residual asked for, 1 */
		int norm;           /* enum norm_kind */
		double tolerance;   /* of the increment of a sweep, in p/rho units, m2/s2 */
		double relaxation;  /* over-relaxation factor of a relaxation, 1; 0: by layers */
		int max_iterations; /* sweeps after which the solver is said not to converge */
	} pressure_solver;
	struct {
		struct real_list profiles_at; /* increasing, s */
		struct real_list gauges;      /* where h(t) is recorded, increasing, m */
		struct real_list velocity_at; /* where columns of u and w are, increasing, m */
		double series_every;          /* s; 0: every step */
		double front_threshold;       /* h - h_i at the front, m */
		double static_speed;          /* a layer slower than this is at rest, m/s */
		double steady_surface;        /* int phi where the exact steady flow with walls begins, m */
	} output;
	struct {
		double every;    /* wall clock, s; 0: off */
		int every_steps; /* 0: off */
	} checkpoint;
	int threads; /* that share one run */
};

/* Read a config from a YAML file. `settings` are `count` texts "key=value" with dotted keys
 * (`time.cfl=0.5`) that override the file, in order, as `--set` does. Errors: EX_DATAERR for anything
 * that the file or a setting says wrongly (with file, line and column, or citing --set), EX_NOINPUT is
 * reported as EX_DATAERR too, EX_SOFTWARE out of memory. */
int config_read(struct config *config, const char *path, const char *const *settings, int count,
	struct error *err);

/* The same from text in memory; `name` stands for the file in messages. */
int config_parse(struct config *config, const char *text, size_t length, const char *name,
	const char *const *settings, int count, struct error *err);

/* Does this method (enum method_kind) solve the symmetric operator alone? */
bool config_symmetric_only(int method);

/* Does it solve systems with periodic ends? */
bool config_periodic_too(int method);

/* Are bed and grains given as heights over a horizontal datum (else above the reference plane)? And in the
 * coordinates of the run (else they are changed into them)? */
bool config_bed_is_absolute(const struct config *config);
bool config_bed_is_given_here(const struct config *config);

/* h_i in the coordinates of the run, m: a layer normal to the plane is thicker along the vertical. */
double config_bed_thickness(const struct config *config);

/* The same from a text that is parsed already: one base for many configs. `name` must be that of
 * the text. */
struct node;
int config_from_node(struct config *config, const struct node *root, const char *name,
	const char *const *settings, int count, struct error *err);

/* The config as YAML in SI units with every key; config_parse reads it back to the same bits. */
void config_print(const struct config *config, struct text *out);

/* The annotated reference config of a model: every key with default, unit, range or choices and
 * meaning. EX_USAGE: no model is called so. */
int config_print_reference(const char *model, struct text *out, struct error *err);

/* A line for each of the keys that tell at once what is simulated: "  layers    10". */
void config_print_leading(const struct config *config, struct text *out);

/* 16 hexadecimal digits of what can change numbers: every key except `checkpoint`, `threads`. */
enum { CONFIG_HASH_SIZE = 17 };
int config_hash(const struct config *config, char hash[CONFIG_HASH_SIZE], struct error *err);

/* Name, per line, every key (except `checkpoint` and `threads`) whose value differs:
 * "layers: 10 -> 20". */
void config_differences(const struct config *a, const struct config *b, struct text *out);

/* Whether a dotted key names a value (not a group), and whether that is a whole number. */
bool config_is_key(const char *key);
bool config_is_whole(const char *key);

/* The value of a dotted key as config_print writes it, without the key. EX_DATAERR with the nearest
 * known key for an unknown one, for a group, or for a key that the model does not have. */
int config_value(const struct config *config, const char *key, struct text *out, struct error *err);

/* Whether some config has a value of that key. EX_DATAERR as config_value for one that none has. */
int config_check_key(const char *key, struct error *err);

#endif
