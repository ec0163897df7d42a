/* What the hot loops are written with: vectors of eight, and functions compiled once for every vector
 * width of this decade, of which the machine's own is taken at run time.
 *
 * The bits do not depend on the width: a vector of eight is eight lanes everywhere (two of AVX2, four of
 * SSE2), products and sums are never fused (-ffp-contract=off), and sums over many values are kept in
 * eight lanes that are added in one fixed order at the end. A loop that the compiler vectorises by
 * itself must therefore not reduce. */
#ifndef TALUS_KERNEL_H
#define TALUS_KERNEL_H

#include <stddef.h>

/* Before a function: one copy for AVX-512, one for AVX2, one for any x86-64. Under sanitizers the plain
 * copy alone: they are not ready when the choice is made; with clang too. */
#if defined __GNUC__ && !defined __clang__ && defined __x86_64__ &&                                \
	!defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__ && !defined TALUS_PLAIN_KERNELS
#define KERNEL __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define KERNEL
#endif

#define KERNEL_PART static inline __attribute__((always_inline)) /* a piece of kernels, inlined */

enum { LANES = 8 };

/* Loaded from and stored to any address of a double. */
typedef double v8 __attribute__((vector_size(LANES * sizeof(double)), aligned(8), may_alias));

/* Sixteen of single precision, and eight, for what need not be exact. */
typedef float v16f __attribute__((vector_size(2 * LANES * sizeof(float)), aligned(4), may_alias));
typedef float v8f __attribute__((vector_size(LANES * sizeof(float)), aligned(4), may_alias));

#pragma GCC diagnostic ignored                                                                     \
	"-Wpsabi" /* how vectors are passed: they never are, all is inlined */

KERNEL_PART v8 v8_load(const double *from)
{
	return *(const v8 *)from;
}

KERNEL_PART void v8_store(double *to, v8 value)
{
	*(v8 *)to = value;
}

/* Where vector k of a row begins. */
KERNEL_PART size_t v8_at(int k)
{
	return (size_t)k * LANES;
}

/* A row of values kept as vectors: value i - 1, and value i + 1, in the lanes of vector k. Zero beyond. */
KERNEL_PART v8 v8_before(const v8 *row, int k)
{
	v8 before = k > 0 ? row[k - 1] : (v8){0};

	return __builtin_shufflevector(before, row[k], 7, 8, 9, 10, 11, 12, 13, 14);
}

KERNEL_PART v8 v8_after(const v8 *row, int k, int count)
{
	v8 after = k + 1 < count ? row[k + 1] : (v8){0};

	return __builtin_shufflevector(row[k], after, 1, 2, 3, 4, 5, 6, 7, 8);
}

/* The numbers of the values in vector k. */
KERNEL_PART v8 v8_numbers(int k)
{
	return (v8){0, 1, 2, 3, 4, 5, 6, 7} + (double)(k * LANES);
}

/* 1 in the lanes where a comparison holds, else 0. */
#define V8_WHERE(comparison) ((v8){0} - __builtin_convertvector(comparison, v8))

/* The eight lanes in one order. */
KERNEL_PART double v8_sum(v8 v)
{
	return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/* Sum of a[i] b[i]: lanes, then what is left over. */
KERNEL_PART double kernel_dot(const double *a, const double *b, int count)
{
	v8 lanes = {0};
	double rest = 0;
	int i = 0;

	for (; i + LANES <= count; i += LANES)
		lanes += v8_load(a + i) * v8_load(b + i);
	for (; i < count; i++)
		rest += a[i] * b[i];
	return v8_sum(lanes) + rest;
}

#endif
