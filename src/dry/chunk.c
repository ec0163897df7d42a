#include "dry/chunk.h"

int chunk_cells(int layers)
{
	int cells = 32 * CHUNK_CELLS / layers / LANES * LANES;

	return cells < CHUNK_CELLS ? cells : CHUNK_CELLS;
}

static struct chunk chunk_of(const struct model_state *s, int index, int count)
{
	/* of equal length, in whole vectors */
	int length = ((s->grid.cells + count - 1) / count + LANES - 1) / LANES * LANES;
	struct chunk chunk;

	chunk.first = 1 + index * length;
	chunk.last = chunk.first + length - 1;
	if (chunk.last > s->grid.cells)
		chunk.last = s->grid.cells;
	return chunk;
}

void chunk_each(struct model_state *s,
	void (*work)(struct model_state *s, struct chunk chunk, double dt), double dt)
{
	int count = (s->grid.cells + s->chunk_cells - 1) / s->chunk_cells;

#pragma omp parallel for num_threads(s->threads) if (s->threads > 1) schedule(static)
	for (int k = 0; k < count; k++)
		work(s, chunk_of(s, k, count), dt);
}
