/* talus campaign prune: remove the folders of runs that no experiment names any more. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "campaign/leftover.h"
#include "cli/campaign.h"

static size_t count_removed(const struct leftover_list *list)
{
	size_t count = 0;

	for (size_t i = 0; i < list->count; i++)
		count += !list->items[i].kept;
	return count;
}

static void show(const struct leftover_list *list, struct text *out)
{
	double bytes = 0, cpu = 0;
	char size[FILE_SIZE_TEXT], span[CLOCK_SPAN_SIZE];

	for (size_t i = 0; i < list->count; i++) {
		const struct leftover *leftover = &list->items[i];

		text_addf(out, "%s: %s, %s of CPU time, %s", leftover->folder,
			run_state_name(leftover->report.state), clock_span(leftover->report.cpu_seconds, span),
			file_size_text(leftover->bytes, size));
		text_addf(out, leftover->kept ? "; kept: %s\n" : "\n", leftover->kept);
		bytes += leftover->kept ? 0 : leftover->bytes;
		cpu += leftover->kept ? 0 : leftover->report.cpu_seconds;
	}
	text_addf(out, "%zu to be removed, %s, %s of CPU time\n", count_removed(list),
		file_size_text(bytes, size), clock_span(cpu, span));
}

/* Asked on a terminal; elsewhere --yes is the only yes. */
static bool is_allowed(const struct campaign_arguments *arguments)
{
	char answer[16] = "";

	if (arguments->yes)
		return true;
	if (!isatty(STDIN_FILENO)) {
		(void)fprintf(stderr, "talus: nothing was removed; --yes removes them\n");
		return false;
	}
	(void)fprintf(stderr, "remove them? [y/N] ");
	return fgets(answer, sizeof answer, stdin) && (answer[0] == 'y' || answer[0] == 'Y');
}

static int remove_all(const struct leftover_list *list)
{
	struct text out = {0};
	size_t removed = 0;
	int code = 0;

	for (size_t i = 0; i < list->count; i++) {
		struct error err = {0};

		if (list->items[i].kept)
			continue;
		if (leftover_remove(&list->items[i], &err))
			code = command_fail(&err);
		else
			removed++;
	}
	text_addf(&out, "%zu removed\n", removed);
	return code ? (text_clean(&out), code) : command_print(&out);
}

/* The experiments named after the first may have runs in the same folder. */
static int prune(
	const struct campaign_arguments *arguments, const struct experiment *experiments, size_t count)
{
	struct leftover_list list;
	struct text out = {0};
	struct error err = {0};
	int code = 0;

	if (leftover_list_read(experiments, count, &list, &err)) {
		code = command_fail(&err);
	} else if (!list.count) {
		text_addf(&out, "every run folder in %s is named\n", experiments[0].folder);
		code = command_print(&out);
	} else {
		show(&list, &out);
		code = command_print(&out);
		if (!code && count_removed(&list) && is_allowed(arguments))
			code = remove_all(&list);
	}
	leftover_list_clean(&list);
	return code;
}

static int prune_main(
	const struct campaign_arguments *arguments, const struct experiment *experiment)
{
	size_t count = (size_t)arguments->name_count, read = 0;
	struct experiment *all = calloc(count + 1, sizeof *all);
	struct error err = {0};
	int result = 0, code;

	if (!all) {
		(void)error_memory(&err, (count + 1) * sizeof *all);
		return command_fail(&err);
	}
	all[0] = *experiment;
	for (; !result && read < count; read++)
		result = experiment_read(&all[read + 1], arguments->names[read], experiment->folder,
			arguments->settings.list, arguments->settings.count, &err);
	code = result ? command_fail(&err) : prune(arguments, all, count + 1);
	for (size_t i = 0; i < read; i++)
		experiment_clean(&all[i + 1]);
	free(all);
	return code;
}

const struct campaign_action campaign_action_prune = {
	.name = "prune",
	.summary =
		"Remove the folders of runs that the experiment no longer names, after showing them.",
	.usage = "[OPTION]... EXPERIMENT [EXPERIMENT]...",
	.help =
		"example: talus campaign prune experiments/quickstart.yaml\n\n"
		"Only run folders are touched: their name ends with the hash of the config in them, and they\n"
		"hold nothing but the files of a run. Further experiments are those that share the folder.\n"
		"A run that another one goes on from is kept until that is complete.\n\n"
		"options:\n"
		"  -y, --yes             remove without asking (default: ask; show only, where nobody can\n"
		"                        be asked)\n" CAMPAIGN_OPTIONS_OF_ALL
		"exit: 0 done, or nothing was to be done, 65 bad experiment, 74 something cannot be removed\n",
	.options = "y",
	.names = true,
	.main = prune_main,
};
