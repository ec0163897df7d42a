/* TR-BDF2 with error control: second order, L-stable, fully implicit in drag, viscosity and pressure
 * (M. E. Hosea, L. F. Shampine, Analysis and implementation of TR-BDF2, Appl. Numer. Math. 20, 1996).
 *
 * As a Runge-Kutta method its stages are at 0, gamma dt and dt; the last is the new state, and its rates
 * are the first stage of the next step. The embedded third order formula gives the error, which passes
 * through the matrix of the last stage so that stiff components do not dominate it. */
#include <math.h>
#include <string.h>

#include "immersed/immersed.h"

#define GAMMA (2 - M_SQRT2)
#define DIAGONAL (GAMMA / 2)
#define WEIGHT (M_SQRT2 / 4)

/* A Newton iteration goes no further than this. */
#define PHI_STEP 0.02     /* change of phi */
#define PRESSURE_DROP 0.2 /* share of p that is left */

#define ITERATIONS 12     /* after which a stage has failed */
#define NEWTON_SHARE 0.01 /* of the error of a step that an iterate may still be off */
#define SAFETY 0.85
#define GROWTH 5
#define SHRINKAGE 0.2
#define FAILURE 0.25   /* factor of the step after a failed stage */
#define SHORTEST 1e-15 /* of a step, in units of the fall time sqrt(h/g) */

/* Speeds below this part of sqrt(g h) need no relative accuracy; phi matters through K (phi - phi_c)
 * beside mu, so that its error counts against this. */
#define SLOW 1e-4
#define PHI_SCALE 0.1

static double fall_time(const struct model_state *s)
{
	return sqrt(s->depth * s->par.rho_s / hypot(s->par.pull, s->par.weight));
}

/* One unit of error in phi and in the speeds. */
struct scale {
	double phi, speed;
};

static struct scale scale_of(const struct model_state *s)
{
	double speed = SLOW * s->depth / fall_time(s);

	for (int a = 0; a < s->layers; a++)
		speed = fmax(speed, fmax(fabs(s->now.v[a]), fabs(s->now.u[a])));
	return (struct scale){s->tolerance * PHI_SCALE, s->tolerance * speed};
}

/* Largest of phi, v, u in s->right, in units of error; NaN stays NaN. */
static double size(const struct model_state *s, const struct scale *scale)
{
	double largest = 0;

	for (int a = 0; a < s->layers; a++) {
		const double *x = s->right + (size_t)a * IMMERSED_UNKNOWNS;
		const double each[] = {x[IMMERSED_PHI] / scale->phi, x[IMMERSED_V] / scale->speed,
			x[IMMERSED_U] / scale->speed};

		for (int i = 0; i < 3; i++)
			if (!(fabs(each[i]) <= largest))
				largest = fabs(each[i]);
	}
	return largest;
}

/* Add the solution of the linear system to s->trial, as far as an iteration may go. Returns whether it
 * went all the way. */
static bool update(struct model_state *s)
{
	double unit_p, unit_S;
	bool whole = true;

	immersed_units(s, &unit_p, &unit_S);
	for (int a = 0; a < s->layers; a++) {
		const double *x = s->right + (size_t)a * IMMERSED_UNKNOWNS;
		double phi = fmax(-PHI_STEP, fmin(PHI_STEP, x[IMMERSED_PHI]));
		double p = s->trial.p[a], next = p + x[IMMERSED_P] * unit_p;

		whole = whole && phi == x[IMMERSED_PHI] && next >= PRESSURE_DROP * p;
		s->trial.phi[a] += phi;
		s->trial.v[a] += x[IMMERSED_V];
		s->trial.u[a] += x[IMMERSED_U];
		s->trial.p[a] = fmax(PRESSURE_DROP * p, next);
		s->trial.S[a] += x[IMMERSED_S] * unit_S;
		whole = whole && s->trial.phi[a] > 0 && s->trial.phi[a] < 1;
	}
	return whole;
}

/* Solve trial = known + w f(trial) from the present trial. */
static int solve(struct model_state *s, double w, const struct scale *scale)
{
	for (int i = 1; i <= ITERATIONS; i++) {
		double change;
		bool whole;

		s->record.newton_iterations++;
		immersed_assemble(s, &s->trial, &s->known, w);
		if (block_tridiagonal_factor(&s->blocks))
			return -1;
		block_tridiagonal_solve(&s->blocks, s->right);
		change = size(s, scale);
		if (!isfinite(change))
			return -1;
		whole = update(s);
		if (whole && change < NEWTON_SHARE)
			return 0;
	}
	return -1;
}

/* known = now + first times the rates of the first stage + second times those of the second. */
static void add_rates(struct model_state *s, double first, double second)
{
	size_t n = (size_t)s->layers;
	const double *from[] = {s->now.phi, s->now.v, s->now.u};
	double *to[] = {s->known.phi, s->known.v, s->known.u};

	for (size_t i = 0; i < 3; i++)
		for (size_t a = 0; a < n; a++)
			to[i][a] = from[i][a] + first * s->rates[i * n + a] + second * s->work[i][a];
}

/* The rates at the stage just solved: from its own equation, which does not amplify its rounding. */
static void take_rates(const struct model_state *s, double w, double *const *rates)
{
	const double *x[] = {s->trial.phi, s->trial.v, s->trial.u};
	const double *known[] = {s->known.phi, s->known.v, s->known.u};

	for (int i = 0; i < 3; i++)
		for (int a = 0; a < s->layers; a++)
			rates[i][a] = (x[i][a] - known[i][a]) / w;
}

/* The error of the step in units of what is allowed. */
static double error_of(struct model_state *s, double dt, const struct scale *scale)
{
	size_t n = (size_t)s->layers;
	double first = WEIGHT - (1 - WEIGHT) / 3, second = WEIGHT - (3 * WEIGHT + 1) / 3;
	double third = DIAGONAL - DIAGONAL / 3;

	for (size_t a = 0; a < n; a++) {
		double *x = s->right + a * IMMERSED_UNKNOWNS;

		for (size_t i = 0; i < 3; i++)
			x[i] = dt * (first * s->rates[i * n + a] + second * s->work[i][a] +
							third * s->work[3 + i][a]);
		x[IMMERSED_P] = x[IMMERSED_S] = 0;
	}
	block_tridiagonal_solve(&s->blocks, s->right);
	return size(s, scale);
}

static void copy_column(
	const struct model_state *s, struct immersed_column *to, const struct immersed_column *from)
{
	/* the five rows of a column lie together */
	memcpy(to->phi, from->phi, (size_t)s->layers * IMMERSED_UNKNOWNS * sizeof *to->phi);
}

/* Both stages of a step of dt, ending in s->trial; `error` in units of what is allowed. */
static int try_step(struct model_state *s, double dt, double *error)
{
	struct scale scale = scale_of(s);
	double w = DIAGONAL * dt;

	copy_column(s, &s->trial, &s->now);
	add_rates(s, w, 0);
	if (solve(s, w, &scale))
		return -1;
	take_rates(s, w, s->work);
	add_rates(s, WEIGHT * dt, WEIGHT * dt);
	if (solve(s, w, &scale))
		return -1;
	take_rates(s, w, s->work + 3);
	*error = error_of(s, dt, &scale);
	return isfinite(*error) ? 0 : -1;
}

static void accept(struct model_state *s, double dt)
{
	size_t n = (size_t)s->layers;

	copy_column(s, &s->now, &s->trial);
	for (size_t i = 0; i < 3; i++)
		memcpy(s->rates + i * n, s->work[3 + i], n * sizeof *s->rates);
	s->record.steps++;
	s->taken = dt;
}

static int step(struct model_state *s, double dt, struct error *err)
{
	double shortest = SHORTEST * fall_time(s), asked = s->record.next;
	bool rejected = false;

	for (;;) {
		double error = INFINITY;
		bool solved = try_step(s, dt, &error) == 0;
		double factor = solved ? SAFETY * cbrt(1 / fmax(error, 1e-9)) : FAILURE;

		factor = fmin(rejected ? 1 : GROWTH, fmax(SHRINKAGE, factor));
		if (solved && error <= 1) {
			accept(s, dt);
			s->record.next = dt * factor;
			/* a step that the run's end has shortened says nothing against a longer one */
			if (!rejected && dt < asked)
				s->record.next = fmax(s->record.next, fmin(asked, dt * GROWTH));
			return 0;
		}
		rejected = true;
		s->record.rejected++;
		dt *= fmin(factor, 0.9);
		if (!(dt > shortest))
			return error_set(err, EX_FAILED,
				"the step has shrunk to %g s, and %s (at the bottom phi = %.6g, v = %.6g m/s, p = %.6g Pa)",
				dt, solved ? "its error is still too large" : "Newton's method still fails",
				s->now.phi[0], s->now.v[0], s->now.p[0]);
	}
}

static double time_step(const struct model_state *s)
{
	return s->record.next;
}

static void begin(struct model_state *s)
{
	size_t n = (size_t)s->layers;

	/* the residual of x = x + f(x) is -f */
	immersed_assemble(s, &s->now, &s->now, 1);
	for (size_t i = 0; i < 3; i++)
		for (size_t a = 0; a < n; a++)
			s->rates[i * n + a] = s->right[a * IMMERSED_UNKNOWNS + i];
	s->record.next = 1e-6 * fall_time(s);
}

const struct immersed_scheme scheme_tr_bdf2 = {"tr-bdf2", begin, time_step, step};
