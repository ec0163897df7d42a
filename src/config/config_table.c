#include "config/config_table.h"

#include <math.h>

#include "talus/config.h"

/* A key is the path of its member, but for `operator`, which C++ keeps for itself. */
#define AT(member) offsetof(struct config, member)
#define GROUP(key, flags, meaning)                                                                 \
	{                                                                                              \
#key, FIELD_GROUP, flags, 0, NULL, NULL, NULL, NULL, meaning, NULL                         \
	}
#define REAL(key, flags, unit, value, range, meaning)                                              \
	{                                                                                              \
#key, FIELD_REAL, flags, AT(key), unit, value, range, NULL, meaning, NULL                  \
	}
#define REALS(key, flags, unit, value, range, meaning)                                             \
	{                                                                                              \
#key, FIELD_REALS, flags, AT(key), unit, value, range, NULL, meaning, NULL                 \
	}
#define POINTS(key, flags, meaning)                                                                \
	{                                                                                              \
#key, FIELD_POINTS, flags, AT(key), "m", "[]", "[-1000 km, 1000 km]", NULL, meaning, NULL  \
	}
#define INTEGER(key, flags, value, range, meaning)                                                 \
	{                                                                                              \
#key, FIELD_INTEGER, flags, AT(key), NULL, value, range, NULL, meaning, NULL               \
	}
#define CHOICE(key, member, flags, value, choices, meaning)                                        \
	{                                                                                              \
		key, FIELD_CHOICE, flags, AT(member), NULL, value, NULL, choices, meaning, NULL            \
	}
/* With a default for each model. */
#define CHOICE_BY_MODEL(key, member, flags, values, choices, meaning)                              \
	{                                                                                              \
		key, FIELD_CHOICE, flags, AT(member), NULL, NULL, NULL, choices, meaning, values           \
	}

/* clang-format off */
static const char *const models[] = {
	[MODEL_DRY] = "dry", [MODEL_IMMERSED] = "immersed", NULL};
static const char *const pressures[] = {
	[PRESSURE_HYDROSTATIC] = "hydrostatic", [PRESSURE_NON_HYDROSTATIC] = "non-hydrostatic", NULL};
static const char *const boundaries[] = {
	[BOUNDARY_WALL] = "wall", [BOUNDARY_OUTFLOW] = "outflow", [BOUNDARY_PERIODIC] = "periodic", NULL};
static const char *const shapes[] = {
	[SHAPE_COLUMN] = "column", [SHAPE_HEAP] = "heap", [SHAPE_TRIANGLE] = "triangle",
	[SHAPE_LEVEL] = "level", [SHAPE_CAP] = "cap", [SHAPE_UNIFORM] = "uniform", [SHAPE_FILE] = "file", NULL};
static const char *const coordinates[] = {
	[COORDINATES_LOCAL] = "local", [COORDINATES_CARTESIAN] = "cartesian", NULL};
static const char *const givens[] = {[GIVEN_SAME] = "same", [GIVEN_LOCAL] = "local",
	[GIVEN_CARTESIAN] = "cartesian", NULL};
static const char *const topographies[] = {[TOPOGRAPHY_PLANE] = "plane",
	[TOPOGRAPHY_BUMP] = "bump", [TOPOGRAPHY_RANDOM] = "random", [TOPOGRAPHY_FILE] = "file", NULL};
static const char *const exchanges[] = {
	[EXCHANGE_MEAN] = "mean", [EXCHANGE_UPWIND] = "upwind", NULL};
static const char *const frictions[] = {
	[FRICTION_VISCOUS] = "viscous", [FRICTION_COULOMB] = "coulomb", NULL};
static const char *const thicknesses[] = {
	[THICKNESS_WELL_BALANCED] = "well-balanced", [THICKNESS_PLAIN] = "plain", NULL};
static const char *const laws[] = {
	[LAW_MU_I] = "mu_i", [LAW_CONSTANT] = "constant", [LAW_LINEAR] = "linear", NULL};
static const char *const strain_rates[] = {
	[STRAIN_RATE_FIRST_ORDER] = "first-order", [STRAIN_RATE_SECOND_ORDER] = "second-order", NULL};
static const char *const viscosities[] = {
	[VISCOSITY_DELTA] = "delta", [VISCOSITY_BOUNDED] = "bounded", NULL};
static const char *const wave_speeds[] = {
	[WAVE_SPEED_FASTEST] = "fastest", [WAVE_SPEED_MEAN] = "mean", NULL};
static const char *const reconstructions[] = {
	[RECONSTRUCTION_RESTING] = "resting", [RECONSTRUCTION_STATIC] = "static",
	[RECONSTRUCTION_PRINTED] = "printed", NULL};
static const char *const methods[] = {[METHOD_AUTO] = "auto",
	[METHOD_BLOCK_GAUSS_SEIDEL] = "block-gauss-seidel",
	[METHOD_BLOCK_GAUSS_SEIDEL_FACTORED] = "block-gauss-seidel-factored",
	[METHOD_RED_BLACK_LINE_RELAXATION] = "red-black-line-relaxation",
	[METHOD_CONJUGATE_GRADIENTS] = "conjugate-gradients",
	[METHOD_BLOCK_DIRECT] = "block-direct",
	[METHOD_LAPACK_BAND] = "lapack-band", NULL};
static const char *const operators[] = {
	[OPERATOR_SYMMETRIC] = "symmetric", [OPERATOR_POINTWISE] = "pointwise", NULL};
static const char *const starts[] = {
	[START_ZERO] = "zero", [START_PREVIOUS] = "previous", NULL};
static const char *const criteria[] = {
	[CRITERION_RESIDUAL] = "residual", [CRITERION_INCREMENT] = "increment", NULL};
static const char *const norms[] = {
	[NORM_L1] = "l1", [NORM_L2] = "l2", [NORM_LINF] = "linf", NULL};
static const char *const preserved[] = {
	[PRESERVED_GRANULAR_MASS] = "granular-mass", [PRESERVED_HEIGHT] = "height", NULL};
static const char *const bottoms[] = {
	[BOTTOM_NO_SLIP] = "no-slip", [BOTTOM_FRICTION] = "friction", NULL};
static const char *const usual_bottoms[] = {
	[MODEL_DRY] = "friction", [MODEL_IMMERSED] = "no-slip"};
static const char *const interfaces[] = {
	[INTERFACE_BACKWARD] = "backward", [INTERFACE_MEAN] = "mean", NULL};
static const char *const switches[] = {[SWITCH_ON] = "on", [SWITCH_OFF] = "off", NULL};
static const char *const time_schemes[] = {
	[TIME_SCHEME_TR_BDF2] = "tr-bdf2", [TIME_SCHEME_SEMI_IMPLICIT] = "semi-implicit", NULL};

/* Of which model a row is, where it is not of all. */
enum { DRY = FIELD_ONLY(MODEL_DRY), IMMERSED = FIELD_ONLY(MODEL_IMMERSED), LEADING = FIELD_LEADING };

static const struct field fields[] = {
	CHOICE("model", model, 0, "dry", models,
		"what flows: dry: grains in layers (P1); immersed: grains in a fluid, uniform along x (P4)"),
	CHOICE("pressure", pressure, DRY | LEADING, "non-hydrostatic", pressures,
		"whether the vertical acceleration acts on the pressure"),
	REAL(slope, FIELD_REQUIRED | LEADING, "rad", "22 deg", "[0 deg, 90 deg)",
		"angle of the reference plane, positive downhill in +x"),
	REAL(erodible_bed_thickness, FIELD_REQUIRED | DRY | LEADING, "m", "1.82 mm", "[0, 1000 km]",
		"grains at rest under and before the initial shape (h_i); 0: a rigid bed"),
	CHOICE("coordinates", coordinates, DRY, "local", coordinates,
		"local: along and normal to the reference plane; cartesian: horizontal and vertical, with the "
		"plane as part of the bed (P2 4.1)"),
	INTEGER(layers, FIELD_REQUIRED | LEADING, "10", "[1, 512]",
		"layers from the bed to the surface (N)"),
	REALS(layer_fractions, FIELD_UNSORTED, "1", "[]", "[1e-6, 1]",
		"thickness of each layer from the bed up, as a share of the whole; []: equal"),
	INTEGER(n_ini_guess, DRY | LEADING, "0", "[0, 511]",
		"layers of the coarse system behind the first pressure guess; divides layers; 0: none"),

	CHOICE("preserves", preserves, IMMERSED | LEADING, "granular-mass", preserved,
		"what stays as it is while the grains dilate: granular-mass (PGM of P4), or height (PH)"),
	CHOICE_BY_MODEL("bottom", bottom, 0, usual_bottoms, bottoms,
		"shear of the lowest layer: over half of it (no-slip), or all of it (friction, in the dry model Coulomb's)"),
	CHOICE("drag", drag, IMMERSED, "on", switches,
		"drag between grains and fluid in the momentum equations"),

	GROUP(domain, DRY, "the grid along the plane"),
	REAL(domain.x_min, DRY, "m", "-0.2 m", "[-1000 km, 1000 km]", "left end"),
	REAL(domain.x_max, DRY, "m", "3 m", "[-1000 km, 1000 km]", "right end, beyond x_min"),
	INTEGER(domain.cells, DRY | LEADING, "640", "[2, 1000000]", "cells of equal width between the ends"),
	CHOICE("domain.left", domain.left, DRY, "wall", boundaries, "what the left end is; outflow: open, the flow goes on beyond it as it is there, also inwards; periodic: both or neither"),
	CHOICE("domain.right", domain.right, DRY, "outflow", boundaries, "what the right end is"),

	GROUP(topography, DRY, "the bed above the reference plane"),
	CHOICE("topography.shape", topography.shape, DRY, "plane", topographies,
		"plane: nothing above it; bump: the valley of P1 5.4; random: the rough bed of P1 5.3; file: points"),
	CHOICE("topography.coordinates", topography.coordinates, DRY, "same", givens,
		"in which bed and initial shape are given: above the plane, in those of the run (same) or local "
		"ones, or as heights over a horizontal datum (cartesian); they are changed into those of the run"),
	REAL(topography.plane_height, DRY, "m", "0 m", "[-1000 km, 1000 km]",
		"of the reference plane at x_max, over the datum of cartesian heights"),
	REAL(topography.bump, DRY, "m", "0.3 m", "[0, 1000 km]", "height of the bump at x = 1 m (kappa of P1 5.4)"),
	REAL(topography.roughness, DRY, "m", "0.15 m", "[0, 1000 km]", "largest height that random adds to a cell"),
	INTEGER(topography.seed, DRY, "1", "[1, inf)", "of the random heights"),
	POINTS(topography.points, DRY, "x and bed of shape file, linear between them; a file is beside the config"),

	GROUP(initial, 0, "the grains at rest at time 0"),
	CHOICE("initial.shape", initial.shape, DRY, "column", shapes,
		"column: one height from the left end to the front; heap: height exp(-((x - centre)/width)^2); "
		"triangle: a horizontal surface behind a vertical front (P2 4.1); level: a surface through height at "
		"centre; cap: that of P1 5.4; uniform: one height everywhere; file: points"),
	REAL(initial.height, 0, "m", "0.14 m", "(0, 1000 km]", "height of the column, or of the heap's top, above the bed layer, of a level surface or cap, or of the mixture"),
	REAL(initial.front, DRY, "m", "0 m", "[-1000 km, 1000 km]", "position of the gate, between x_min and x_max"),
	REAL(initial.centre, DRY, "m", "0 m", "[-1000 km, 1000 km]", "of the heap or cap; where a level surface has its height"),
	REAL(initial.width, DRY, "m", "0.5 m", "(0, 1000 km]", "of the heap: where its height has fallen to 1/e"),
	REAL(initial.surface_slope, DRY, "rad", "0 deg", "(-90 deg, 90 deg)",
		"of a level surface against the x axis, positive downhill in +x"),
	POINTS(initial.points, DRY, "x and thickness of shape file, linear between them and 0 beyond"),
	REAL(initial.solid_fraction, IMMERSED | LEADING | FIELD_REQUIRED, "1", "0.592", "(0, 1)",
		"volume share of the grains: loose or dense (phi_0)"),

	GROUP(gate, DRY, "what the gate does as it opens"),
	REAL(gate.speed, DRY, "m/s", "0 m/s", "[0, 100]",
		"upward velocity of the grains behind it at time 0 (V_b of P2 30); 0: they are at rest"),
	REAL(gate.width, DRY, "m", "25 mm", "(0, 1000 km]", "how far behind it they have that velocity"),

	GROUP(grains, 0, "the material"),
	REAL(grains.diameter, 0, "m", "0.7 mm", "(0, 1000 km]", "grain diameter (d_s)"),
	REAL(grains.density, 0, "kg/m3", "2500 kg/m3", "(0, 1e6 kg/m3]", "density of a grain (rho_s)"),
	REAL(grains.solid_fraction, DRY, "1", "0.62", "(0, 1]", "volume share of the grains (phi_s)"),

	GROUP(fluid, IMMERSED, "what fills the space between the grains"),
	REAL(fluid.density, IMMERSED | FIELD_REQUIRED, "kg/m3", "1026 kg/m3", "(0, 1e6 kg/m3]",
		"density, below that of a grain (rho_f)"),
	REAL(fluid.viscosity, IMMERSED | LEADING | FIELD_REQUIRED, "Pa s", "9.8e-3 Pa s", "(0, 1e6 Pa s]",
		"viscosity (eta_f)"),

	GROUP(rheology, 0, "friction of the moving grains"),
	CHOICE("rheology.law", rheology.law, 0, "mu_i", laws,
		"mu_i: mu = mu_s + (mu_2 - mu_s) I/(I + i_0), I the inertial number; constant (dry only): "
		"mu = mu_s; linear (immersed only): mu = mu_s + k_1 I"),
	CHOICE("rheology.strain_rate", rheology.strain_rate, DRY, "first-order", strain_rates,
		"first-order: |d_z u|; second-order: sqrt((d_z u)^2 + 4 (d_x u)^2), P3 (55), its C-MSM"),
	REAL(rheology.mu_s, 0, "1", "tan(25.5 deg)", "(0, 1e6]", "friction coefficient at rest"),
	REAL(rheology.mu_2, 0, "1", "tan(36 deg)", "(0, 1e6]",
		"friction coefficient of fast flow, at least mu_s"),
	REAL(rheology.i_0, 0, "1", "0.279", "(0, 1e6]", "inertial number half way between the two"),
	REAL(rheology.k_1, IMMERSED, "1", "90.5", "[0, 1e6]", "slope of the linear law (K_1)"),

	GROUP(dilatancy, IMMERSED, "dilatation of the sheared grains, P4 (10)"),
	REAL(dilatancy.k, IMMERSED, "1", "4.09", "[0, 1e6]", "dilatation constant (K)"),
	REAL(dilatancy.k_2, IMMERSED, "1", "25", "[0, 1e6]",
		"how the equilibrium fraction falls with the inertial number (K_2)"),
	REAL(dilatancy.critical_fraction, IMMERSED, "1", "0.582", "(0, 1)",
		"equilibrium fraction at rest (phi_c^stat)"),
	CHOICE("dilatancy.interface_fraction", dilatancy.interface_fraction, IMMERSED, "backward",
		interfaces,
		"phi in the stress between two layers: of the upper one (backward), or their mean, as in "
		"P4's tables"),

	GROUP(walls, 0, "side walls of a channel, P1 (36), P4 (42)"),
	REAL(walls.mu_w, 0, "1", "0", "[0, 1e6]", "friction coefficient (mu_w); 0: no walls"),
	REAL(walls.width, 0, "m", "0.1 m", "(0, 1000 km]", "width of the channel (W)"),

	GROUP(regularisation, 0, "the papers' delta: keeps friction finite where nothing moves"),
	CHOICE("regularisation.viscosity", regularisation.viscosity, DRY, "delta", viscosities,
		"what keeps the viscosity finite: strain_rate (delta), or largest_viscosity, as P3 (8) (bounded)"),
	REAL(regularisation.largest_viscosity, DRY, "1", "250", "(0, 1e12]",
		"with viscosity bounded: the largest, over rho sqrt(g cos(slope) h^3)"),
	REAL(regularisation.strain_rate, 0, "1/s", "1e-5 1/s", "[1e-15, 1e6 1/s]", "in the viscosity"),
	REAL(regularisation.velocity, 0, "m/s", "1e-5 m/s", "[1e-15, 1e6 m/s]", "in the bottom friction"),

	GROUP(time, 0, "how far and in what steps"),
	REAL(time.end, LEADING, "s", "3 s", "(0, 1e9 s]", "simulated time at which the run is complete"),
	REAL(time.cfl, DRY | LEADING, "1", "0.7", "[1e-6, 1]", "share of the largest stable step that is taken; hydrostatic fronts need 0.1 to 0.3"),
	CHOICE("time.wave_speed", time.wave_speed, DRY, "fastest", wave_speeds,
		"velocity that limits the step: fastest layer, or mean over the layers (P1 eq. 14)"),

	CHOICE("time.scheme", time.scheme, IMMERSED | LEADING, "tr-bdf2", time_schemes,
		"tr-bdf2: implicit, second order, steps by error; semi-implicit: as P4 3.4.4"),
	REAL(time.tolerance, IMMERSED | LEADING, "1", "1e-4", "[1e-10, 0.1]",
		"relative error that a step of tr-bdf2 may make"),
	REAL(time.step, IMMERSED, "s", "1e-5 s", "(0, inf)",
		"time step of semi-implicit; the drag allows some 1.4e-5 s at low viscosity"),

	GROUP(scheme, DRY, "readings of the discretisation"),
	CHOICE("scheme.friction_reconstruction", scheme.friction_reconstruction, DRY, "resting",
		reconstructions,
		"where friction balances the slope in P1 (21): resting: only at rest, and nothing passes between cells at "
		"rest (below the angle of repose, slower than 100 delta and 1 mm/s), so that heaps keep their shape; "
		"static: only at rest; printed: also in motion"),
	CHOICE("scheme.exchange", scheme.exchange, DRY, "mean", exchanges,
		"velocity of what two layers exchange: the mean of both (P1), or of the layer that gives (upwind), which "
		"hydrostatic layers need to survive a bore"),
	CHOICE("scheme.friction", scheme.friction, DRY, "viscous", frictions,
		"viscous: implicit with a regularised viscosity (P1 23-25); coulomb: slows one layer down or stops it "
		"(P2 step 2)"),
	CHOICE("scheme.friction_thickness", scheme.friction_thickness, DRY, "well-balanced", thicknesses,
		"thickness that carries the friction: well-balanced: P1 (25); plain: h (P1 Table 6b)"),
	INTEGER(scheme.viscosity_updates, DRY, "0", "[0, 100]",
		"how often step 2 is done again with the viscosity of its own result; 0: frozen as P1; with "
		"1 or 2 hydrostatic runouts hardly depend on time.cfl"),

	GROUP(pressure_solver, DRY, "the linear system of the non-hydrostatic pressure"),
	CHOICE("pressure_solver.method", pressure_solver.method, DRY, "auto", methods,
		"auto: conjugate-gradients or block-direct, by what the last steps cost (the former with periodic ends); "
		"block-gauss-seidel: as P1; lapack-band: bits depend on the machine"),
	CHOICE("pressure_solver.operator", pressure_solver.operator_, DRY, "symmetric", operators,
		"discrete operator: symmetric, or pointwise as P1 Appendix A (for its tables)"),
	CHOICE("pressure_solver.start", pressure_solver.start, DRY, "zero", starts,
		"first guess of the fluctuation where n_ini_guess is 0: zero, or that of the previous step"),
	CHOICE("pressure_solver.criterion", pressure_solver.criterion, DRY, "residual", criteria,
		"what stops the iteration: the true residual, or the increment of a sweep (P1)"),
	REAL(pressure_solver.residual, DRY, "1", "1e-8", "[1e-12, 1)",
		"with criterion residual: the relative residual |b - A x|/|b| at which it stops; smaller "
		"ones are lost in rounding"),
	CHOICE("pressure_solver.norm", pressure_solver.norm, DRY, "l2", norms,
		"norm of a sweep's increment that stops the iteration"),
	REAL(pressure_solver.tolerance, DRY, "m2/s2", "1e-6 m2/s2", "(0, inf)",
		"value of that norm at which it stops"),
	REAL(pressure_solver.relaxation, DRY, "1", "0", "[0, 2)",
		"over-relaxation factor of red-black-line-relaxation; 0: chosen from the number of layers"),
	INTEGER(pressure_solver.max_iterations, DRY, "20000", "[1, inf)",
		"sweeps after which the solver has failed"),

	GROUP(output, 0, "what is recorded; does not touch the steps"),
	REALS(output.profiles_at, 0, "s", "[]", "[0, inf)",
		"times of the stored profiles, at most time.end"),
	REALS(output.gauges, DRY, "m", "[]", "[-1000 km, 1000 km]",
		"positions where the thickness is recorded as often as the series"),
	REALS(output.velocity_at, DRY, "m", "[]", "[-1000 km, 1000 km]",
		"positions where the velocities of all layers are recorded as often as the series"),
	REAL(output.series_every, 0, "s", "0 s", "[0, inf)",
		"simulated time between records of the series; 0: every step"),
	REAL(output.front_threshold, DRY, "m", "0.5 mm", "(0, inf)",
		"thickness above the bed layer where the front is"),
	REAL(output.static_speed, DRY, "m/s", "0.01 m/s", "(0, inf)",
		"a layer slower than this counts as at rest"),
	REAL(output.steady_surface, IMMERSED, "m", "1e-9 m", "[1e-12, inf)",
		"grains above the depth at which the exact steady flow with walls begins; 1e-6 m in P4"),

	GROUP(checkpoint, FIELD_PASSIVE, "how much work a lost machine can cost"),
	REAL(checkpoint.every, FIELD_PASSIVE, "s", "30 s", "[0, inf)",
		"wall clock between checkpoints; 0: off"),
	INTEGER(checkpoint.every_steps, FIELD_PASSIVE, "0", "[0, inf)",
		"steps between checkpoints; 0: off"),

	INTEGER(threads, DRY | FIELD_PASSIVE, "1", "[1, 256]",
		"processors that share one run; does not change its numbers"),
};
/* clang-format on */

bool config_symmetric_only(int method)
{
	return method == METHOD_CONJUGATE_GRADIENTS || method == METHOD_BLOCK_DIRECT;
}

bool config_periodic_too(int method)
{
	return method == METHOD_AUTO || method == METHOD_CONJUGATE_GRADIENTS;
}

bool config_bed_is_absolute(const struct config *config)
{
	return config->topography.coordinates == GIVEN_CARTESIAN ||
		   config->topography.shape == TOPOGRAPHY_BUMP;
}

bool config_bed_is_given_here(const struct config *config)
{
	int given = config->topography.coordinates;

	return given == GIVEN_SAME || config->slope <= 0 ||
		   (given == GIVEN_CARTESIAN) == (config->coordinates == COORDINATES_CARTESIAN);
}

double config_bed_thickness(const struct config *config)
{
	double given = config->erodible_bed_thickness, cos_slope = (double)cosl(config->slope);

	if (config_bed_is_given_here(config))
		return given;
	return config->coordinates == COORDINATES_LOCAL ? given * cos_slope : given / cos_slope;
}

const struct field_table config_table = {fields, sizeof fields / sizeof *fields, "model"};
