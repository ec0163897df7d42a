/* The two generations of a run file in its folder. */
#include <string.h>

#include "base/file.h"
#include "run/run_file_parts.h"

/* Open one generation; what is wrong with it, or its warning, goes to `warning`. */
static int open_generation(const char *folder, const char *name, struct run_file **out,
	struct text *warning, struct error *err)
{
	struct text path = {0};
	const char *remark = NULL;
	char message[sizeof err->text + sizeof err->file];
	int result;

	TRY(file_path(&path, folder, name, err));
	result = run_file_open(text_string(&path), out, &remark, err);
	if (result == 0 && remark)
		text_addf(warning, "%s: %s", text_string(&path), remark);
	if (result != 0)
		text_add(warning, error_format(err, message, sizeof message));
	text_clean(&path);
	return result;
}

int run_file_open_newest(
	const char *folder, struct run_file **out, struct text *warning, struct error *err)
{
	struct error newest = {0}, previous = {0};

	if (open_generation(folder, RUN_FILE_NEWEST, out, warning, &newest) == 0)
		return 0;
	if (newest.code == EX_SOFTWARE || newest.code == EX_IOERR) {
		*err = newest;
		return -1;
	}
	text_add(warning, "; ");
	if (open_generation(folder, RUN_FILE_PREVIOUS, out, warning, &previous) == 0) {
		text_add(warning, "the previous generation is used");
		return 0;
	}
	text_clean(warning);
	if (previous.code == EX_SOFTWARE || previous.code == EX_IOERR) {
		*err = previous;
	} else if (newest.code == EX_NOINPUT && previous.code == EX_NOINPUT) {
		error_at(err, EX_NOINPUT, folder, 0, 0, "holds no run file");
	} else {
		char first[sizeof newest.text / 2], second[sizeof newest.text / 2];

		error_at(err, EX_DATAERR, folder, 0, 0, "no generation of its run file is good: %s; %s",
			error_format(&newest, first, sizeof first),
			error_format(&previous, second, sizeof second));
	}
	return -1;
}

int run_file_open_any(
	const char *path, struct run_file **out, struct text *warning, struct error *err)
{
	const char *remark = NULL;

	if (file_is_folder(path))
		return run_file_open_newest(path, out, warning, err);
	TRY(run_file_open(path, out, &remark, err));
	if (remark)
		text_addf(warning, "%s: %s", path, remark);
	return 0;
}

bool run_file_is_newest(const struct run_file *file)
{
	const char *name = strrchr(run_file_path(file), '/');

	return !strcmp(name ? name + 1 : run_file_path(file), RUN_FILE_NEWEST);
}
