/* The force of a non-hydrostatic pressure on a layer, in kernels. */
#ifndef TALUS_FORCE_H
#define TALUS_FORCE_H

#include "dry/chunk.h"

/* What the layers of a chunk share: differences over two cells, m. */
struct force {
	double dh[CHUNK_CELLS], db[CHUNK_CELLS]; /* 2 dx d_x h and 2 dx N d_x b */
};

KERNEL_PART void force_begin(const struct model_state *s, struct chunk chunk, struct force *force)
{
	const double *restrict h = s->h + chunk.first, *restrict b = s->bed + chunk.first;
	int cells = chunk.last - chunk.first + 1;
	double n = s->layers;

	for (int k = 0; k < cells; k++) {
		force->dh[k] = h[k + 1] - h[k - 1];
		force->db[k] = n * (b[k + 1] - b[k - 1]);
	}
}

/* Add dt T of layer a (from 0), P1 (9b), (9c):
 *   T^u = -(h/2) d_x(q_a + q_{a+1}) + d_x Z_a/l_a (q_{a+1} - q_a),  T^w = (q_a - q_{a+1})/l_a,
 * with q the mean of two faces, d_x q their difference and Z_a the middle of the layer. `low`, `high` are
 * the pressures below and above at the faces left of the cells; none at the surface. */
KERNEL_PART void force_add(const struct model_state *s, const struct force *force, int cells, int a,
	bool top, double dt, const double *restrict h, const double *restrict low,
	const double *restrict high, double *restrict U, double *restrict W)
{
	double n = dry_layers_of(s, a), dx = s->grid.dx, thin = 1 / dry_layer(s, a);
	double middle = 0.5 * (s->level[a] + s->level[a + 1]);

	for (int k = 0; k < cells; k++) {
		double high_l = top ? 0 : high[k], high_r = top ? 0 : high[k + 1];
		double xi = thin * ((middle * force->dh[k] + force->db[k]) / (2 * dx));
		double mean = 0.5 * (low[k] + low[k + 1]), mean_high = 0.5 * (high_l + high_r);
		double slope = (low[k + 1] - low[k] + high_r - high_l) / dx;

		U[k] += dt * (-0.5 * h[k] * slope + xi * (mean_high - mean));
		W[k] += dt * n * (mean - mean_high);
	}
}

/* The same for layer a of a chunk, with p a [layers][faces] field in p/rho units. */
KERNEL_PART void force_add_layer(struct model_state *s, const struct force *force,
	struct chunk chunk, int a, const double *p, double dt)
{
	size_t first = (size_t)chunk.first, row = (size_t)a * s->grid.stride + first;
	const double *low = p + (size_t)a * (size_t)s->grid.faces + first - 1, *h = s->h + first;
	int cells = chunk.last - chunk.first + 1;

	if (a < s->layers - 1)
		force_add(
			s, force, cells, a, false, dt, h, low, low + s->grid.faces, s->U + row, s->W + row);
	else
		force_add(s, force, cells, a, true, dt, h, low, low, s->U + row, s->W + row);
}

#endif
