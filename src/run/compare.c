#include "run/compare.h"

#include <stdlib.h>
#include <string.h>

#include "run/run_file_parts.h"

/* The keys by which the configs differ, where both can be read. */
static int compare_configs(
	struct run_file *a, struct run_file *b, struct text *out, struct error *err)
{
	struct config first, second;
	struct error unreadable = {0};
	struct text keys = {0};
	char *rest;

	if (run_file_config(a, &first, &unreadable) == 0 &&
		run_file_config(b, &second, &unreadable) == 0)
		config_differences(&first, &second, &keys);
	if (unreadable.code == EX_SOFTWARE)
		*err = unreadable;
	else if (keys.failed)
		error_memory(err, keys.capacity);
	for (char *key = keys.data ? strtok_r(keys.data, "\n", &rest) : NULL; key;
		 key = strtok_r(NULL, "\n", &rest))
		text_addf(out, "config %s\n", key);
	text_clean(&keys);
	return err->code ? -1 : 0;
}

static int compare_attributes(
	struct run_file *a, struct run_file *b, struct text *out, struct error *err)
{
	struct text first = {0}, second = {0};
	double version[2];
	int result = -1;

	if (run_file_text(a, "config_hash", &first, err) != 0 ||
		run_file_text(b, "config_hash", &second, err) != 0 ||
		run_file_real(a, "numerics_version", &version[0], err) != 0 ||
		run_file_real(b, "numerics_version", &version[1], err) != 0)
		goto done;
	if (strcmp(text_string(&first), text_string(&second)) != 0)
		text_addf(out, "config_hash: %s -> %s\n", text_string(&first), text_string(&second));
	if (version[0] != version[1])
		text_addf(out, "numerics_version: %g -> %g\n", version[0], version[1]);
	result = strcmp(text_string(&first), text_string(&second)) != 0
				 ? compare_configs(a, b, out, err)
				 : 0;
done:
	text_clean(&first);
	text_clean(&second);
	return result;
}

static void add_shape(struct text *out, const struct dataset *data)
{
	text_add(out, data->rank ? "" : "a scalar");
	for (int i = 0; i < data->rank; i++)
		text_addf(out, i ? " x %zu" : "%zu", data->extent[i]);
}

/* The place of value `index`, counted from 0: "[2, 14]". */
static void add_place(struct text *out, const struct dataset *data, size_t index)
{
	size_t place[3];

	for (int i = data->rank - 1; i >= 0; i--) {
		place[i] = index % data->extent[i];
		index /= data->extent[i];
	}
	for (int i = 0; i < data->rank; i++)
		text_addf(out, "%s%zu", i ? ", " : "[", place[i]);
	text_add(out, data->rank ? "]" : "");
}

static uint64_t bits(double value)
{
	uint64_t result;

	memcpy(&result, &value, sizeof result);
	return result;
}

static void compare_values(
	const char *path, const struct dataset *a, const struct dataset *b, struct text *out)
{
	char first[TEXT_REAL_SIZE], second[TEXT_REAL_SIZE];
	size_t count = 1, different = 0, where = 0;
	bool same_shape = a->rank == b->rank;

	for (int i = 0; same_shape && i < a->rank; i++) {
		same_shape = a->extent[i] == b->extent[i];
		count *= a->extent[i];
	}
	if (!same_shape) {
		text_addf(out, "%s: shape ", path);
		add_shape(out, a);
		text_add(out, " -> ");
		add_shape(out, b);
		text_add(out, "\n");
		return;
	}
	for (size_t i = count; i-- > 0;)
		if (bits(a->values[i]) != bits(b->values[i])) {
			different++;
			where = i;
		}
	if (!different)
		return;
	text_addf(out, "%s: %zu of %zu values differ, first ", path, different, count);
	add_place(out, a, where);
	text_addf(out, "%s%s -> %s\n", a->rank ? ": " : "", text_real(a->values[where], first),
		text_real(b->values[where], second));
}

static int compare_dataset(
	struct run_file *a, struct run_file *b, const char *path, struct text *out, struct error *err)
{
	struct dataset first = {0}, second = {0};
	int result = -1;

	if (run_file_dataset(a, path, &first, err) == 0 &&
		run_file_dataset(b, path, &second, err) == 0) {
		compare_values(path, &first, &second, out);
		result = 0;
	}
	free(first.values);
	free(second.values);
	return result;
}

/* Clocks are never the same twice, and axes without values say only what their datasets say. */
static bool is_exempt(const char *path)
{
	const char *name = strrchr(path, '/') + 1;

	return !strncmp(name, "cpu_", 4) || !strncmp(name, "wall_", 5) || !strncmp(name, "index_", 6);
}

/* What only `b` holds, of its list of names. */
static int tell_more(
	struct run_file *a, struct run_file *b, char *names, struct text *out, struct error *err)
{
	char *rest;
	bool has;

	for (char *path = strtok_r(names, "\n", &rest); path; path = strtok_r(NULL, "\n", &rest)) {
		if (is_exempt(path))
			continue;
		TRY(run_file_has(a, path, &has, err));
		if (!has)
			text_addf(out, "%s: only in %s\n", path, run_file_path(b));
	}
	return 0;
}

int compare_run_files(struct run_file *a, struct run_file *b, struct text *out, struct error *err)
{
	struct text first = {0}, second = {0};
	bool has;
	char *rest;
	int result = -1;

	if (compare_attributes(a, b, out, err) != 0 || run_file_names(a, &first, err) != 0 ||
		run_file_names(b, &second, err) != 0)
		goto done;
	for (char *path = strtok_r(first.data, "\n", &rest); path; path = strtok_r(NULL, "\n", &rest)) {
		if (is_exempt(path))
			continue;
		if (run_file_has(b, path, &has, err) != 0)
			goto done;
		if (!has)
			text_addf(out, "%s: only in %s\n", path, run_file_path(a));
		else if (compare_dataset(a, b, path, out, err) != 0)
			goto done;
	}
	if (tell_more(a, b, second.data, out, err) != 0)
		goto done;
	result = out->failed ? error_memory(err, out->capacity) : 0;
done:
	text_clean(&first);
	text_clean(&second);
	return result;
}
