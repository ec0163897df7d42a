/* Step 1: an explicit path-conservative HLL step with hydrostatic reconstruction (P1 18-22). */
#include <math.h>

#include "dry/dry.h"

/* |d eta/dx| up to this times mu is at rest: exactly 1 would lose slopes that are at the limit. */
#define REST_MARGIN 1.001

/* What the fluxes of all layers share at every face. */
struct face_rows {
	double *alpha0, *alpha1;      /* HLL coefficients, m/s and 1 */
	double *source, *rest_source; /* S and S~ of the momentum along x, m3/s2 */
	double *left, *right;         /* h~- and h~+, m */
	double *mass_flux;            /* m2/s */
	double *jump;                 /* running sum over the layers of the jumps in G, m2/s */
	double *flux, *half;          /* numerical flux and (B + S)/2 of the layer at hand */
};

static struct face_rows face_rows(const struct model_state *s)
{
	double *const *r = s->face;

	return (struct face_rows){r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9]};
}

static double positive(double x)
{
	return x > 0 ? x : 0;
}

/* Difference of the bed and the reference plane over face f; a wall mirrors the plane. */
static double plane_jump(const struct model_state *s, int f)
{
	bool wall = (f == 0 && s->grid.left_wall) || (f == s->grid.cells && s->grid.right_wall);

	return wall ? 0 : -s->par.tan_slope * s->grid.dx;
}

/* dC: the part of the surface slope that friction holds (P1, text after 21). */
static double held_jump(const struct model_state *s, int f, double eta_jump, double ubar, double dt)
{
	const struct dry_parameters *par = &s->par;
	double dx = s->grid.dx, h = 0.5 * (s->h[f] + s->h[f + 1]);
	double u = 0.5 * fabs(s->u[f] + s->u[f + 1]), p = positive(par->gc * h + s->q[f]);
	double mu = dry_mu(par, h > DRY_NO_MOMENTUM ? u * s->layers / h : 0, p);
	double force, most;

	if (par->static_balance)
		return fabs(eta_jump) <= REST_MARGIN * mu * dx ? -eta_jump : 0;
	force = ubar / dt - par->gc * eta_jump / dx;
	most = par->gc * mu;
	force = force > most ? most : force < -most ? -most : force;
	return force * dx / par->gc;
}

/* Reconstructions, wave speeds and the mass flux at every face. `ubar`, `c`: rows of cells. */
static void prepare_faces(struct model_state *s, const double *ubar, const double *c, double dt)
{
	struct face_rows r = face_rows(s);
	const double *h = s->h, *b = s->b;
	double gc = s->par.gc;

	for (int f = 0; f < s->grid.faces; f++) {
		int i = f, j = f + 1; /* cells to the left and right */
		double db = b[j] - b[i], dz = db + plane_jump(s, f), hbar = 0.5 * (h[i] + h[j]);
		double root_i = sqrt(h[i]), root_j = sqrt(h[j]), roots = root_i + root_j;
		double u_roe = roots > 0 ? (root_i * ubar[i] + root_j * ubar[j]) / roots : 0;
		double c_roe = sqrt(gc * hbar);
		double sl = fmin(ubar[i] - c[i], u_roe - c_roe), sr = fmax(ubar[j] + c[j], u_roe + c_roe);
		double width = sr - sl, du = h[j] * ubar[j] - h[i] * ubar[i];
		double held = dz + held_jump(s, f, dz + h[j] - h[i], u_roe, dt);

		r.alpha0[f] = width > 0 ? (sr * fabs(sl) - sl * fabs(sr)) / width : 0;
		r.alpha1[f] = width > 0 ? (fabs(sr) - fabs(sl)) / width : 0;
		/* the plane stands outside the reconstruction, or it would cut gravity where h < tan dx */
		r.source[f] = gc * hbar *
					  (positive(h[j] - positive(-db)) - positive(h[i] - positive(db)) + (dz - db));
		r.left[f] = positive(h[i] - positive(held));
		r.right[f] = positive(h[j] - positive(-held));
		r.rest_source[f] = gc * hbar * (r.right[f] - r.left[f]);
		r.mass_flux[f] = 0.5 * (h[i] * ubar[i] + h[j] * ubar[j]) -
						 0.5 * (r.alpha0[f] * (r.right[f] - r.left[f]) + r.alpha1[f] * du);
		r.jump[f] = 0;
	}
}

/* No cell gives away more than it holds: `share` is the part of its outflow that a cell can pay. */
static void limit_outflow(const struct model_state *s, double dt, double *share)
{
	const double *flux = face_rows(s).mass_flux;

	share[0] = share[s->grid.cells + 1] = 1;
	for (int i = 1; i <= s->grid.cells; i++) {
		double out = (positive(flux[i]) + positive(-flux[i - 1])) * dt / s->grid.dx;

		share[i] = out > s->h[i] ? s->h[i] * (1 - 1e-12) / out : 1;
	}
}

static double donor(const double *share, double flux, int f)
{
	return flux > 0 ? share[f] : share[f + 1];
}

/* Advance one component (`v` is u_a or w_a) of one layer: `top`, `bottom` are the rows above and below
 * (their own row at the surface and the bed, where the exchange is zero anyway). */
static void advance_layer(struct model_state *s, double *discharge, const double *v,
	const double *bottom, const double *top, const double *u, const double *below,
	const double *above, const double *source, const double *rest, const double *share, double dt)
{
	struct face_rows r = face_rows(s);
	const double *h = s->h;
	double n = s->layers, ratio = dt / s->grid.dx;

	for (int f = 0; f < s->grid.faces; f++) {
		int i = f, j = f + 1;
		double fi = h[i] * u[i] * v[i], fj = h[j] * u[j] * v[j];
		double v_up = 0.25 * (v[i] + v[j] + top[i] + top[j]);
		double v_down = 0.25 * (v[i] + v[j] + bottom[i] + bottom[j]);
		double exchange = -n * (v_up * above[f] - v_down * below[f]);
		double diffusion = r.alpha0[f] * (r.right[f] * v[j] - r.left[f] * v[i]) +
						   r.alpha1[f] * (fj - fi + exchange + rest[f]);

		r.flux[f] = 0.5 * (fi + fj - diffusion) * donor(share, r.mass_flux[f], f);
		r.half[f] = 0.5 * (exchange + source[f]);
	}
	for (int i = 1; i <= s->grid.cells; i++)
		discharge[i] -= ratio * (r.flux[i] - r.flux[i - 1] + r.half[i - 1] + r.half[i]);
}

static void advance_layers(struct model_state *s, const double *ubar, const double *share,
	double *above, const double *zero, double dt)
{
	struct face_rows r = face_rows(s);
	size_t stride = s->grid.stride;
	const double *h = s->h;
	int last = s->layers - 1;

	for (int a = 0; a <= last; a++) {
		size_t row = (size_t)a * stride, up = a < last ? row + stride : row;
		size_t down = a > 0 ? row - stride : row;
		const double *u = s->u + row, *w = s->w + row;

		/* G at the interface above (P1 5); exactly 0 at the surface */
		for (int f = 0; f < s->grid.faces; f++)
			above[f] =
				a == last
					? 0
					: r.jump[f] + (h[f + 1] * (u[f + 1] - ubar[f + 1]) - h[f] * (u[f] - ubar[f])) /
									  s->layers;
		advance_layer(s, s->U + row, u, s->u + down, s->u + up, u, r.jump, above, r.source,
			r.rest_source, share, dt);
		if (s->par.non_hydrostatic)
			advance_layer(
				s, s->W + row, w, s->w + down, s->w + up, u, r.jump, above, zero, zero, share, dt);
		for (int f = 0; f < s->grid.faces; f++)
			r.jump[f] = above[f];
	}
}

void dry_transport(struct model_state *s, double dt)
{
	double *ubar = s->cell[0], *c = s->cell[1], *share = s->cell[2];
	double *above = s->cell[3], *zero = s->cell[4]; /* longer than a row of faces */
	double *flux = face_rows(s).mass_flux, ratio = dt / s->grid.dx;
	size_t stride = s->grid.stride;

	for (size_t i = 0; i < stride; i++) {
		double sum = 0;

		for (int a = 0; a < s->layers; a++)
			sum += s->u[(size_t)a * stride + i];
		ubar[i] = sum / s->layers;
		c[i] = sqrt(s->par.gc * s->h[i]);
		zero[i] = 0;
	}
	prepare_faces(s, ubar, c, dt);
	limit_outflow(s, dt, share);
	advance_layers(s, ubar, share, above, zero, dt);
	if (s->par.non_hydrostatic)
		dry_add_pressure_force(s, s->q, dt);
	for (int f = 0; f < s->grid.faces; f++)
		flux[f] *= donor(share, flux[f], f);
	for (int i = 1; i <= s->grid.cells; i++)
		s->h[i] -= ratio * (flux[i] - flux[i - 1]);
	grid_fill_even(&s->grid, s->h);
	s->mass[1] += s->par.rho * dt * (flux[s->grid.cells] - flux[0]);
}
