/* What Slurm is asked and told when runs are submitted: scontrol and sbatch. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/process.h"
#include "campaign/slurm.h"

int slurm_check(struct error *err)
{
	static const char *const version[] = {"sbatch", "--version", NULL};
	struct text ignored = {0};
	int result = process_run(version, SLURM_PATIENCE, &ignored, err);

	text_clean(&ignored);
	return result ? error_context(err, "--executor slurm") : 0;
}

/* MaxArraySize: the greatest index is one less. */
int slurm_array_size(size_t *size, struct error *err)
{
	static const char *const scontrol[] = {"scontrol", "show", "config", NULL};
	static const char key[] = "\nMaxArraySize";
	struct text out = {0};
	const char *line;
	int result = process_run(scontrol, SLURM_PATIENCE, &out, err);

	if (result == 0) {
		line = strstr(text_string(&out), key);
		line = line ? strchr(line, '=') : NULL;
		*size = line ? strtoul(line + 1, NULL, 10) : SLURM_ARRAY_SIZE;
		if (!*size)
			result = error_set(err, EX_UNAVAILABLE, "this cluster has no job arrays");
	}
	text_clean(&out);
	return result;
}

static int write_file(
	const struct slurm_array *array, const char *ending, const struct text *text, struct error *err)
{
	struct text folder = {0}, full = {0};
	int result = -1;

	text_addf(&full, "%s%s", array->name, ending);
	if (text->failed || full.failed)
		error_memory(err, text->capacity);
	else if (!file_path(&folder, array->folder, SLURM_FOLDER, err))
		result = file_replace(
			&(struct file_place){.folder = folder.data, .name = full.data, .durable = true},
			&(struct file_part){text->data, text->length}, 1, err);
	text_clean(&folder);
	text_clean(&full);
	return result;
}

/* By the arguments go what paths could break in a directive, what differs from one submission to the
 * next, and what a variable of the user's environment must not change. */
static int call_sbatch(const struct slurm_array *array, const struct text *after,
	char job[static SLURM_JOB_SIZE], struct error *err)
{
	struct text chdir = {0}, name = {0}, range = {0}, dependency = {0}, script = {0}, out = {0};
	const char *sbatch[8] = {"sbatch", "--parsable"};
	int result = -1;

	text_addf(&chdir, "--chdir=%s", array->folder);
	text_addf(&name, "--job-name=%s", array->name);
	text_add(&range, "--array=");
	slurm_script_range(array, &range);
	text_addf(&dependency, "--dependency=afterany%s", text_string(after));
	text_addf(&script, "%s/" SLURM_FOLDER "/%s.sh", array->folder, array->name);
	if (chdir.failed || name.failed || range.failed || dependency.failed || script.failed ||
		after->failed) {
		error_memory(err, PATH_MAX);
		goto done;
	}
	sbatch[2] = chdir.data;
	sbatch[3] = name.data;
	sbatch[4] = range.data;
	sbatch[5] = after->length ? dependency.data : script.data;
	sbatch[6] = after->length ? script.data : NULL;
	result = process_run(sbatch, SLURM_PATIENCE, &out, err);
	if (result == 0 && sscanf(text_string(&out), "%15[0-9]", job) != 1)
		result = error_set(err, EX_UNAVAILABLE, "sbatch did not tell the number of the job");
done:
	text_clean(&chdir);
	text_clean(&name);
	text_clean(&range);
	text_clean(&dependency);
	text_clean(&script);
	text_clean(&out);
	return result;
}

int slurm_submit(const struct slurm_array *array, const struct text *runs, const struct text *after,
	char job[static SLURM_JOB_SIZE], struct error *err)
{
	struct text script = {0};
	int result = write_file(array, ".runs", runs, err);

	slurm_script_write(array, &script);
	if (result == 0)
		result = write_file(array, ".sh", &script, err);
	text_clean(&script);
	return result ? result : call_sbatch(array, after, job, err);
}
