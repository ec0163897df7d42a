#include "run/verify.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"

static void check_growth(const char *path, const struct dataset *times, struct text *out)
{
	if (times->rank != 1 || times->extent[0] < 1) {
		text_addf(out, "%s: is not a list of times\n", path);
		return;
	}
	for (size_t i = 0; i < times->extent[0]; i++)
		if (!(times->values[i] >= 0) || (i && !(times->values[i] > times->values[i - 1]))) {
			text_addf(out, "%s: does not grow at [%zu]: %.17g\n", path, i, times->values[i]);
			return;
		}
}

/* Every axis has a scale, and its length. */
static int check_lengths(struct run_file *file, struct text *out, struct error *err)
{
	struct text names = {0};
	struct dataset data;
	char *rest;
	int result = run_file_names(file, &names, err);

	for (char *path = result ? NULL : strtok_r(names.data, "\n", &rest); path;
		 path = strtok_r(NULL, "\n", &rest)) {
		if (run_file_dataset(file, path, &data, err) != 0) {
			result = -1;
			goto done;
		}
		free(data.values);
		for (int i = 0; i < data.rank; i++) {
			size_t length;

			result = run_file_scale_length(file, path, i, &length, err);
			if (result != 0)
				goto done;
			if (length != data.extent[i])
				text_addf(out, "%s: axis %d has %zu values, its scale %zu\n", path, i,
					data.extent[i], length);
		}
	}
done:
	text_clean(&names);
	return result;
}

/* The sum of some 1e5 masses at rounding error stays far below 1e-12; and each step rounds all of them. */
bool verify_mass(
	const double *mass, const double *left, size_t count, uint64_t steps, struct text *out)
{
	double first = count ? mass[0] + left[0] : 0, worst = 0;

	for (size_t i = 0; i < count; i++) {
		double off = fabs(mass[i] + left[i] - first);

		if (isnan(off) || off > worst) /* once a NaN, always a NaN */
			worst = off;
	}
	if (worst <= (1e-12 + DBL_EPSILON * (double)steps) * fabs(first))
		return true;
	text_addf(out, "mass and mass_outflow add up to %.17g at first and %.3g from it later\n", first,
		worst);
	return false;
}

static int check_mass(struct run_file *file, struct text *out, struct error *err)
{
	struct dataset mass = {0}, outflow = {0};
	bool has_mass, has_outflow;
	int result = -1;

	TRY(run_file_has(file, "/mass", &has_mass, err));
	TRY(run_file_has(file, "/mass_outflow", &has_outflow, err));
	if (!has_mass || !has_outflow)
		return 0;
	if (run_file_dataset(file, "/mass", &mass, err) != 0 ||
		run_file_dataset(file, "/mass_outflow", &outflow, err) != 0)
		goto done;
	result = 0;
	if (mass.rank == 1 && outflow.rank == 1 && mass.extent[0] == outflow.extent[0])
		(void)verify_mass(
			mass.values, outflow.values, mass.extent[0], run_file_summary(file)->step, out);
done:
	free(mass.values);
	free(outflow.values);
	return result;
}

static void check_number(const char *name, double inside, double told, struct text *out)
{
	if (inside != told)
		text_addf(out, "%s: is %.17g and the trailer says %.17g\n", name, inside, told);
}

static void check_text(const char *name, const char *inside, const char *told, struct text *out)
{
	if (strcmp(inside, told) != 0)
		text_addf(out, "%s: is '%s' and the trailer says '%s'\n", name, inside, told);
}

/* The trailer, by which `status` and campaigns go, says what the file says. */
static int check_summary(struct run_file *file, struct text *out, struct error *err)
{
	const struct run_summary *summary = run_file_summary(file);
	struct text status = {0}, hash = {0};
	double step, time;
	int result = -1;

	if (run_file_text(file, "status", &status, err) != 0 ||
		run_file_text(file, "config_hash", &hash, err) != 0 ||
		run_file_fill(file, "/checkpoint/step", &step, 1, err) != 0 ||
		run_file_fill(file, "/checkpoint/time", &time, 1, err) != 0)
		goto done;
	check_text("status", text_string(&status), run_status_name(summary->status), out);
	check_text("config_hash", text_string(&hash), summary->config_hash, out);
	check_number("/checkpoint/step", step, (double)summary->step, out);
	check_number("/checkpoint/time", time, summary->time, out);
	result = 0;
done:
	text_clean(&status);
	text_clean(&hash);
	return result;
}

/* The series end where the run stands: at the checkpoint, or, of a run that goes on, before it. */
static void check_end(const struct run_file *file, const struct dataset *times, struct text *out)
{
	const struct run_summary *summary = run_file_summary(file);
	double last = times->rank == 1 && times->extent[0] ? times->values[times->extent[0] - 1] : 0;

	if (last > summary->time || (summary->status == RUN_COMPLETE && last != summary->time))
		text_addf(out, "/time: ends at %.17g and the run stands at %.17g\n", last, summary->time);
}

int verify_run_file(struct run_file *file, struct text *out, struct error *err)
{
	struct dataset times = {0}, profile_times = {0};
	bool profiles;
	int result = -1;

	if (run_file_dataset(file, "/time", &times, err) != 0 ||
		run_file_has(file, "/profile_time", &profiles, err) != 0)
		goto done;
	check_growth("/time", &times, out);
	check_end(file, &times, out);
	if (profiles) {
		if (run_file_dataset(file, "/profile_time", &profile_times, err) != 0)
			goto done;
		check_growth("/profile_time", &profile_times, out);
	}
	if (check_summary(file, out, err) != 0 || check_lengths(file, out, err) != 0 ||
		check_mass(file, out, err) != 0)
		goto done;
	result = out->failed ? error_memory(err, out->capacity) : 0;
done:
	free(times.values);
	free(profile_times.values);
	return result;
}
