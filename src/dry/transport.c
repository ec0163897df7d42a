/* Step 1: an explicit path-conservative HLL step with hydrostatic reconstruction (P1 18-22). */
#include <math.h>
#include <string.h>

#include "base/kernel.h"
#include "dry/force.h"

/* |d eta/dx| up to this times mu is at rest: exactly 1 would lose slopes that are at the limit. */
#define REST_MARGIN 1.001

enum { ROW = CHUNK_CELLS + 4 };

/* A chunk sees two cells more on either side, as far as there are any: the face at its end may be
 * limited by what flows out of the cell beyond. Cell j of the window is cell `first` + j of the grid,
 * and face j lies between its cells j and j + 1. What the fluxes of all layers share at every face: */
struct window {
	int first, faces;
	double alpha0[ROW], alpha1[ROW];      /* HLL coefficients, m/s and 1 */
	double source[ROW], rest_source[ROW]; /* S and S~ of the momentum along x, m3/s2 */
	double left[ROW], right[ROW];         /* h~- and h~+, m */
	double mass_flux[ROW];                /* m2/s */
	double moves[ROW];                    /* 0 where the grains are at rest, else 1 */
	double share[ROW];                    /* part of the flux that its donor can pay, 1 */
	double ends[2];                       /* the same of the ghosts where they are cells, else 1 */
};

KERNEL_PART double positive(double x)
{
	return x > 0 ? x : 0;
}

KERNEL_PART double smaller(double a, double b)
{
	return a < b ? a : b;
}

KERNEL_PART double larger(double a, double b)
{
	return a > b ? a : b;
}

/* dC: the part of the surface slope that friction holds (P1, text after 21). `h`, `u`: means of the
 * thickness and of |u_1| at the face, `q` there at the bottom. */
KERNEL_PART double held_jump(const struct dry_parameters *par, int reconstruction, double h,
	double u, double q, double eta_jump, double u_roe, double dt, double dx, double n)
{
	double p = positive(par->gc * h + q);
	double mu = dry_mu(par, h > DRY_NO_MOMENTUM ? u * n / h : 0, p);
	double force = u_roe / dt - par->gc * eta_jump / dx, most = par->gc * mu;
	double still = fabs(eta_jump) <= REST_MARGIN * mu * dx ? -eta_jump : 0;

	if (reconstruction != RECONSTRUCTION_PRINTED)
		return still;
	force = force > most ? most : force < -most ? -most : force;
	return force * dx / par->gc;
}

/* Difference of the bed and the reference plane over every face; a wall mirrors the plane. */
KERNEL_PART void plane_jumps(const struct model_state *s, const struct window *r, double *jump)
{
	for (int j = 0; j < r->faces; j++)
		jump[j] = -s->par.tan_slope * s->grid.dx;
	if (r->first == 0 && s->grid.left_wall)
		jump[0] = 0;
	if (r->first + r->faces == s->grid.faces && s->grid.right_wall)
		jump[r->faces - 1] = 0;
}

/* Wave speeds by Roe's averages, and the coefficients that they make (P1 19). Rows of the cells to the
 * left (i) and right (j) of each face: indices f and f + 1 of one row keep gcc from vectorising. */
KERNEL_PART void hll_coefficients(const struct model_state *s, struct window *r, double *u_roe)
{
	const double *restrict h_i = s->h + r->first, *restrict h_j = h_i + 1;
	const double *restrict ubar_i = s->mean + r->first, *restrict ubar_j = ubar_i + 1;
	double gc = s->par.gc;

	for (int f = 0; f < r->faces; f++) {
		double root_i = __builtin_sqrt(h_i[f]), root_j = __builtin_sqrt(h_j[f]);
		double roots = root_i + root_j;
		double mean = (root_i * ubar_i[f] + root_j * ubar_j[f]) / roots, u = roots > 0 ? mean : 0;
		double c = __builtin_sqrt(gc * (0.5 * (h_i[f] + h_j[f])));
		double sl = smaller(ubar_i[f] - __builtin_sqrt(gc * h_i[f]), u - c);
		double sr = larger(ubar_j[f] + __builtin_sqrt(gc * h_j[f]), u + c), width = sr - sl;
		double alpha0 = (sr * fabs(sl) - sl * fabs(sr)) / width;
		double alpha1 = (fabs(sr) - fabs(sl)) / width;

		r->alpha0[f] = width > 0 ? alpha0 : 0;
		r->alpha1[f] = width > 0 ? alpha1 : 0;
		u_roe[f] = u;
	}
}

/* Hydrostatic reconstruction, with the part of the slope that friction holds and without (P1 20, 21). */
KERNEL_PART void reconstruct(const struct model_state *s, int reconstruction, double dt,
	const double *restrict plane, const double *restrict u_roe, struct window *r)
{
	const struct dry_parameters par = s->par;
	const double *restrict h_i = s->h + r->first, *restrict h_j = h_i + 1;
	const double *restrict b_i = s->b + r->first, *restrict b_j = b_i + 1;
	const double *restrict u_i = s->u + r->first, *restrict u_j = u_i + 1;
	const double *restrict q = s->q + r->first;
	double dx = s->grid.dx, n = dry_bottom_layers(s);

	for (int f = 0; f < r->faces; f++) {
		double db = b_j[f] - b_i[f], dz = db + plane[f], hbar = 0.5 * (h_i[f] + h_j[f]);
		double held = dz + held_jump(&par, reconstruction, hbar, 0.5 * fabs(u_i[f] + u_j[f]), q[f],
							   dz + h_j[f] - h_i[f], u_roe[f], dt, dx, n);
		double left = positive(h_i[f] - positive(held)), right = positive(h_j[f] - positive(-held));

		/* the plane stands outside the reconstruction, or it would cut gravity where h < tan dx */
		r->source[f] =
			par.gc * hbar *
			(positive(h_j[f] - positive(-db)) - positive(h_i[f] - positive(db)) + (dz - db));
		r->rest_source[f] = par.gc * hbar * (right - left);
		r->left[f] = left;
		r->right[f] = right;
	}
}

/* Where grains rest on both sides of a face, nothing passes it: Coulomb friction holds them, and their
 * speed is that of its regularisation alone. P1's dC does not stop it: as printed, the u/dt in it makes the
 * flux h u (1 - 1/(2 CFL)), which at CFL 0.1 is four times the creep, up the slope. */
KERNEL_PART void find_rest(
	const struct model_state *s, const double *restrict plane, struct window *r)
{
	const double *restrict h_i = s->h + r->first, *restrict h_j = h_i + 1;
	const double *restrict b_i = s->b + r->first, *restrict b_j = b_i + 1;
	const double *restrict u_i = s->fastest + r->first, *restrict u_j = u_i + 1;
	bool rests = s->par.reconstruction == RECONSTRUCTION_RESTING;
	double slow = smaller(DRY_REST_SPEED * s->par.delta_velocity, DRY_HELD_SPEED);
	double limit = s->par.mu_s * s->grid.dx * DRY_REST_SLOPE;

	for (int f = 0; f < r->faces; f++) {
		double jump = b_j[f] - b_i[f] + plane[f] + h_j[f] - h_i[f];
		int still = (int)rests & (int)(fabs(jump) <= limit) & (int)(larger(u_i[f], u_j[f]) < slow);

		r->moves[f] = still ? 0 : 1;
	}
}

KERNEL_PART void mass_fluxes(const struct model_state *s, struct window *r)
{
	const double *restrict h = s->h + r->first, *restrict ubar = s->mean + r->first;

	for (int f = 0; f < r->faces; f++) {
		double left = h[f] * ubar[f], right = h[f + 1] * ubar[f + 1];

		r->mass_flux[f] =
			r->moves[f] * (0.5 * (left + right) - 0.5 * (r->alpha0[f] * (r->right[f] - r->left[f]) +
															r->alpha1[f] * (right - left)));
	}
}

/* The part of what flows out of a cell that it holds. */
KERNEL_PART double payable(double h, double flux_left, double flux_right, double dt, double dx)
{
	double out = (positive(flux_right) + positive(-flux_left)) * dt / dx;

	return out > h ? h * (1 - 1e-12) / out : 1;
}

/* No cell gives away more than it holds; what it gives is cut to the share that it can pay. Nothing flows
 * over a dry step of the bed that stands out of the grains (P1 Remark 2). */
KERNEL_PART void limit_outflow(const struct model_state *s, double dt, struct window *r)
{
	const double *restrict h = s->h + r->first, *restrict flux = r->mass_flux;
	const double *restrict b = s->b + r->first;
	double pays[ROW];

	pays[0] = r->ends[0]; /* of ghosts; or not looked at */
	pays[r->faces] = r->ends[1];
	for (int j = 1; j < r->faces; j++)
		pays[j] = payable(h[j], flux[j - 1], flux[j], dt, s->grid.dx);
	for (int f = 0; f < r->faces; f++) {
		double left = pays[f], right = pays[f + 1], share = flux[f] > 0 ? left : right;
		int blocked = (int)dry_emerges(h[f], b[f], h[f + 1], b[f + 1]) |
					  (int)dry_emerges(h[f + 1], b[f + 1], h[f], b[f]);

		r->share[f] = blocked ? 0 : share * r->moves[f];
	}
}

/* One component (`v` is u_a or w_a) of one layer at the faces of a chunk: the numerical flux, and
 * (B + S)/2. `n` is 1/l_a; `top`, `bottom` are the rows above and below (their own row at the surface
 * and the bed, where the exchange is zero anyway), `above`, `below` the jumps of G there. What is exchanged has the
 * velocity of both layers, or with `upwind` that of the one which it leaves. */
KERNEL_PART void layer_fluxes(const struct window *r, bool upwind, int at, int faces, double n,
	bool along, const double *restrict h, const double *restrict u, const double *restrict v,
	const double *restrict bottom, const double *restrict top, const double *restrict below,
	const double *restrict above, double *restrict flux, double *restrict half)
{
	const double *restrict alpha0 = r->alpha0 + at, *restrict alpha1 = r->alpha1 + at;
	const double *restrict left = r->left + at, *restrict right = r->right + at;
	const double *restrict source = r->source + at, *restrict rest = r->rest_source + at;
	const double *restrict share = r->share + at;

	for (int f = 0; f < faces; f++) {
		int i = f, j = f + 1;
		double fi = h[i] * u[i] * v[i], fj = h[j] * u[j] * v[j];
		double v_up = 0.25 * (v[i] + v[j] + top[i] + top[j]);
		double v_down = 0.25 * (v[i] + v[j] + bottom[i] + bottom[j]);
		double own = 0.5 * (v[i] + v[j]);
		double up = upwind ? (above[f] > 0 ? 0.5 * (top[i] + top[j]) : own) : v_up;
		double down = upwind ? (below[f] > 0 ? own : 0.5 * (bottom[i] + bottom[j])) : v_down;
		double exchange = -n * (up * above[f] - down * below[f]);
		double diffusion = alpha0[f] * (right[f] * v[j] - left[f] * v[i]) +
						   alpha1[f] * (fj - fi + exchange + (along ? rest[f] : 0));

		flux[f] = 0.5 * (fi + fj - diffusion) * share[f];
		half[f] = 0.5 * (exchange + (along ? source[f] : 0));
	}
}

/* G at the interface above a layer (P1 5), from that below. */
KERNEL_PART void add_jump(int faces, double n, const double *restrict h, const double *restrict u,
	const double *restrict ubar, const double *restrict below, double *restrict above)
{
	for (int f = 0; f < faces; f++)
		above[f] = below[f] + (h[f + 1] * (u[f + 1] - ubar[f + 1]) - h[f] * (u[f] - ubar[f])) / n;
}

KERNEL_PART void advance(int cells, double ratio, const double *restrict flux,
	const double *restrict half, double *restrict discharge)
{
	for (int k = 0; k < cells; k++)
		discharge[k] -= ratio * (flux[k + 1] - flux[k] + half[k] + half[k + 1]);
}

/* All layers of the chunk, from the bottom. */
KERNEL_PART void advance_layers(
	struct model_state *s, bool upwind, const struct window *r, struct chunk chunk, double dt)
{
	size_t stride = s->grid.stride, left = (size_t)chunk.first - 1; /* of the first face */
	double jumps[2][ROW] = {0}, flux[ROW] = {0}, half[ROW] = {0};
	double ratio = dt / s->grid.dx;
	int cells = chunk.last - chunk.first + 1, faces = cells + 1, at = (int)left - r->first;
	int top = s->layers - 1;
	const double *h = s->h + left;
	struct force force;

	if (s->par.non_hydrostatic)
		force_begin(s, chunk, &force);
	for (int a = 0; a <= top; a++) {
		size_t row = (size_t)a * stride + left;
		size_t up = a < top ? row + stride : row, down = a > 0 ? row - stride : row;
		const double *u = s->u + row, *w = s->w + row;
		double *below = jumps[a % 2], *above = jumps[(a + 1) % 2], n = dry_layers_of(s, a);

		if (a < top)
			add_jump(faces, n, h, u, s->mean + left, below, above);
		else
			memset(above, 0, sizeof jumps[0]); /* exactly 0 at the surface */
		layer_fluxes(r, upwind, at, faces, n, true, h, u, u, s->u + down, s->u + up, below, above,
			flux, half);
		advance(cells, ratio, flux, half, s->U + row + 1);
		if (!s->par.non_hydrostatic)
			continue;
		layer_fluxes(r, upwind, at, faces, n, false, h, u, w, s->w + down, s->w + up, below, above,
			flux, half);
		advance(cells, ratio, flux, half, s->W + row + 1);
		force_add_layer(s, &force, chunk, a, s->q, dt);
	}
}

KERNEL_PART void advance_thickness(
	struct model_state *s, const struct window *r, struct chunk chunk, double dt)
{
	const double *restrict h = s->h + chunk.first;
	const double *restrict flux = r->mass_flux + (chunk.first - 1 - r->first);
	const double *restrict share = r->share + (chunk.first - 1 - r->first);
	double *restrict next = s->next + chunk.first, ratio = dt / s->grid.dx;
	int cells = chunk.last - chunk.first + 1;

	for (int k = 0; k < cells; k++)
		next[k] = h[k] - ratio * (flux[k + 1] * share[k + 1] - flux[k] * share[k]);
	if (chunk.first == 1)
		s->end_flux[0] = flux[0] * share[0];
	if (chunk.last == s->grid.cells)
		s->end_flux[1] = flux[cells] * share[cells];
}

/* What the layers share. */
KERNEL_PART void fill_window(const struct model_state *s, double dt, struct window *r)
{
	double plane[ROW] = {0}, u_roe[ROW];

	plane_jumps(s, r, plane);
	hll_coefficients(s, r, u_roe);
	if (s->par.reconstruction == RECONSTRUCTION_PRINTED)
		reconstruct(s, RECONSTRUCTION_PRINTED, dt, plane, u_roe, r);
	else
		reconstruct(s, RECONSTRUCTION_STATIC, dt, plane, u_roe, r);
	find_rest(s, plane, r);
	mass_fluxes(s, r);
}

/* The part of its fluxes that a cell at an end can pay: for the ghost at the other, periodic one. */
KERNEL static double end_pays(const struct model_state *s, int cell, double dt)
{
	struct window r;

	r.first = cell - 1;
	r.faces = 2;
	fill_window(s, dt, &r);
	return payable(s->h[cell], r.mass_flux[0], r.mass_flux[1], dt, s->grid.dx);
}

KERNEL static void transport(struct model_state *s, struct chunk chunk, double dt)
{
	int last = chunk.last < s->grid.cells ? chunk.last + 2 : chunk.last + 1;
	struct window r;

	r.first = chunk.first > 1 ? chunk.first - 2 : 0;
	r.faces = last - r.first;
	r.ends[0] = s->grid.periodic && r.first == 0 ? end_pays(s, s->grid.cells, dt) : 1;
	r.ends[1] = s->grid.periodic && last > s->grid.cells ? end_pays(s, 1, dt) : 1;
	fill_window(s, dt, &r);
	limit_outflow(s, dt, &r);
	if (s->par.upwind)
		advance_layers(s, true, &r, chunk, dt);
	else
		advance_layers(s, false, &r, chunk, dt);
	advance_thickness(s, &r, chunk, dt);
}

void dry_transport(struct model_state *s, double dt)
{
	chunk_each(s, transport, dt);
	memcpy(s->h + 1, s->next + 1, (size_t)s->grid.cells * sizeof *s->h);
	grid_fill_even(&s->grid, s->h);
	s->mass[1] += s->par.rho * dt * (s->end_flux[1] - s->end_flux[0]);
}
