/* The machine's rates, measured by kernels of the kind that the solvers are made of, and how near a step of
 * the dry model comes to them.
 *
 * usage: bench_roofline [RUN-FOLDER]...     finished runs by conjugate-gradients
 *
 * Counted are the sums, products, quotients and roots that the formulas ask for per unknown (a cell and
 * layer), and the bytes of whole fields that a pass reads and writes, as if a pass found nothing of the
 * pass before in the registers and rows within a pass were free; without padding, and 4 bytes for what is
 * in single precision. A step can then not be faster than its operations by the rate of operations, nor
 * than its bytes by the bandwidth; the fraction is the larger of the two over the time that was taken. */
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/kernel.h"
#include "run/run_file_parts.h"
#include "talus/config.h"

/* Per unknown of a step, and of an iteration: source of the pass, operations, bytes. `modes` is the
 * number of operations per layer of a transform. */
static const struct pass {
	const char *name;
	double operations, modes, bytes;
	bool iterated;
} passes[] = {
	{"velocities and their sums", 8, 0, 32, false},
	{"transport: two components, jumps, force", 97, 0, 56, false},
	{"friction: up and down", 35, 0, 64, false},
	{"right side", 26, 0, 40, false},
	{"force of the fluctuation", 21, 0, 64, false},
	{"true residual", 28, 0, 16, false},
	{"conjugate gradients: begin, factor, finish", 14, 1, 104, false},
	{"residual, to modes", 4, 1, 28, true},
	{"tridiagonal systems of the modes", 7, 0, 28, true},
	{"to layers, direction, x, product", 30, 1, 44, true},
};

enum { REPEATS = 7 };

/* Products and sums that wait for nothing, in ten registers: operations per second. */
KERNEL static double spin(long count)
{
	v8 sum[10], factor = {0.5, 0.25, 0.5, 0.25, 0.5, 0.25, 0.5, 0.25};

	for (int k = 0; k < 10; k++)
		sum[k] = factor * (double)k;
	for (long i = 0; i < count; i++)
		for (int k = 0; k < 10; k++)
			sum[k] = sum[k] * factor + factor;
	for (int k = 1; k < 10; k++)
		sum[0] += sum[k];
	return v8_sum(sum[0]);
}

/* a = b + s c: three arrays of `count`. */
KERNEL static void triad(double *a, const double *b, const double *c, double s, size_t count)
{
	for (size_t i = 0; i < count; i += LANES)
		v8_store(a + i, v8_load(b + i) + s * v8_load(c + i));
}

static double operations_per_second(void)
{
	static volatile double sink;
	const long count = 4000000;
	double best = 0;

	for (int i = 0; i < REPEATS; i++) {
		double start = clock_cpu(), rate;

		sink = spin(count);
		rate = 20.0 * LANES * (double)count / (clock_cpu() - start);
		best = rate > best ? rate : best;
	}
	(void)sink;
	return best;
}

/* Of arrays that take `bytes` together; 0: no memory. */
static double bytes_per_second(size_t bytes)
{
	size_t count = bytes / sizeof(double) / 3 / LANES * LANES;
	double *memory = calloc(3 * count, sizeof *memory), best = 0;
	long rounds = (long)(4e8 / (double)bytes) + 1;

	for (int i = 0; i < REPEATS && memory; i++) {
		double start = clock_cpu(), rate;

		for (long k = 0; k < rounds; k++)
			triad(memory, memory + count, memory + 2 * count, 0.5 + (double)k, count);
		rate = 3.0 * sizeof(double) * (double)count * (double)rounds / (clock_cpu() - start);
		best = i > 0 && rate > best ? rate : best;
	}
	free(memory);
	return best;
}

static int mean_iterations(struct run_file *file, double *mean, struct error *err)
{
	struct dataset data = {0};

	TRY(run_file_dataset(file, "pressure_iterations", &data, err));
	*mean = 0;
	for (size_t i = 1; i < data.extent[0]; i++) /* the first is the start, without a step */
		*mean += data.values[i] / (double)(data.extent[0] - 1);
	free(data.values);
	return 0;
}

static int read_config(struct run_file *file, struct config *config, struct error *err)
{
	struct text text = {0};
	int result = run_file_text(file, "config", &text, err);

	if (result == 0)
		result = config_parse(config, text.data, text.length, "config", NULL, 0, err);
	text_clean(&text);
	return result;
}

static void print_row(const struct config *config, double iterations, double took,
	double operations_rate, double bytes_rate)
{
	double operations = 0, bytes = 0, least;

	for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
		double times = passes[i].iterated ? iterations : 1;

		operations += times * (passes[i].operations + passes[i].modes * config->layers);
		bytes += times * passes[i].bytes;
	}
	least = 1e9 * operations / operations_rate;
	if (1e9 * bytes / bytes_rate > least)
		least = 1e9 * bytes / bytes_rate;
	(void)printf("| %d x %d | %.1f | %.0f | %.0f | %.1f | %.1f | %.0f %% |\n", config->domain.cells,
		config->layers, iterations, operations, bytes, least, took, 100 * least / took);
}

static int judge(const char *folder, double operations_rate, double bytes_rate, struct error *err)
{
	struct run_file *file = NULL;
	struct text warning = {0};
	struct config config;
	double seconds, iterations;
	int result = run_file_open_newest(folder, &file, &warning, err);

	if (result == 0 && (result = run_file_real(file, "cpu_seconds", &seconds, err)) == 0 &&
		(result = read_config(file, &config, err)) == 0 &&
		(result = mean_iterations(file, &iterations, err)) == 0) {
		double unknowns = (double)config.domain.cells * config.layers;
		double steps = (double)run_file_summary(file)->step;

		print_row(
			&config, iterations, 1e9 * seconds / unknowns / steps, operations_rate, bytes_rate);
	}
	text_clean(&warning);
	run_file_close(file);
	return result;
}

int main(int count, char **arguments)
{
	/* the fields of the pressure step at 640 x 20 take some 2 MB; larger than any cache: 400 MB */
	double operations = operations_per_second(), near = bytes_per_second(2000000);
	double far = bytes_per_second(400000000);
	struct error err = {0};
	char message[3072];

	(void)printf("One core of this machine: %.1f GFLOP/s of separate products and sums in double "
				 "precision, %.1f GB/s among 2 MB, %.1f GB/s from memory.\n",
		1e-9 * operations, 1e-9 * near, 1e-9 * far);
	if (count < 2)
		return 0;
	(void)printf("\n| cells x layers | iterations | operations | bytes | least ns | ns taken | "
				 "reached |\n| --: | --: | --: | --: | --: | --: | --: |\n");
	for (int i = 1; i < count; i++)
		if (judge(arguments[i], operations, near, &err) != 0) {
			(void)fprintf(stderr, "%s\n", error_format(&err, message, sizeof message));
			return err.code;
		}
	return 0;
}
