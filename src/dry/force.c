/* The force of a non-hydrostatic pressure on the layers (P1 9b, 9c). */
#include "base/kernel.h"
#include "dry/chunk.h"
#include "dry/dry.h"

/* One layer of a chunk: T^u = -(h/2) d_x(q_a + q_{a+1}) + xi_a (q_{a+1} - q_a), T^w = N (q_a - q_{a+1}),
 * with q the mean of two faces and d_x q their difference, and `xi` times dt at hand. `low`, `high` are
 * the pressures below and above; at the surface there is none. */
KERNEL_PART void add_layer(int cells, double dt, double n, double dx, double middle, bool top,
	const double *restrict h, const double *restrict b, const double *restrict low,
	const double *restrict high, double *restrict U, double *restrict W)
{
	for (int k = 0; k < cells; k++) {
		int l = k, r = k + 1; /* faces; and the cells at either side */
		double hl = top ? 0 : high[l], hr = top ? 0 : high[r];
		double xi = (middle * (h[k + 1] - h[k - 1]) + n * (b[k + 1] - b[k - 1])) / (2 * dx);
		double mean = 0.5 * (low[l] + low[r]), mean_high = 0.5 * (hl + hr);
		double slope = (low[r] - low[l] + hr - hl) / dx;

		U[k] += dt * (-0.5 * h[k] * slope + xi * (mean_high - mean));
		W[k] += dt * n * (mean - mean_high);
	}
}

KERNEL static void add_force(struct model_state *s, struct chunk chunk, double dt)
{
	size_t first = (size_t)chunk.first, faces = (size_t)s->grid.faces;
	int cells = chunk.last - chunk.first + 1, top = s->layers - 1;
	const double *h = s->h + first, *b = s->b + first;

	for (int a = 0; a <= top; a++) {
		size_t row = (size_t)a * s->grid.stride + first;
		const double *low = s->force + (size_t)a * faces + first - 1;

		if (a < top)
			add_layer(cells, dt, s->layers, s->grid.dx, a + 0.5, false, h, b, low, low + faces,
				s->U + row, s->W + row);
		else
			add_layer(cells, dt, s->layers, s->grid.dx, a + 0.5, true, h, b, low, low, s->U + row,
				s->W + row);
	}
}

void dry_add_pressure_force(struct model_state *s, const double *p, double dt)
{
	s->force = p;
	chunk_each(s, add_force, dt);
}
