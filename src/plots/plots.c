/* Figures from beginning to end: panels, a script, gnuplot, and files that are replaced whole. */
#include "talus/plots.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "plots/gnuplot.h"
#include "plots/panel.h"
#include "plots/plots_parts.h"
#include "plots/script.h"

static const char *const format_names[] = {"svg", "png", "pdf"};
enum { FORMATS = sizeof format_names / sizeof *format_names };

unsigned plots_format_find(const char *name)
{
	for (unsigned i = 0; i < FORMATS; i++)
		if (!strcmp(name, format_names[i]))
			return 1U << i;
	return 0;
}

void plots_output_clean(struct plots_output *output)
{
	text_clean(&output->written);
	text_clean(&output->missing);
	text_clean(&output->notes);
}

/* Names of one file of a figure: what gnuplot writes, and what it becomes. */
struct file_names {
	char *drawn, *path; /* path of both */
	char *name;         /* of what gnuplot writes, within the folder */
	const char *format;
};

static void names_clean(struct file_names *names)
{
	for (int i = 0; i < FORMATS; i++) {
		if (names[i].drawn)
			(void)unlink(names[i].drawn);
		free(names[i].drawn);
		free(names[i].path);
		free(names[i].name);
	}
}

static int name_files(const struct plots_output *output, const char *name, struct file_names *names,
	size_t *count, struct error *err)
{
	*count = 0;
	for (unsigned i = 0; i < FORMATS; i++) {
		struct file_names *one = &names[*count];
		const char *format = format_names[i];

		if (!(output->formats & 1U << i))
			continue;
		++*count;
		one->format = format;
		if (asprintf(&one->name, ".%s.%ld.%s", name, (long)getpid(), format) < 0)
			one->name = NULL;
		else if (asprintf(&one->drawn, "%s/%s", output->folder, one->name) < 0)
			one->drawn = NULL;
		else if (asprintf(&one->path, "%s/%s.%s", output->folder, name, format) < 0)
			one->path = NULL;
		if (!one->path)
			return error_memory(err, strlen(output->folder) + strlen(name));
	}
	return 0;
}

/* What gnuplot drew takes the place of the figure that was there. */
static int replace_files(
	struct plots_output *output, const struct file_names *names, size_t count, struct error *err)
{
	for (size_t i = 0; i < count; i++) {
		if (!names[i].drawn || access(names[i].drawn, R_OK) != 0)
			return error_at(err, EX_IOERR, names[i].path, 0, 0,
				"was not drawn: the disk may be full (%s)", strerror(errno));
		if (rename(names[i].drawn, names[i].path) != 0)
			return error_at(
				err, EX_CANTCREAT, names[i].path, 0, 0, "cannot be written: %s", strerror(errno));
		text_addf(&output->written, "%s\n", names[i].path);
	}
	return 0;
}

/* A run that is missing in several panels is named once. */
static void add_missing(struct plots_output *output, const char *lines)
{
	while (*lines) {
		size_t length = strcspn(lines, "\n") + 1;
		char *line = strndup(lines, length);

		if (!line)
			output->missing.failed = true;
		else if (!strstr(text_string(&output->missing), line))
			text_add(&output->missing, line);
		free(line);
		lines += length;
	}
}

int plots_write(const struct figure *figure, struct plots_output *output, struct error *err)
{
	struct file_names names[FORMATS] = {{0}};
	struct script_output outputs[FORMATS];
	struct text script = {0};
	size_t count = 0;
	int result = -1;

	add_missing(output, text_string(&figure->missing));
	if (!figure->panel_count)
		return 0;
	if (file_make_folders(output->folder, err) ||
		name_files(output, figure->name, names, &count, err))
		goto done;
	if (access(output->folder, W_OK | X_OK) != 0) {
		error_at(
			err, EX_CANTCREAT, output->folder, 0, 0, "cannot be written to: %s", strerror(errno));
		goto done;
	}
	for (size_t i = 0; i < count; i++)
		outputs[i] = (struct script_output){names[i].format, names[i].name};
	script_write(figure, outputs, count, &script);
	if (script.failed)
		error_memory(err, script.length);
	else if (!gnuplot_run(output->folder, &script, err))
		result = replace_files(output, names, count, err);
done:
	text_clean(&script);
	names_clean(names);
	return result;
}

int plots_draw(const struct experiment *experiment, const struct experiment_plot *plot,
	struct plots_output *output, struct error *err)
{
	struct figure figure = {.name = plot->name.text, .columns = plot->columns};
	const char *title = *plot->title ? plot->title : experiment->title;
	int result = 0;

	text_add(&figure.title, title);
	if (*experiment->source)
		text_addf(&figure.title, "%s(%s)", *title ? " " : "", experiment->source);
	for (size_t i = 0; !result && i < plot->panel_count; i++)
		result = panel_build(experiment, plot, &plot->panels[i], &figure, err);
	if (!result && (figure.title.failed || figure.missing.failed))
		result = error_memory(err, figure.missing.length);
	if (!result)
		result = plots_write(&figure, output, err);
	figure_clean(&figure);
	return result;
}

int plots_check(const struct experiment *experiment, struct error *err)
{
	for (size_t i = 0; i < experiment->plot_count; i++)
		for (size_t k = 0; k < experiment->plots[i].panel_count; k++)
			TRY(panel_check(
				experiment, &experiment->plots[i], &experiment->plots[i].panels[k], err));
	return 0;
}
