/* Step 3: the projection onto velocities free of divergence (P1 26-33), with the first guess from a
 * coarse system (P1 4.1). */
#include <math.h>
#include <string.h>

#include "dry/dry.h"

/* Faces without non-hydrostatic pressure: open ends, and next to a cell that is nearly dry. */
static void mark_dry(struct model_state *s)
{
	const struct grid *grid = &s->grid;

	for (int f = 0; f < grid->faces; f++)
		s->dry[f] = s->h[f] < DRY_NO_PRESSURE || s->h[f + 1] < DRY_NO_PRESSURE;
	if (s->operator_ == &operator_symmetric) { /* the other has the rows of P1 (37) there */
		s->dry[0] |= !grid->left_wall && !grid->periodic;
		s->dry[grid->cells] |= !grid->right_wall && !grid->periodic;
	}
}

static void assemble(struct model_state *s, struct projection *problem, double dt)
{
	const struct grid *grid = &s->grid;
	struct pressure_input input = {
		.grid = grid,
		.layers = problem->layers,
		.dt = dt,
		.h = s->h,
		.b = s->bed,
		.u = problem->u ? problem->u : s->u,
		.w = problem->w ? problem->w : s->w,
		.dry = s->dry,
		.rows = s->face,
	};

	problem->system.cells.dry = s->dry;
	s->operator_->assemble(&input, &problem->system);
	for (int f = 0; f < grid->faces; f++)
		problem->system.weight[f] = 0.5 * (s->h[f] + s->h[f + 1]) * grid->dx / problem->layers;
	if (grid->periodic) { /* one face, twice */
		problem->system.weight[0] *= 0.5;
		problem->system.weight[grid->cells] *= 0.5;
	}
}

/* Layer averages for the coarse system (P1 4.1). */
static void average_layers(const struct model_state *s, const double *fine, double *coarse)
{
	int merged = s->layers / s->coarse.layers;
	size_t stride = s->grid.stride;

	for (int c = 0; c < s->coarse.layers; c++) {
		int first = c * merged, end = first + merged;

		for (size_t i = 0; i < stride; i++) {
			double sum = 0;

			for (int a = first; a < end; a++)
				sum += dry_layer(s, a) * fine[(size_t)a * stride + i];
			coarse[(size_t)c * stride + i] = sum / (s->level[end] - s->level[first]);
		}
	}
}

/* Start the full system from the coarse solution, linear over the height between the interfaces that
 * both have. (The index of P1 4.1 is inconsistent; linear takes the fewest iterations.) */
static void prolong(struct model_state *s)
{
	struct pressure_system *full = &s->full.system;
	const struct pressure_system *coarse = &s->coarse.system;
	int merged = full->layers / coarse->layers;

	for (int a = 0; a < full->layers; a++) {
		double below = s->level[a - a % merged], above = s->level[a - a % merged + merged];
		double t = (s->level[a] - below) / (above - below);
		const double *low = pressure_system_x(coarse, a / merged);
		const double *high = pressure_system_x(coarse, a / merged + 1);
		double *x = pressure_system_x(full, a);

		for (int f = 0; f < full->faces; f++)
			x[f] = (1 - t) * low[f] + t * high[f];
	}
}

/* Start a system from the last fluctuation (at the interfaces that it has) or from zero. */
static void start(const struct model_state *s, struct pressure_system *system)
{
	int merged = s->layers / system->layers;

	for (int a = 0; a < system->layers; a++) {
		double *x = pressure_system_x(system, a);
		const double *last = s->dq + (size_t)(a * merged) * (size_t)s->grid.faces;

		for (int f = 0; f < system->faces; f++)
			x[f] = s->start_previous && !s->dry[f] ? last[f] : 0;
	}
}

/* What may help where the solver stopped after so many iterations. A residual that no longer falls has come
 * to rounding, which layers of very different thickness reach early. */
static const char *hint(const struct model_state *s, int iterations)
{
	if (!isfinite(s->residual))
		return s->remedy;
	if (s->rule.criterion == CRITERION_RESIDUAL && iterations < s->rule.max_iterations)
		return "rounding allows no less: a larger pressure_solver.residual may carry it";
	return "";
}

static int solve(
	struct model_state *s, struct projection *problem, int *iterations, struct error *err)
{
	int done =
		pressure_solver_solve(s->solver, &problem->system, &s->rule, problem->memory, &s->residual);

	*iterations = done < 0 ? -done : done;
	if (done >= 0)
		return 0;
	double x = s->grid.x_min + pressure_system_worst_face(&problem->system) * s->grid.dx;
	const char *help = hint(s, *iterations);

	return error_set(err, EX_FAILED,
		"the pressure solver (%s, %d layers) did not converge at x = %g m: %s after %d iterations, "
		"relative residual %.1e%s%s",
		s->solver->name, problem->layers, round(1e6 * x) / 1e6 + 0.0, /* no -5e-17, no -0 */
		isfinite(s->residual) ? "stopped" : "not a number", -done, s->residual, *help ? "; " : "",
		help);
}

int dry_pressure(struct model_state *s, double dt, struct error *err)
{
	struct pressure_system *system = &s->full.system;
	size_t faces = (size_t)s->grid.faces;

	mark_dry(s);
	dry_velocities(s);
	assemble(s, &s->full, dt);
	s->coarse_iterations = 0;
	if (s->coarse.layers) {
		average_layers(s, s->u, s->coarse.u);
		average_layers(s, s->w, s->coarse.w);
		assemble(s, &s->coarse, dt);
		start(s, &s->coarse.system);
		TRY(solve(s, &s->coarse, &s->coarse_iterations, err));
		prolong(s);
	} else {
		start(s, system);
	}
	TRY(solve(s, &s->full, &s->iterations, err));
	/* a system without a right side is solved by nobody */
	s->method = s->iterations == 0 && s->residual == 0
					? 0
					: pressure_solver_chosen(s->solver, s->full.memory);
	for (int a = 0; a < s->layers; a++) {
		double *q = s->q + (size_t)a * faces, *dq = s->dq + (size_t)a * faces;
		const double *x = pressure_system_x(system, a);

		memcpy(dq, x, faces * sizeof *dq);
		for (size_t f = 0; f < faces; f++)
			q[f] = s->dry[f] ? 0 : q[f] + x[f];
	}
	dry_add_pressure_force(s, s->dq, dt);
	return 0;
}
