#include "plots/script.h"

#include <math.h>
#include <string.h>

#include "plots/legend.h"
#include "plots/script_data.h"

/* Sizes in points: the same in every format. */
#define FONT "Arial" /* or what fontconfig has instead: Liberation Sans, DejaVu Sans */
enum {
	FONT_SIZE = 11,
	LEFT = 66, /* of a panel: room for its labels */
	RIGHT = 18,
	TOP = 6,
	TITLE = 20, /* and for its title, */
	BOTTOM = 44,
	COLOUR_BOX = 64, /* and for the colours of a map */
	HEAD = 26,       /* above all panels: the title of the figure */
	EDGE = 8,
	ENTRY = 17, /* of the legend: its height, the width of its sample, and of a letter */
	SAMPLE = 44,
};
#define LETTER 6.2

enum { TEXT_MAX = 300 };

struct geometry {
	int columns, rows;
	int width, height; /* of the area within a panel's axes */
	int title;         /* TITLE if some panel has one */
	int box;           /* COLOUR_BOX if some panel is a map */
	int entry_rows;    /* of the legend */
	bool legends;      /* one for each panel instead of one for all */
	double total[2];   /* of the figure */
};

/* Within single quotes nothing means anything to gnuplot but the quote itself, so an apostrophe is
 * written as the typographer's. Whatever is no printable UTF-8 is left out, and so is what is too long
 * to be read. */
static void add_quoted(struct text *out, const char *string)
{
	text_add(out, "'");
	for (size_t shown = 0; *string && shown < TEXT_MAX; shown++) {
		size_t size = text_character_size(string);

		if (!size)
			text_add(out, "\ufffd");
		else if (*string == '\'')
			text_add(out, "\u2019");
		else if ((unsigned char)*string < 0x20 || *string == 0x7f)
			text_add(out, " ");
		else
			text_add_bytes(out, string, size);
		if (string[0] == ']' &&
			string[1] == '>') /* "]]>" is no text of XML, and gnuplot lets it be */
			text_add(out, " ");
		string += size ? size : 1;
	}
	text_add(out, "'");
}

static void add_text(struct text *out, const char *command, const struct figure_text *text)
{
	text_addf(out, "%s ", command);
	add_quoted(out, text_string(&text->text));
	text_add(out, text->marked ? " enhanced" : " noenhanced");
}

/* How a line looks, in `plot` and in the legend alike. */
static void add_dashes(struct text *out, const struct figure_line *line)
{
	static const char *const dashes[] = {"solid", "(9,4)", "(2,3)", "(9,3,2,3)", "(16,4)", "(5,2)"};
	int shape = line->dash % (int)(sizeof dashes / sizeof *dashes);

	text_addf(out, " dt %s lw %s", dashes[shape], shape ? "1.7" : "1.5");
}

static void add_points(struct text *out, const struct figure_line *line)
{
	static const int full[] = {7, 5, 9, 13, 11, 15}, hollow[] = {6, 4, 8, 12, 10, 14};
	int shape = line->dash % (int)(sizeof full / sizeof *full);

	text_addf(out, " pt %d ps %s", line->hollow ? hollow[shape] : full[shape],
		line->hollow ? "0.8" : "0.55");
}

static void add_style(struct text *out, const struct figure_line *line)
{
	if (line->mark != FIGURE_POINTS)
		add_dashes(out, line);
	if (line->mark != FIGURE_LINE)
		add_points(out, line);
	if (line->mark == FIGURE_POINTS)
		text_add(out, " lw 1.2");
	text_addf(out, " lc rgb '#%06X'", line->colour);
}

static const char *mark_name(const struct figure_line *line)
{
	static const char *const names[] = {"lines", "points", "linespoints"};

	return names[line->mark];
}

static bool has_spread(const struct figure_line *line)
{
	for (size_t i = 0; line->spread && i < line->count; i++)
		if (line->spread[i] > 0)
			return true;
	return false;
}

static void fit_legend(struct geometry *g, const struct legend *entries, double width)
{
	double entry = SAMPLE + LETTER * (double)entries->longest;
	int columns = entry < width ? (int)(width / entry) : 1, rows;

	if (columns > (int)entries->count)
		columns = (int)entries->count;
	if (columns < 1)
		columns = 1;
	rows = ((int)entries->count + columns - 1) / columns;
	if (rows > g->entry_rows)
		g->entry_rows = rows;
}

static int columns_of(const struct figure *figure)
{
	int count = (int)figure->panel_count;

	if (figure->columns)
		return figure->columns < count ? figure->columns : count;
	return count <= 3 ? count : count == 4 ? 2 : 3;
}

static struct geometry lay_out(const struct figure *figure)
{
	struct geometry g = {.columns = columns_of(figure)};
	struct legend all = {.count = 0};
	int pitch;

	g.rows = ((int)figure->panel_count + g.columns - 1) / g.columns;
	g.width = g.columns == 1 ? 400 : g.columns == 2 ? 300 : 240;
	g.height = g.columns == 1 && g.rows == 1 ? 250 : g.columns <= 2 ? 190 : 160;
	for (size_t p = 0; p < figure->panel_count; p++) {
		if (figure->panels[p].title.length)
			g.title = TITLE;
		if (figure->panels[p].map.rows)
			g.box = COLOUR_BOX;
		legend_collect(&figure->panels[p], &all);
	}
	pitch = LEFT + g.width + g.box + RIGHT;
	g.total[0] = EDGE + g.columns * pitch + EDGE;
	g.legends = legend_is_ambiguous(&all);
	for (size_t p = 0; g.legends && p < figure->panel_count; p++) {
		struct legend own = {.count = 0};

		legend_collect(&figure->panels[p], &own);
		fit_legend(&g, &own, pitch - 10);
	}
	if (!g.legends)
		fit_legend(&g, &all, g.total[0] - LEFT);
	/* a single line needs no name */
	if (!g.legends && all.count < 2)
		g.entry_rows = 0;
	g.total[1] = EDGE + (figure->title.length ? HEAD : 0) +
				 g.rows * (TOP + g.title + g.height + BOTTOM) + EDGE +
				 ENTRY * g.entry_rows * (g.legends ? g.rows : 1);
	return g;
}

/* The area within the axes, in points from the left and from the bottom. */
static void add_margins(struct text *out, const struct geometry *g, double left, double right,
	double bottom, double top)
{
	text_addf(out,
		"set lmargin at screen %.6f; set rmargin at screen %.6f\n"
		"set bmargin at screen %.6f; set tmargin at screen %.6f\n",
		left / g->total[0], right / g->total[0], bottom / g->total[1], top / g->total[1]);
}

/* A legend in an empty panel of its own between these heights. */
static void add_legend(
	struct text *out, const struct geometry *g, const struct legend *legend, const double sides[4])
{
	int rows = g->entry_rows, columns = ((int)legend->count + rows - 1) / rows;
	double width = SAMPLE + LETTER * (double)legend->longest;
	double start = (sides[1] - sides[0] - columns * width) / 2;

	if (!legend->count)
		return;
	add_margins(out, g, sides[0], sides[1], sides[2], sides[3]);
	text_addf(out,
		"unset key; unset border; unset xtics; unset ytics; "
		"unset grid; unset title; unset xlabel; unset ylabel; unset label\n"
		"unset logscale; set xrange [0:%.3f]; set yrange [0:%.3f]\n",
		sides[1] - sides[0], sides[3] - sides[2]);
	for (int i = 0; i < (int)legend->count; i++) {
		const struct figure_line *line = legend->items[i];
		int column = i / rows, row = i % rows;
		double x = start + column * width, y = sides[3] - sides[2] - ENTRY * (row + 0.5);

		if (line->mark != FIGURE_POINTS) {
			text_addf(out, "set arrow from %.3f,%.3f to %.3f,%.3f nohead", x, y, x + 26, y);
			add_dashes(out, line);
			text_addf(out, " lc rgb '#%06X'\n", line->colour);
		}
		if (line->mark != FIGURE_LINE) {
			text_addf(out, "set label '' at %.3f,%.3f point", x + 13, y);
			add_points(out, line);
			text_addf(out, " lw 1.2 lc rgb '#%06X'\n", line->colour);
		}
		text_add(out, "set label ");
		add_quoted(out, line->title);
		text_addf(out, " at %.3f,%.3f left noenhanced\n", x + 32, y);
	}
	text_add(out, "plot -1 notitle\nunset arrow; unset label\n");
}

/* `tight`: the axis ends where the data do. */
static void add_range(
	struct text *out, const char *axis, const struct figure_axis *range, bool tight)
{
	text_addf(out, "set %srange [", axis);
	if (!isnan(range->from))
		script_data_add_number(out, range->from);
	text_add(out, isnan(range->from) ? "*:" : ":");
	if (!isnan(range->to))
		script_data_add_number(out, range->to);
	text_addf(out, "%s]%s\n", isnan(range->to) ? "*" : "", tight ? " noextend" : "");
	text_addf(out,
		range->log ? "set logscale %s; set format %s '10^{%%T}'; set m%stics 10\n"
				   : "unset logscale %s; set format %s '%%h'; unset m%stics\n",
		axis, axis, axis);
}

/* The numbers along an axis reach from `low` to `high`; false where there are none. */
static bool find_extent(const struct figure_panel *panel, bool along_x, double *low, double *high)
{
	const struct figure_axis *axis = along_x ? &panel->x : &panel->y;
	const double *ends = along_x ? panel->map.x : panel->map.y;
	size_t last = along_x ? panel->map.columns : panel->map.rows;

	*low = last ? ends[0] : INFINITY;
	*high = last ? ends[last - 1] : -INFINITY;
	for (size_t i = 0; i < panel->line_count; i++)
		for (size_t k = 0; k < panel->lines[i].count; k++) {
			double value = along_x ? panel->lines[i].x[k] : panel->lines[i].y[k];

			*low = fmin(*low, value); /* passes over NaN */
			*high = fmax(*high, value);
		}
	*low = isnan(axis->from) ? *low : axis->from;
	*high = isnan(axis->to) ? *high : axis->to;
	return *high > *low && isfinite(*low) && isfinite(*high);
}

/* Tics so far apart that what stands at them has room: 1, 2 or 5 times a power of ten. What rounding alone
 * moves is shown as a level line. */
static void add_tics(
	struct text *out, const char *axis, const struct figure_panel *panel, int length, int room)
{
	bool along_x = *axis == 'x';
	double low, high, step, power;

	if ((along_x ? panel->x.log : panel->y.log) || !find_extent(panel, along_x, &low, &high)) {
		text_addf(out, "set %stics autofreq\n", axis);
		return;
	}
	if (!along_x && high - low < 1e-9 * fabs(high)) {
		low -= 0.1 * fabs(high);
		high += 0.1 * fabs(high);
		add_range(out, axis, &(struct figure_axis){.from = low, .to = high}, false);
	}
	step = (high - low) * room / length;
	power = pow(10, floor(log10(step)));
	step /= power;
	step = (step <= 1 ? 1 : step <= 2 ? 2 : step <= 5 ? 5 : 10) * power;
	text_addf(out, "set %stics", axis);
	script_data_add_number(out, step);
	text_add(out, "\n");
}

static bool all_lines(const struct figure_panel *panel)
{
	for (size_t i = 0; i < panel->line_count; i++)
		if (panel->lines[i].mark == FIGURE_LINE_POINTS)
			return false;
	return true;
}

static void add_axes(struct text *out, const struct geometry *g, const struct figure_panel *panel)
{
	text_add(out,
		"set border 3 lw 0.8 lc rgb '#333333'\n"
		"set xtics nomirror out scale 0.6 textcolor rgb '#222222'\n"
		"set ytics nomirror out scale 0.6 textcolor rgb '#222222'\n"
		"set grid xtics ytics lt 1 dt solid lw 0.6 lc rgb '#E4E4E4'\nunset key; unset label\n");
	if (panel->title.length) {
		text_add(out, "set title ");
		add_quoted(out, text_string(&panel->title));
		text_add(out, " noenhanced offset 0,-0.7\n");
	} else {
		text_add(out, "unset title\n");
	}
	add_text(out, "set xlabel", &panel->x.label);
	text_add(out, " offset 0,0.3\n");
	add_text(out, "set ylabel", &panel->y.label);
	text_add(out, " offset -0.2,0\n");
	add_range(out, "x", &panel->x, all_lines(panel));
	add_tics(out, "x", panel, g->width, 50);
	add_range(out, "y", &panel->y, false);
	add_tics(out, "y", panel, g->height, 22);
}

static void add_lines(struct text *out, const struct figure_panel *panel, size_t p, bool *any)
{
	for (size_t i = 0; i < panel->line_count; i++) {
		const struct figure_line *line = &panel->lines[i];

		if (!figure_can_be_drawn(panel, line))
			continue;
		text_addf(
			out, "%s $p%zu_%zu using 1:2 with %s", *any ? "," : "plot", p, i, mark_name(line));
		add_style(out, line);
		text_add(out, " notitle");
		*any = true;
		if (has_spread(line))
			text_addf(out,
				", $p%zu_%zu using 1:2:3 with yerrorbars pt 0 lw 0.8 lc rgb '#%06X' notitle", p, i,
				line->colour);
	}
}

static void add_map(struct text *out, const struct figure_panel *panel, size_t p, bool *any)
{
	if (panel->map.rows < 2)
		return;
	text_add(out, "set palette defined (0 '#440154', 1 '#472D7B', 2 '#3B528B', "
				  "3 '#2C728E', 4 '#21918C', 5 '#28AE80', "
				  "6 '#5EC962', 7 '#ADDC30', 8 '#FDE725')\n"
				  "set colorbox noborder; set cbtics scale 0; "
				  "set autoscale xfix; set autoscale yfix\n");
	add_text(out, "set cblabel", &panel->map.label);
	text_addf(out, " offset 0.5,0\nplot $m%zu using 1:2:3 with image notitle", p);
	*any = true;
}

static void add_panel(
	struct text *out, const struct figure *figure, const struct geometry *g, size_t p)
{
	const struct figure_panel *panel = &figure->panels[p];
	int row = (int)p / g->columns, column = (int)p % g->columns;
	int legend = g->legends ? ENTRY * g->entry_rows : 0;
	double left = EDGE + column * (LEFT + g->width + g->box + RIGHT) + LEFT;
	double top = g->total[1] - EDGE - (figure->title.length ? HEAD : 0) -
				 row * (TOP + g->title + g->height + BOTTOM + legend) - TOP - g->title;
	bool any = false;

	add_margins(out, g, left, left + g->width, top - g->height, top);
	add_axes(out, g, panel);
	add_map(out, panel, p, &any);
	add_lines(out, panel, p, &any);
	if (!any) /* an empty panel says so, and the figure stays whole */
		text_add(out,
			"unset logscale; set xrange [0:1]; set yrange [0:1]\n"
			"set label 1 'nothing to show' at graph 0.5,0.5 center textcolor rgb '#888888'\n"
			"plot NaN notitle");
	text_add(out, "\n");
	if (legend) {
		struct legend own = {.count = 0};
		double bottom = top - g->height - BOTTOM;

		legend_collect(panel, &own);
		add_legend(out, g, &own,
			(double[4]){left - LEFT, left + g->width + RIGHT, bottom - legend, bottom});
	}
}

static void add_body(struct text *out, const struct figure *figure, const struct geometry *g)
{
	struct legend all = {.count = 0};

	text_add(out, "reset\nset encoding utf8\nset multiplot");
	if (figure->title.length) {
		text_add(out, " title ");
		add_quoted(out, text_string(&figure->title));
		text_addf(out, " noenhanced font '" FONT " Bold,%d'", FONT_SIZE + 1);
	}
	text_add(out, "\n");
	for (size_t p = 0; p < figure->panel_count; p++)
		add_panel(out, figure, g, p);
	for (size_t p = 0; p < figure->panel_count; p++)
		legend_collect(&figure->panels[p], &all);
	if (!g->legends && g->entry_rows)
		add_legend(out, g, &all,
			(double[4]){EDGE, g->total[0] - EDGE, EDGE, EDGE + ENTRY * g->entry_rows});
	text_add(out, "unset multiplot\nunset output\n");
}

static void add_terminal(
	struct text *out, const struct geometry *g, const struct script_output *output)
{
	if (!strcmp(output->format, "svg"))
		text_addf(out,
			"set terminal svg enhanced size %.0f,%.0f font '" FONT ",%d' background '#FFFFFF'\n",
			g->total[0], g->total[1], FONT_SIZE);
	else if (!strcmp(output->format, "png"))
		text_addf(out,
			"set terminal pngcairo enhanced size %.0f,%.0f font '" FONT ",%d' fontscale 1.5 "
			"linewidth 2 pointscale 2 background '#FFFFFF'\n",
			2 * g->total[0], 2 * g->total[1], FONT_SIZE);
	else
		text_addf(out,
			"set terminal pdfcairo enhanced size %.4fin,%.4fin font '" FONT ",%d' "
			"fontscale 0.78 linewidth 1.4 pointscale 0.9 background '#FFFFFF'\n",
			g->total[0] / 72, g->total[1] / 72, FONT_SIZE);
	text_addf(out, "set output '%s'\n", output->file);
}

void script_write(const struct figure *figure, const struct script_output *outputs, size_t count,
	struct text *out)
{
	struct geometry g = lay_out(figure);

	script_data_add(out, figure);
	for (size_t i = 0; i < count; i++) {
		add_terminal(out, &g, &outputs[i]);
		add_body(out, figure, &g);
	}
}
