#include "dry/force.h"

KERNEL static void add(struct model_state *s, struct chunk chunk, double dt)
{
	struct force force;

	force_begin(s, chunk, &force);
	for (int a = 0; a < s->layers; a++)
		force_add_layer(s, &force, chunk, a, s->force, dt);
}

void dry_add_pressure_force(struct model_state *s, const double *p, double dt)
{
	s->force = p;
	chunk_each(s, add, dt);
}
