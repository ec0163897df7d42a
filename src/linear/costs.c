#include "linear/costs.h"

#include "linear/elimination.h"
#include "linear/fast_diagonal.h"

/* Passes over padded columns of layers and of modes, and products with half a square of modes. */
double costs_gradients_iteration(int layers)
{
	double n = layers, column = (double)columns_make(layers, 1).stride;
	double modes = 2 * (double)fast_diagonal_half(layers);

	return (1.1 * column + 0.25 * modes) / n + 0.009 * n;
}

double costs_gradients_start(int layers)
{
	return 1.7 * costs_gradients_iteration(layers);
}

/* A square of layers, of which a row is in registers as long as the compiler knows its length. Beyond, a
 * strip alone takes 0.04; what it throws out of the cache makes it dearer. */
double costs_elimination_factor(int layers)
{
	int blocks = elimination_blocks(layers);
	double square = (double)layers * LANES * blocks;

	return blocks <= ELIMINATION_BLOCKS_KNOWN ? 9 + 0.025 * square : 20 + 0.06 * square;
}

double costs_elimination_solve(int layers)
{
	return elimination_blocks(layers) <= ELIMINATION_BLOCKS_KNOWN ? 3.3 : 2 + 0.14 * layers;
}
