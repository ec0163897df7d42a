/* A step goes over the cells in chunks, each with all its layers. */
#ifndef TALUS_CHUNK_H
#define TALUS_CHUNK_H

#include "dry/dry.h"

enum { CHUNK_CELLS = 256 }; /* in a chunk at most */

struct chunk {
	int first, last; /* cells, of 1..cells */
};

/* Cells of a chunk, so that what one step reads and writes of it stays in the second-level cache. */
int chunk_cells(int layers);

/* `work` for every chunk, shared out among the threads of the run. It may write what belongs to the
 * cells of its chunk, and read whatever no other chunk writes: the numbers are then the same whichever
 * thread does which chunk, and when. */
void chunk_each(struct model_state *s,
	void (*work)(struct model_state *s, struct chunk chunk, double dt), double dt);

#endif
