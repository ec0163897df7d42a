/* The batch script of a job array. */
#include <string.h>

#include "campaign/slurm.h"

static void add_assignment(struct text *out, const char *name, const char *text)
{
	text_addf(out, "%s=", name);
	text_add_word(out, text);
	text_add(out, "\n");
}

static void add_time(struct text *out, long seconds)
{
	text_addf(out, "#SBATCH --time=%ld-%02ld:%02ld:%02ld\n", seconds / 86400, seconds / 3600 % 24,
		seconds / 60 % 60, seconds % 60);
}

void slurm_script_range(const struct slurm_array *array, struct text *out)
{
	text_addf(out, "0-%zu", array->count - 1);
	if (array->throttle)
		text_addf(out, "%%%d", array->throttle);
}

static void add_directives(struct text *out, const struct slurm_array *array)
{
	const struct experiment_slurm *section = array->section;

	text_addf(out, "#SBATCH --job-name=%s\n#SBATCH --array=", array->name);
	slurm_script_range(array, out);
	text_add(out, "\n#SBATCH --ntasks=1\n");
	if (section->partition[0])
		text_addf(out, "#SBATCH --partition=%s\n", section->partition);
	if (section->time)
		add_time(out, section->time);
	if (section->memory[0])
		text_addf(out, "#SBATCH --mem=%s\n", section->memory);
	for (size_t i = 0; i < section->directives.count; i++) {
		const struct setting *directive = &section->directives.items[i];
		bool flag = !strcmp(directive->value, "true");

		if (strcmp(directive->value, "false") != 0)
			text_addf(out, "#SBATCH --%s%s%s\n", directive->key, flag ? "" : "=",
				flag ? "" : directive->value);
	}
	text_addf(out, "#SBATCH --signal=B:USR1@%d\n", section->grace);
	text_addf(out, "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --output=%s/%s.log\n",
		SLURM_FOLDER, array->name);
}

/* The program runs in the background, because bash defers traps while one is in the foreground and
 * --signal=B: reaches the batch shell alone. 75 is talus that stopped with its checkpoint written; 138
 * and 143 are USR1 and TERM before it listened, or when it ended at the same moment. */
static const char body[] =
	"child= stop=\n"
	"forward()\n"
	"{\n"
	"\tstop=$1\n"
	"\t[[ ! $child ]] || kill -s \"$1\" \"$child\" 2>/dev/null\n"
	"}\n"
	"trap 'forward USR1' USR1\n"
	"trap 'forward TERM' TERM\n"
	"\n"
	"cd \"$folder\" || exit 74\n"
	"IFS=$'\\t' read -r -a words < <(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" \"$runs\")\n"
	"run=${words[0]}\n"
	"[[ $run && -d $run ]] || {\n"
	"\techo \"task $SLURM_ARRAY_TASK_ID: $folder/$run: there is no such run folder\"\n"
	"\texit 74\n"
	"}\n"
	"log=./$run/run.log # nothing is written to a link or a pipe in its place\n"
	"[[ ! -L $log && (-f $log || ! -e $log) ]] || {\n"
	"\techo \"task $SLURM_ARRAY_TASK_ID: $folder/$run/run.log is not a regular file\"\n"
	"\texit 74\n"
	"}\n"
	"exec >>\"$log\" 2>&1 || exit 74\n"
	"\n"
	"# bash acts on a signal only while it waits\n"
	"\"$program\" run \"./$run/config.yaml\" -o \"./$run\" --quiet \"${words[@]:1}\" &\n"
	"child=$!\n"
	"[[ ! $stop ]] || kill -s \"$stop\" \"$child\" 2>/dev/null\n"
	"while wait \"$child\"; code=$?; ((code > 128)) && kill -0 \"$child\" 2>/dev/null; do :; done\n"
	"case $code in\n"
	"75 | 138 | 143) ;;\n"
	"*) exit \"$code\" ;;\n"
	"esac\n"
	"\n"
	"# Stopped: back into the queue, unless Slurm ends this job for another reason than its time limit\n"
	"# (scancel, scontrol requeue, preemption) and knows itself what comes next.\n"
	"for pause in 5 10 20 0; do\n"
	"\tstate=$(squeue --noheader --jobs=\"$SLURM_JOB_ID\" --format='%T %r') && break\n"
	"\tsleep \"$pause\"\n"
	"done\n"
	"case $state in\n"
	"RUNNING* | SIGNALING* | *TimeLimit) scontrol requeue \"$SLURM_JOB_ID\" && exit 0 ;;\n"
	"esac\n"
	"exit 75\n";

void slurm_script_write(const struct slurm_array *array, struct text *out)
{
	text_add(out, "#!/bin/bash\n");
	add_directives(out, array);
	text_add(out, "\n");
	add_assignment(out, "folder", array->folder);
	text_addf(out, "runs='%s/%s.runs'\n", SLURM_FOLDER, array->name);
	add_assignment(out, "program", array->program);
	text_add(out, "\n");
	text_add(out, body);
}
