/* Figures from beginning to end: panels, a script, gnuplot, and files that are replaced whole. */
#include "talus/plots.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
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

/* One file of a figure. gnuplot draws it in memory: it does not tell when a disk is full. */
struct drawing {
	const char *format;
	char *name;      /* within the folder */
	int fd;          /* -1: none */
	char source[32]; /* the path that gnuplot writes to */
};

static void drawings_clean(struct drawing *drawings, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		if (drawings[i].fd >= 0)
			(void)close(drawings[i].fd);
		free(drawings[i].name);
	}
}

static int drawings_open(
	unsigned formats, const char *name, struct drawing *drawings, size_t *count, struct error *err)
{
	*count = 0;
	for (unsigned i = 0; i < FORMATS; i++) {
		struct drawing *one = &drawings[*count];

		if (!(formats & 1U << i))
			continue;
		++*count;
		*one = (struct drawing){.format = format_names[i], .fd = memfd_create("figure", 0)};
		(void)snprintf(one->source, sizeof one->source, "/dev/fd/%d", one->fd);
		if (asprintf(&one->name, "%s.%s", name, one->format) < 0) {
			one->name = NULL;
			return error_memory(err, strlen(name));
		}
		if (one->fd < 0)
			return error_set(err, EX_SOFTWARE, "no file in memory: %s", strerror(errno));
	}
	return 0;
}

/* What gnuplot drew takes the place of the figure that was there. */
static int replace_file(
	struct plots_output *output, const struct drawing *drawing, struct error *err)
{
	const struct file_place place = {.folder = output->folder, .name = drawing->name};
	struct file_part part = {0};
	unsigned char *bytes;
	int result;

	TRY(file_read(drawing->source, &bytes, &part.size, err));
	part.bytes = bytes;
	result = part.size ? file_replace(&place, &part, 1, err)
					   : error_set(err, EX_SOFTWARE, "gnuplot drew nothing of %s", drawing->name);
	free(bytes);
	if (!result)
		text_addf(&output->written, "%s/%s\n", output->folder, drawing->name);
	return result;
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
	struct drawing drawings[FORMATS];
	struct script_output outputs[FORMATS];
	struct text script = {0};
	size_t count = 0;
	int result = -1;

	add_missing(output, text_string(&figure->missing));
	if (!figure->panel_count)
		return 0;
	if (file_make_folders(output->folder, err) ||
		drawings_open(output->formats, figure->name, drawings, &count, err))
		goto done;
	for (size_t i = 0; i < count; i++)
		outputs[i] = (struct script_output){drawings[i].format, drawings[i].source};
	script_write(figure, outputs, count, &script);
	result = script.failed ? error_memory(err, script.length) : gnuplot_run(&script, err);
	for (size_t i = 0; !result && i < count; i++)
		result = replace_file(output, &drawings[i], err);
done:
	text_clean(&script);
	drawings_clean(drawings, count);
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
