/* Whether the numbers are still a flow: what ends a run, and what leaves a doubt about one that went on. */
#include <math.h>
#include <stdio.h>

#include "dry/dry.h"

/* Of the energy at the beginning. What friction cannot explain is some 1e-7 of it where cells are fine. */
#define DOUBTFUL_RISE 0.01

/* Ten non-hydrostatic layers on the random bed of the default roughness and on 640 cells take all three, and
 * then fewer layers or less roughness: of six seeds one got through; with two layers, or 20 mm, all. */
void dry_note_remedy(struct model_state *s, const struct config *config)
{
	bool several = s->layers > 1, rough = config->topography.shape == TOPOGRAPHY_RANDOM;
	const char *exchange = several && !s->par.upwind ? "scheme.exchange: upwind" : "";
	const char *speed = several && !s->par.fastest ? "time.wave_speed: fastest" : "";
	bool slower = rough && s->par.cfl > 0.1;

	(void)snprintf(s->remedy, sizeof s->remedy, "%s%s%s%sa time.cfl %s %g may carry it%s", exchange,
		*exchange && *speed ? ", " : "", speed, *exchange || *speed ? " and " : "",
		slower ? "of" : "below", slower ? 0.1 : s->par.cfl,
		rough ? ", sooner with fewer layers or less topography.roughness" : "");
}

/* Of the bed, over the right end of the plane, m. */
static double height(const struct model_state *s, int i)
{
	double end = s->grid.x_min + s->grid.cells * s->grid.dx;

	return (end - grid_centre(&s->grid, i)) * s->par.tan_slope + s->b[i];
}

double dry_energy(const struct model_state *s, double base, double *kinetic)
{
	double sum = 0, scale = s->par.rho * s->grid.dx;

	*kinetic = 0;
	for (int i = 1; i <= s->grid.cells; i++) {
		double moving = 0.5 * s->squares[i] / s->layers;

		sum += s->h[i] * (moving + s->par.gc * (height(s, i) - base + 0.5 * s->h[i]));
		*kinetic += s->h[i] * moving;
	}
	*kinetic *= scale;
	return scale * sum;
}

/* From the lowest point of the bed, where it is never negative. */
static double energy(const struct model_state *s)
{
	double kinetic;

	return dry_energy(s, s->energy.base, &kinetic);
}

/* How steeply the bed falls inwards before an open end, by a tenth of the domain. */
static double slope_at_ends(const struct model_state *s)
{
	int last = s->grid.cells, tenth = last < 20 ? 1 : last / 10;
	double width = tenth * s->grid.dx;
	double left = (height(s, 1) - height(s, 1 + tenth)) / width;
	double right = (height(s, last) - height(s, last - tenth)) / width;

	return fmax(
		s->grid.left_wall ? 0 : fmax(left, s->par.tan_slope), s->grid.right_wall ? 0 : right);
}

/* No grain can have more than it would get by falling from the highest surface to the lowest bed; or, where a
 * slope goes on beyond an open end, down that slope until the end of the run. */
void dry_check_begin(struct model_state *s, const struct config *config)
{
	double base = INFINITY, top = -INFINITY;
	double fall = s->par.gc * slope_at_ends(s) * config->time.end;

	for (int i = 1; i <= s->grid.cells; i++) {
		base = fmin(base, height(s, i));
		top = fmax(top, height(s, i) + s->h[i]);
	}
	s->energy.base = base;
	s->energy.most =
		s->par.gc * (top - base) + 0.5 * (fall * fall + config->gate.speed * config->gate.speed);
	s->energy.first = s->energy.least = energy(s);
}

void dry_check_again(struct model_state *s)
{
	s->energy.least = energy(s);
}

/* Grains that come in through an end bring energy, as do those that go round down the slope; else it only
 * falls. */
static void watch(struct model_state *s, double now)
{
	bool level = s->grid.periodic && s->par.tan_slope == 0;
	bool fed = (s->end_flux[0] > 0 || s->end_flux[1] < 0) && !level;

	s->energy.least = fed ? now : fmin(s->energy.least, now);
	s->energy.rise = fmax(s->energy.rise, now - s->energy.least);
}

int dry_check(struct model_state *s, struct error *err)
{
	double mass = 0, now, most;

	for (int i = 1; i <= s->grid.cells; i++) {
		if (s->h[i] < 0)
			return error_set(err, EX_FAILED, "negative thickness %g m at x = %g m; %s", s->h[i],
				grid_centre(&s->grid, i), s->remedy);
		if (!isfinite(s->h[i] + s->squares[i]))
			return error_set(err, EX_FAILED,
				"the state is not finite (thickness %g m) at x = %g m; %s", s->h[i],
				grid_centre(&s->grid, i), s->remedy);
		mass += s->h[i];
	}
	now = energy(s);
	most = 2 * fmax(s->par.rho * s->grid.dx * mass, s->mass[0]) * s->energy.most;
	if (!(now <= most))
		return error_set(err, EX_FAILED,
			"the energy has risen to %g J/m, where the grains began with %g J/m over the lowest "
			"bed and can have %g J/m at most; %s",
			now, s->energy.first, most, s->remedy);
	watch(s, now);
	return 0;
}

bool dry_doubt(const struct model_state *s, char text[MODEL_DOUBT_SIZE])
{
	double percent = 100 * s->energy.rise / s->energy.first;

	if (!(s->energy.rise > DOUBTFUL_RISE * s->energy.first))
		return false;
	(void)snprintf(text, MODEL_DOUBT_SIZE,
		"the energy rose by %.*f %% of what it was at the beginning, and friction only takes from "
		"it (P1 Theorem 1): these numbers are in doubt; %s",
		percent < 10 ? 1 : 0, percent, s->remedy);
	return true;
}
