#include "case/initial.h"

#include <math.h>
#include <stdlib.h>

#include "case/topography.h"
#include "case/turn.h"

/* P1 (34): a column behind the gate. In all shapes `b` is the bed at x as it is given; the layer of the
 * erodible bed comes on top. */
static double column(const struct config *config, double x, double b)
{
	(void)b;
	return x <= config->initial.front ? config->initial.height : 0;
}

/* A smooth heap on a layer of the same material (P1 5.2). In long double, as exp in double is chosen by
 * processor and differs in bits. */
static double heap(const struct config *config, double x, double b)
{
	double t = (x - config->initial.centre) / config->initial.width;

	(void)b;
	return config->initial.height * (double)expl(-(long double)t * t);
}

/* P2 4.1: a horizontal surface behind a vertical front, which local coordinates see as a triangle. */
static double triangle(const struct config *config, double x, double b)
{
	double tan_slope = (double)tanl(config->slope), behind = config->initial.front - x;
	double height = config->initial.height, top = height * tan_slope;
	bool local = config->topography.coordinates == GIVEN_SAME
					 ? config->coordinates == COORDINATES_LOCAL
					 : config->topography.coordinates == GIVEN_LOCAL;

	(void)b;
	if (behind < 0)
		return 0;
	if (local && behind < top)
		return behind / tan_slope;
	return fmax(0, height - tan_slope * (local ? behind - top : behind));
}

/* P1 5.3: a surface at an angle, over whatever bed is below it. */
static double level(const struct config *config, double x, double b)
{
	double surface = config->initial.height -
					 (double)tanl(config->initial.surface_slope) * (x - config->initial.centre);

	return fmax(0, surface - b);
}

/* P1 5.4.1 and P2 4.2: a surface with a flat top that falls by 1 m beside it, up to the front. */
static double cap(const struct config *config, double x, double b)
{
	long double t = x - (long double)config->initial.centre, t2 = t * t, t4 = t2 * t2;

	if (x > config->initial.front)
		return 0;
	return fmax(0, config->initial.height - 1 + (double)expl(-0.5L * t4 * t4) - b);
}

static double points(const struct config *config, double x, double b)
{
	const struct real_list *list = &config->initial.points;

	(void)b;
	if (x < list->values[0] || x > list->values[list->count - 2])
		return 0;
	return topography_points_value(list, x);
}

/* A flow without ends (P3 5.1). */
static double uniform(const struct config *config, double x, double b)
{
	(void)x;
	(void)b;
	return config->initial.height;
}

/* Thickness at x above the erodible bed, m; the index is enum shape_kind. */
static double (*const shapes[])(const struct config *config, double x, double b) = {
	[SHAPE_COLUMN] = column,
	[SHAPE_HEAP] = heap,
	[SHAPE_TRIANGLE] = triangle,
	[SHAPE_LEVEL] = level,
	[SHAPE_CAP] = cap,
	[SHAPE_UNIFORM] = uniform,
	[SHAPE_FILE] = points,
};

static double thickness(const struct config *config, double x, double b)
{
	return config->erodible_bed_thickness + shapes[config->initial.shape](config, x, b);
}

/* Nothing to turn: the values in the middle of the cells. */
static int fill_here(
	const struct config *config, const struct grid *grid, double *b, double *h, struct error *err)
{
	for (int i = 1; i <= grid->cells; i++)
		b[i] = topography_bed(config, grid_centre(grid, i));
	TRY(topography_add_random(config, grid, b, err));
	for (int i = 1; i <= grid->cells; i++) {
		double x = grid_centre(grid, i);

		h[i] = thickness(config, x, b[i]);
		if (config_bed_is_absolute(config))
			b[i] -= topography_plane(config, x);
	}
	return 0;
}

/* Bed and surface above the plane as they are given, at places well beyond what the grid can see. */
struct outline {
	double *x, *bed, *surface;
	int count;
};

static void add_place(const struct config *config, struct outline *outline, double x)
{
	double b = topography_bed(config, x), h = thickness(config, x, b);
	int k = outline->count++;

	if (config_bed_is_absolute(config))
		b -= topography_plane(config, x);
	outline->x[k] = x;
	outline->bed[k] = b;
	outline->surface[k] = b + h;
}

/* Between the ends of the points, where the bed is a file. */
static void draw(const struct config *config, const struct grid *grid, double along, int places,
	struct outline *outline)
{
	double length = grid->cells * grid->dx / along, from = grid->x_min / along - length;
	double to = from + 3 * length, front = config->initial.front, step;

	if (config->topography.shape == TOPOGRAPHY_FILE) {
		const struct real_list *list = &config->topography.points;

		from = fmax(from, list->values[0]);
		to = fmin(to, list->values[list->count - 2]);
	}
	if (from >= to)
		return; /* the points are elsewhere */
	step = (to - from) / places;
	for (int k = 0; k <= places; k++) {
		double x = k < places ? from + k * step : to;

		if (k && front >= outline->x[outline->count - 1] && front < x) { /* where a shape may end */
			if (front > outline->x[outline->count - 1])
				add_place(config, outline, front);
			if (nextafter(front, INFINITY) < x)
				add_place(config, outline, nextafter(front, INFINITY));
		}
		add_place(config, outline, x);
	}
}

static int check_bed(const struct config *config, const struct turn *turn,
	const struct outline *outline, const struct grid *grid, struct error *err)
{
	double at = NAN;

	if (outline->count && turn_reaches(turn, outline->x, outline->bed, outline->count, grid, &at))
		return 0;
	if (isfinite(at))
		return error_set(err, EX_DATAERR,
			"topography: at x = %g m the bed is too steep to be changed into %s coordinates", at,
			config->coordinates == COORDINATES_LOCAL ? "local" : "cartesian");
	return error_set(err, EX_DATAERR,
		"%s: changed into %s coordinates they do not reach from domain.x_min to domain.x_max",
		config->topography.shape == TOPOGRAPHY_FILE ? "topography.points" : "topography",
		config->coordinates == COORDINATES_LOCAL ? "local" : "cartesian");
}

/* Turned into the coordinates of the run: the mean over each cell, so that no grain is lost. */
static int fill_turned(
	const struct config *config, const struct grid *grid, double *b, double *h, struct error *err)
{
	bool local = config->coordinates == COORDINATES_LOCAL;
	struct turn turn = local ? turn_to_local(config->slope) : turn_to_cartesian(config->slope);
	int places = 12 * grid->cells; /* four in the width of a cell */
	size_t size = (size_t)places + 4;
	double *memory = calloc(3 * size, sizeof *memory);
	struct outline outline = {memory, memory + size, memory + 2 * size, 0};
	int status;

	if (!memory)
		return error_memory(err, 3 * size * sizeof *memory);
	draw(config, grid, turn.along, places, &outline);
	status = check_bed(config, &turn, &outline, grid, err);
	for (int i = 1; i <= grid->cells; i++)
		b[i] = h[i] = 0;
	turn_add(&turn, outline.x, outline.bed, outline.count, grid, b);
	turn_add(&turn, outline.x, outline.surface, outline.count, grid, h);
	for (int i = 1; i <= grid->cells; i++)
		h[i] = fmax(0, h[i] - b[i]);
	free(memory);
	return status;
}

/* Grains that leave at one end come in at the other, onto the same bed. */
static int check_ends(const struct config *config, const struct grid *grid, struct error *err)
{
	double left, right;

	if (!grid->periodic || config->topography.shape == TOPOGRAPHY_PLANE ||
		config->topography.shape == TOPOGRAPHY_RANDOM)
		return 0;
	left = topography_bed(config, config->domain.x_min);
	right = topography_bed(config, config->domain.x_max);
	if (fabs(left - right) <= 1e-9 * fmax(1, fabs(left)))
		return 0;
	return error_set(err, EX_DATAERR,
		"topography: periodic ends need one bed at both, "
		"and it is %g m at the left end and %g m at the right one",
		left, right);
}

/* There are some, and of a thickness that this model is for. */
static int check_grains(const struct grid *grid, const double *h, struct error *err)
{
	enum { THICKEST = 1000000 }; /* m */
	double most = 0;

	for (int i = 1; i <= grid->cells; i++) {
		if (!(h[i] <= THICKEST))
			return error_set(err, EX_DATAERR,
				"initial: at x = %g m the grains are %g m thick; 1000 km is the most",
				grid_centre(grid, i), h[i]);
		most = fmax(most, h[i]);
	}
	if (most > 0)
		return 0;
	return error_set(err, EX_DATAERR,
		"initial: there are no grains in any of the %d cells between domain.x_min and domain.x_max",
		grid->cells);
}

int initial_fill(
	const struct config *config, const struct grid *grid, double *b, double *h, struct error *err)
{
	TRY(check_ends(config, grid, err));
	TRY((config_bed_is_given_here(config) ? fill_here : fill_turned)(config, grid, b, h, err));
	TRY(check_grains(grid, h, err));
	grid_fill_even(grid, b);
	grid_fill_even(grid, h);
	return 0;
}

int initial_check(const struct config *config, struct error *err)
{
	struct grid grid = grid_make(config);
	double *rows = calloc(2 * grid.stride, sizeof *rows);
	int result;

	if (!rows)
		return error_memory(err, 2 * grid.stride * sizeof *rows);
	result = initial_fill(config, &grid, rows, rows + grid.stride, err);
	free(rows);
	return result;
}

double initial_velocity(const struct config *config, double x)
{
	double behind = config->initial.front - x;

	return behind > 0 && behind < config->gate.width ? config->gate.speed : 0;
}
