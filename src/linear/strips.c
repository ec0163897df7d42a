#include "linear/strips.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/arrays.h"
#include "linear/costs.h"

enum { REACH = 2 }; /* a column is as steep as the interfaces within so many columns */

/* Steepness is told in levels: slopes up to the root of 2^(LOWEST + level). */
enum { LOWEST = -6 };

/* Iterations of conjugate gradients where all strips are, of those left, no steeper than that. Without xi the
 * eigenvalues of the preconditioned operator would be 1; with a slope m they are within 1 +- rho,
 * rho^2 = m^2/(1 + m^2). Few columns are the steepest, which makes it faster: 0.6 of the bound for 1e-8 is
 * what was seen. In long double: log in double is chosen by processor and differs in bits. */
static double iterations(int level)
{
	long double square = ldexpl(1, LOWEST + level), rho = sqrtl(square / (1 + square));
	long double rate = rho / (1 + sqrtl(1 - rho * rho));

	return (double)(0.6L * logl(0.5e-8L) / logl(rate));
}

int strips_init(struct strips *s, int layers, int faces, struct error *err)
{
	struct column_layout columns = columns_make(layers, faces);
	size_t groups = (size_t)columns.groups, room = groups / 16 + 6;

	*s = (struct strips){.columns = columns, .room = (int)room};
	for (int i = 0; i < STRIPS_LEVELS; i++)
		s->iterations[i] = iterations(i);
	TRY(elimination_init(&s->elimination, layers, s->room * LANES, err));
	return arrays_allocate((struct arrays_part[]){ARRAY(s->strips, room), ARRAY(s->level, groups),
							   ARRAY(s->given, columns_count(&s->elimination.columns)), {0}},
		&s->memory, err);
}

void strips_clean(struct strips *s)
{
	elimination_clean(&s->elimination);
	free(s->memory);
}

static int least(int a, int b)
{
	return a < b ? a : b;
}

static int most(int a, int b)
{
	return a > b ? a : b;
}

/* Of a slope squared; a NaN is flat. */
static int level_of(double square)
{
	int exponent = 0; /* and of infinity */

	if (!(square > 1.0 / (1 << -LOWEST)))
		return 0;
	(void)frexp(square, &exponent);
	return least(exponent - LOWEST, STRIPS_LEVELS - 1);
}

/* The slope of an interface in a cell is xi/N (P1 9b), steepest at the bed or at the surface. */
static void measure(struct strips *s, const struct pressure_system *system)
{
	const struct pressure_cells *cells = &system->cells;

	for (int g = 0; g < s->columns.groups; g++)
		s->level[g] = 0;
	for (int i = 1; i < system->faces; i++) {
		double low = cells->tilt[i] + cells->place[0] * cells->lean[i];
		double high = cells->tilt[i] + cells->place[system->layers - 1] * cells->lean[i];
		double square = low * low > high * high ? low * low : high * high;
		int level = level_of(square / cells->quarter_nn);
		int first = most(i - REACH, 0) / LANES;
		int last = least(i - 1 + REACH, system->faces - 1) / LANES;

		for (int g = first; g <= last; g++)
			s->level[g] = most(s->level[g], level);
	}
	if (system->periodic) /* a column of the seam has neighbours at the other end, too */
		s->level[0] = s->level[s->columns.groups - 1] = 0;
}

/* The level that is left to the iteration, of those that cost least. */
static int choose(const struct strips *s)
{
	int layers = s->columns.layers, groups = s->columns.groups, above = 0, best = -1;
	int count[STRIPS_LEVELS] = {0};
	double least_cost = 0;

	for (int g = 0; g < groups; g++)
		count[s->level[g]]++;
	for (int level = STRIPS_LEVELS - 1; level >= 0 && above <= s->room; above += count[level--]) {
		double iteration =
			groups * costs_gradients_iteration(layers) + above * costs_elimination_solve(layers);
		double cost = s->iterations[level] * iteration + above * costs_elimination_factor(layers);

		if (best < 0 || cost < least_cost) {
			best = level;
			least_cost = cost;
		}
	}
	return best;
}

/* Runs of groups above a level. */
static void find(struct strips *s, int level)
{
	int at = 0;

	s->count = 0;
	for (int g = 0; g < s->columns.groups; g++) {
		if (s->level[g] <= level)
			continue;
		if (s->count == 0 || s->strips[s->count - 1].last < g)
			s->strips[s->count++] = (struct strip){.first = g, .at = at};
		s->strips[s->count - 1].last = g + 1;
		at += LANES;
	}
}

/* The columns of a strip; the last group of all may not be whole. */
static int width(const struct strips *s, const struct strip *strip)
{
	return least(strip->last * LANES, s->columns.faces) - strip->first * LANES;
}

void strips_factor(struct strips *s, const struct pressure_system *system)
{
	measure(s, system);
	find(s, choose(s));
	for (int i = 0; i < s->count; i++) {
		const struct strip *strip = &s->strips[i];

		elimination_factor(
			&s->elimination, system, strip->first * LANES, width(s, strip), strip->at);
	}
}

void strips_correct(struct strips *s, const struct pressure_system *system, double *x,
	double *product, double *sums)
{
	size_t stride = s->columns.stride;

	for (int i = 0; i < s->count; i++) {
		const struct strip *strip = &s->strips[i];
		size_t at = (size_t)strip->first * LANES * stride;
		int columns = width(s, strip);
		size_t count = (size_t)columns * stride;

		elimination_solve(&s->elimination, product + at, s->given, columns, strip->at);
		for (size_t k = 0; k < count; k++)
			x[at + k] -= s->given[k];
		memset(product + at, 0, count * sizeof *product);
		for (int g = strip->first; g < strip->last; g++)
			sums[g] = 0;
		if (strip->first > 0)
			columns_apply(&s->columns, system, x, product, sums, strip->first - 1, strip->first);
		if (strip->last < s->columns.groups)
			columns_apply(&s->columns, system, x, product, sums, strip->last, strip->last + 1);
	}
}
