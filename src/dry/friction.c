/* Step 2: friction between the layers and at the bottom (P1 23-25), one tridiagonal system over the
 * layers per cell, with the coefficients frozen at t^n. Columns side by side are solved together, so
 * that the loops run along x. */
#include <math.h>
#include <string.h>

#include "base/kernel.h"
#include "dry/chunk.h"
#include "dry/dry.h"

/* What the layers of a chunk share; cell k is cell `first` + k of the grid. */
struct columns {
	int cells;
	double hs[CHUNK_CELLS];   /* thickness that carries the friction, m */
	double h[CHUNK_CELLS];    /* thickness that the shear is taken over, m */
	double most[CHUNK_CELLS]; /* largest viscosity over rho, where it is bounded, m2/s */
	double down[CHUNK_CELLS]; /* dt k / l_a of the interface below the layer at hand, m */
};

/* The thickness that carries the friction, P1 (25) as it reproduces P1 Table 6: smoothed where the
 * surface is below the angle of repose, and doubled there while the column is at rest. */
KERNEL_PART void friction_thickness(
	const struct model_state *s, struct chunk chunk, struct columns *c)
{
	size_t first = (size_t)chunk.first;
	const double *restrict h = s->h + first, *restrict b = s->b + first;
	const double *restrict bottom = s->u + first;
	const double *restrict top = s->u + (size_t)(s->layers - 1) * s->grid.stride + first;
	double limit = s->par.plain_thickness ? -1 : 2 * s->grid.dx * s->par.mu_s * DRY_REST_SLOPE;
	double rest = DRY_REST_SPEED * s->par.delta_velocity, plane[CHUNK_CELLS] = {0};

	for (int k = 0; k < c->cells; k++)
		plane[k] = -2 * s->par.tan_slope * s->grid.dx;
	if (chunk.first == 1 && s->grid.left_wall) /* the plane is mirrored at a wall */
		plane[0] *= 0.5;
	if (chunk.last == s->grid.cells && s->grid.right_wall)
		plane[c->cells - 1] = -s->par.tan_slope * s->grid.dx;
	for (int k = 0; k < c->cells; k++) {
		bool shore_l = dry_emerges(h[k], b[k], h[k - 1], b[k - 1]);
		bool shore_r = dry_emerges(h[k], b[k], h[k + 1], b[k + 1]);
		double eta = h[k] + b[k], eta_l = h[k - 1] + b[k - 1], eta_r = h[k + 1] + b[k + 1];
		double jump =
			(shore_r ? eta : eta_r) - (shore_l ? eta : eta_l) + plane[k]; /* level there */
		double smooth = 0.5 * h[k] + 0.25 * (h[k - 1] + h[k + 1]);
		double speed = fabs(bottom[k]) > fabs(top[k]) ? fabs(bottom[k]) : fabs(top[k]);
		double carries = speed < rest ? 2 * smooth : smooth;

		c->hs[k] = fabs(jump) <= limit ? carries : h[k]; /* never, where the limit is below 0 */
		c->h[k] = h[k] > DRY_ONE_LAYER ? h[k] : DRY_ONE_LAYER;
	}
}

KERNEL_PART double positive(double x)
{
	return x > 0 ? x : 0;
}

/* The strain rate of a shear and of twice the d_x u that goes with it, P3 (55), 1/s. */
KERNEL_PART double strain_rate(struct friction_choice choice, double shear, double stretch)
{
	return choice.second_order ? __builtin_sqrt(shear * shear + stretch * stretch) : shear;
}

/* tau/rho per velocity difference at the bottom, P1 (11), m/s. The shear there is taken over the whole
 * lowest layer. */
KERNEL_PART double bottom_coefficient(const struct dry_parameters *par,
	struct friction_choice choice, double n, double h, double u, double stretch, double p)
{
	double slip = fabs(u);

	return dry_mu(par, strain_rate(choice, slip * n / h, stretch), p) * p /
		   __builtin_sqrt(slip * slip + par->delta_velocity * par->delta_velocity);
}

/* The same between two layers h/n apart, P1 (10); bounded, P3 (8). */
KERNEL_PART double inner_coefficient(const struct dry_parameters *par,
	struct friction_choice choice, double n, double h, double jump, double stretch, double p,
	double most)
{
	double strain = strain_rate(choice, fabs(jump) * n / h, stretch);
	double yield = dry_mu(par, strain, p) * p;

	if (choice.bounded)
		return (yield < most * strain ? yield / strain : most) * n / h;
	return yield * n /
		   (2 * h * __builtin_sqrt(0.25 * strain * strain + par->delta_strain * par->delta_strain));
}

/* Friction of a layer with the side walls over its speed, P1 (36), times dt: m. */
KERNEL_PART double wall_coefficient(
	const struct dry_parameters *par, double dt, double h, double u, double p)
{
	return dt * par->walls * h * p /
		   __builtin_sqrt(u * u + par->delta_velocity * par->delta_velocity);
}

/* Of the velocity whose values at three cells begin at u[k - 1], d_x u times 2 dx. */
KERNEL_PART double difference(const double *restrict u, int k)
{
	return u[k + 1] - u[k - 1];
}

/* Below DRY_ONE_LAYER a column slides as one, held by Coulomb friction (P1 Remark 2); side walls hold it
 * h/W times as much and are left out. */
KERNEL_PART void slide_as_one(
	const struct model_state *s, struct chunk chunk, const double *restrict h, int cells, double dt)
{
	const struct dry_parameters *par = &s->par;
	double sum[CHUNK_CELLS] = {0}, delta = par->delta_velocity;
	double *restrict U = s->U + chunk.first;

	for (int a = 0; a < s->layers; a++, U += s->grid.stride) {
		double layer = dry_layer(s, a);

		for (int k = 0; k < cells; k++)
			sum[k] += layer * U[k];
	}
	for (int k = 0; k < cells; k++) {
		double U_mean = sum[k] / s->layers, u = h[k] > DRY_NO_MOMENTUM ? U_mean / h[k] : 0;
		double speed = __builtin_sqrt(u * u + delta * delta);

		sum[k] = h[k] > DRY_NO_MOMENTUM ? U_mean / (1 + dt * par->mu_s * par->gc / speed) : 0;
	}
	U = s->U + chunk.first;
	for (int a = 0; a < s->layers; a++, U += s->grid.stride)
		for (int k = 0; k < cells; k++)
			U[k] = h[k] < DRY_ONE_LAYER ? sum[k] : U[k];
}

KERNEL_PART void bound(const struct model_state *s, const double *restrict h, struct columns *c)
{
	double gc = s->par.gc, largest = s->par.largest_viscosity;

	for (int k = 0; k < c->cells; k++)
		c->most[k] = largest * __builtin_sqrt(gc * h[k] * h[k] * h[k]);
}

/* The interface below layer 1, where the elimination begins. */
KERNEL_PART void begin(const struct model_state *s, struct friction_choice choice,
	struct chunk chunk, struct columns *c, double dt)
{
	const struct dry_parameters par = s->par;
	const double *restrict h = s->h + chunk.first, *restrict u = s->u + chunk.first;
	const double *restrict q = s->q + chunk.first - 1;
	double n = dry_layers_of(s, 0), apart = dry_bottom_layers(s), share = par.gc;
	double per_dx = 1 / s->grid.dx;

	if (choice.bounded)
		bound(s, h, c);
	for (int k = 0; k < c->cells; k++) {
		double p = positive(share * c->hs[k] + 0.5 * (q[k] + q[k + 1])), bottom;

		if (choice.no_slip) /* nothing is stretched along it */
			bottom = inner_coefficient(&par, choice, apart, c->h[k], u[k], 0, p, c->most[k]);
		else
			bottom = bottom_coefficient(
				&par, choice, apart, c->h[k], u[k], difference(u, k) * per_dx, p);
		c->down[k] = h[k] < DRY_ONE_LAYER ? 0 : dt * n * bottom;
	}
}

/* Of a layer on the way up. */
struct layer {
	double n;           /* 1/l_a */
	double apart;       /* h over the distance to the layer above, 1 */
	double carry;       /* l_a over that of the layer above, 1 */
	double above;       /* p/rho of the layers above over h, m/s2 */
	double half;        /* the same at the middle of the layer, m/s2 */
	double half_per_dx; /* 1/(2 dx), 1/m */
};

KERNEL_PART struct layer layer_of(const struct model_state *s, int a)
{
	double n = s->layers, own = dry_layer(s, a);
	double next = a < s->layers - 1 ? dry_layer(s, a + 1) : own;

	return (struct layer){
		.n = n / own,
		.apart = n / (0.5 * (own + next)),
		.carry = own / next,
		.above = s->par.gc * (n - s->level[a + 1]) / n,
		.half = s->par.gc * (1 - s->layer_middle[a]),
		.half_per_dx = 0.5 / s->grid.dx,
	};
}

/* One layer on the way up: U becomes the eliminated right side and `ratio` the upper diagonal. `before`
 * and `below` are those of the layer below, `u_up` and `q_up` of the one above. */
KERNEL_PART void eliminate(const struct dry_parameters *par_, struct friction_choice choice,
	struct columns *c, const struct layer *layer, double dt, bool top, const double *restrict h,
	const double *restrict u, const double *restrict u_up, const double *restrict q,
	const double *restrict q_up, const double *restrict before, const double *restrict below,
	double *restrict U, double *restrict ratio)
{
	const struct dry_parameters par = *par_;
	const struct layer l = *layer;

	for (int k = 0; k < c->cells; k++) {
		double kd = c->down[k], ku = 0, own = h[k] + 1e-300, pivot;

		if (!top) {
			double p = positive(l.above * c->hs[k] + 0.5 * (q_up[k] + q_up[k + 1]));
			double stretch = (difference(u_up, k) + difference(u, k)) * l.half_per_dx;
			double inner = inner_coefficient(
				&par, choice, l.apart, c->h[k], u_up[k] - u[k], stretch, p, c->most[k]);

			ku = h[k] < DRY_ONE_LAYER ? 0 : dt * l.n * inner;
		}
		if (choice.walls) {
			double q_high = top ? 0 : q_up[k] + q_up[k + 1];
			double p = positive(l.half * h[k] + 0.25 * (q[k] + q[k + 1] + q_high));

			own += wall_coefficient(&par, dt, h[k], u[k], p);
		}
		pivot = 1 / (own + ku + kd * (1 - before[k]));
		U[k] = (U[k] + kd * below[k]) * pivot;
		ratio[k] = ku * pivot;
		c->down[k] = l.carry * ku;
	}
}

/* One layer on the way down: its velocity, with which the discharge of the layer above is done. */
KERNEL_PART void substitute(int cells, const double *restrict h, const double *restrict ratio,
	double *restrict U, double *restrict U_up)
{
	for (int k = 0; k < cells; k++) {
		U[k] += ratio[k] * U_up[k];
		U_up[k] *= h[k];
	}
}

/* P2 step 2, for one layer: it loses what friction takes in the step, or stops, also upwards. */
KERNEL_PART void slow_or_stop(
	struct model_state *s, struct chunk chunk, const struct columns *c, double dt)
{
	const struct dry_parameters par = s->par;
	size_t first = (size_t)chunk.first;
	const double *restrict u = s->u + first, *restrict q = s->q + first - 1;
	double *restrict U = s->U + first, *restrict W = s->W + first;

	for (int k = 0; k < c->cells; k++) {
		double p = positive(par.gc * c->hs[k] + 0.5 * (q[k] + q[k + 1]));
		double takes = dt * dry_mu(&par, fabs(u[k]) / c->h[k], p) * p;
		double left = fabs(U[k]) - takes;

		U[k] = left > 0 ? __builtin_copysign(left, U[k]) : 0;
		W[k] = left > 0 ? W[k] : 0;
	}
}

/* P1 (24) by the Thomas algorithm: h u_a - dt/l_a [k_up (u_{a+1} - u_a) - k_down (u_a - u_{a-1})] = U_a.
 * U turns into u on the way up and back into h u on the way down. */
KERNEL_PART void solve(struct model_state *s, struct friction_choice choice, struct chunk chunk,
	struct columns *c, double dt)
{
	static const double zeros[CHUNK_CELLS];
	size_t first = (size_t)chunk.first, stride = s->grid.stride, faces = (size_t)s->grid.faces;
	const double *h = s->h + first;
	int last = s->layers - 1;

	begin(s, choice, chunk, c, dt);
	for (int a = 0; a <= last; a++) {
		size_t row = (size_t)a * stride + first;
		double *U = s->U + row, *ratio = s->work + row;
		const double *u = s->u + row, *below = a > 0 ? U - stride : zeros;
		const double *before = a > 0 ? ratio - stride : zeros;
		const double *q = s->q + (size_t)a * faces + first - 1;
		struct layer layer = layer_of(s, a);

		if (a < last)
			eliminate(&s->par, choice, c, &layer, dt, false, h, u, u + stride, q, q + faces, before,
				below, U, ratio);
		else
			eliminate(&s->par, choice, c, &layer, dt, true, h, u, u, q, q, before, below, U, ratio);
	}
	for (int a = last - 1; a >= 0; a--) {
		size_t row = (size_t)a * stride + first;

		substitute(c->cells, h, s->work + row, s->U + row, s->U + row + stride);
	}
	for (int k = 0; k < c->cells; k++)
		s->U[first + (size_t)k] *= h[k];
}

#define SOLVE(i)                                                                                   \
	case i:                                                                                        \
		solve(s, (struct friction_choice){(i)&1, (i)&2, (i)&4, (i)&8}, chunk, &c, dt);             \
		break

KERNEL static void friction(struct model_state *s, struct chunk chunk, double dt)
{
	const struct friction_choice choice = s->par.friction;
	struct columns c = {.cells = chunk.last - chunk.first + 1};
	const double *h = s->h + chunk.first;
	int thin = 0;

	for (int k = 0; k < c.cells; k++)
		thin |= h[k] < DRY_ONE_LAYER;
	if (thin && !s->par.coulomb)
		slide_as_one(s, chunk, h, c.cells, dt);
	friction_thickness(s, chunk, &c);
	if (s->par.coulomb) {
		slow_or_stop(s, chunk, &c, dt);
		return;
	}
	/* a copy for each: a choice within a loop would keep it from being vectorised */
	switch (choice.no_slip | choice.second_order << 1 | choice.bounded << 2 | choice.walls << 3) {
		SOLVE(0);
		SOLVE(1);
		SOLVE(2);
		SOLVE(3);
		SOLVE(4);
		SOLVE(5);
		SOLVE(6);
		SOLVE(7);
		SOLVE(8);
		SOLVE(9);
		SOLVE(10);
		SOLVE(11);
		SOLVE(12);
		SOLVE(13);
		SOLVE(14);
		SOLVE(15);
	}
}

/* With the coefficients of t^n a resting cell takes up speed only step by step, and a moving one is braked by
 * the speed that it had: fronts then depend on the time step. The system solved again with the coefficients of
 * its own result is a fixed-point iteration towards the implicit step, which leaves at rest what rests. */
void dry_friction(struct model_state *s, double dt)
{
	size_t bytes = (size_t)s->layers * s->grid.stride * sizeof *s->U;

	if (s->before)
		memcpy(s->before, s->U, bytes);
	chunk_each(s, friction, dt);
	for (int i = 0; i < s->par.viscosity_updates; i++) {
		dry_velocities(s);
		memcpy(s->U, s->before, bytes);
		chunk_each(s, friction, dt);
	}
}

/* One interface of P1 Theorem 1: that below layer `a`, W/m2. */
static double lost_below(
	const struct model_state *s, const struct columns *c, int k, size_t i, int a)
{
	const struct dry_parameters *par = &s->par;
	const double *u = s->u + (size_t)a * s->grid.stride + i, *under = u - (a ? s->grid.stride : 0);
	const double *q = s->q + (size_t)a * (size_t)s->grid.faces + i;
	double n = s->layers, jump = a ? u[0] - under[0] : u[0];
	double p = positive(par->gc * (n - s->level[a]) / n * c->hs[k] + 0.5 * (q[-1] + q[0]));
	double apart = a ? layer_of(s, a - 1).apart : dry_bottom_layers(s);
	double stretch = (difference(u, 0) + difference(under, 0)) * 0.5 / s->grid.dx;
	double coefficient;

	if (a || par->friction.no_slip)
		coefficient = inner_coefficient(
			par, par->friction, apart, c->h[k], jump, a ? stretch : 0, p, c->most[k]);
	else
		coefficient = bottom_coefficient(par, par->friction, apart, c->h[k], jump, stretch, p);
	return s->par.rho * jump * jump * coefficient;
}

void dry_dissipation(const struct model_state *s, bool between_layers, double *values)
{
	int first = between_layers ? 1 : 0, last = between_layers ? s->layers - 1 : 0;

	for (int begins = 1; begins <= s->grid.cells; begins += CHUNK_CELLS) {
		int ends = begins + CHUNK_CELLS - 1;
		struct chunk chunk = {begins, ends < s->grid.cells ? ends : s->grid.cells};
		struct columns c = {.cells = chunk.last - chunk.first + 1};

		friction_thickness(s, chunk, &c);
		bound(s, s->h + begins, &c);
		for (int k = 0; k < c.cells; k++) {
			size_t i = (size_t)begins + (size_t)k;

			values[i - 1] = 0;
			for (int a = first; a <= last && s->h[i] >= DRY_ONE_LAYER; a++)
				values[i - 1] += lost_below(s, &c, k, i, a);
		}
	}
}
