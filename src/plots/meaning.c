#include "plots/meaning.h"

#include <ctype.h>
#include <string.h>

#include "tables/scale.h"

/* One that is not lost between the pieces of an SVG text. */
#define SPACE "\u00a0"

enum {
	LABEL_MAX = 36
}; /* bytes that fit beside a panel: beyond, the name of the dataset says it */

/* What is well known has a short name and, in gnuplot's marks, a symbol. */
static const struct known {
	const char *name, *words, *symbol;
} known[] = {
	{"time", "time", "{/:Italic t}"},
	{"profile_time", "time", "{/:Italic t}"},
	{"x", "distance along the slope", "{/:Italic x}"},
	{"z", "height above the bed", "{/:Italic z}"},
	{"b", "bed", "{/:Italic b}"},
	{"h", "thickness", "{/:Italic h}"},
	{"static_height", "flow/no-flow interface", "{/:Italic h}_s"},
	{"u", "velocity", "{/:Italic u}"},
	{"w", "normal velocity", "{/:Italic w}"},
	{"p", "pressure", "{/:Italic p}"},
	{"strain_rate", "strain rate", "||{/:Italic D}||"},
	{"mu", "friction coefficient", "{/:Italic μ}({/:Italic I})"},
	{"front_position", "front position", "{/:Italic x}_f"},
	{"front_velocity", "front velocity", "{/:Italic v}"},
	{"max_speed", "greatest velocity", "{/:Italic u}_{max}"},
	{"max_thickness", "greatest thickness", "{/:Italic h}_{max}"},
	{"mass", "mass", "{/:Italic M}"},
	{"energy", "energy", "{/:Italic E}"},
	{"kinetic_energy", "kinetic energy", "{/:Italic E}_k"},
	{"potential_energy", "potential energy", "{/:Italic E}_p"},
	{"bottom_dissipation", "dissipation at the bottom", ""},
	{"layer_dissipation", "dissipation between layers", ""},
	{"h_gauge", "thickness", "{/:Italic h}"},
	{"h_station", "thickness", "{/:Italic h}"},
	{"u_station", "velocity", "{/:Italic u}"},
	{"w_station", "normal velocity", "{/:Italic w}"},
	{"mean_speed", "mean velocity", "{/:Italic v}_{mean}"},
	{"steady_max_speed", "top velocity, steady flow", ""},
	{"steady_mean_speed", "mean velocity, steady flow", ""},
	{"fraction", "mean solid fraction", "{/:Italic φ}"},
	{"equilibrium_fraction", "equilibrium fraction", "{/:Italic φ}_{eq}"},
	{"bottom_pressure", "solid pressure, bottom", ""},
	{"bottom_pressure_root", "solid pressure, root", ""},
	{"pressure_error", "distance from the root", ""},
	{"excess_pressure", "excess pore pressure", ""},
	{"fluid_transfer", "fluid through the surface", ""},
	{"solid_transfer", "grains through the surface", ""},
	{"solid_mass", "mass of the grains", ""},
	{"max_slip", "greatest slip", ""},
	{"v", "velocity of the grains", "{/:Italic v}"},
	{"v_steady", "velocity, steady flow", "{/:Italic v}"},
	{"phi", "solid fraction", "{/:Italic φ}"},
	{"phi_steady", "solid fraction, steady flow", "{/:Italic φ}"},
	{"pressure_iterations", "iterations", ""},
	{"coarse_iterations", "iterations, coarse", ""},
	{"layers", "layers", "{/:Italic N}"},
	{"n_ini_guess", "layers of the first guess", ""},
	{"slope", "slope", "{/:Italic θ}"},
	{"erodible_bed_thickness", "thickness of the erodible bed", "{/:Italic h}_i"},
	{"runout", "runout", "{/:Italic r}_f"},
	{"runout-change", "change of the runout", ""},
	{"stopping-time", "stopping time", "{/:Italic t}_f"},
	{"front-stopping-time", "the front stops at", "{/:Italic t}_f"},
	{"final-thickness", "greatest final thickness", "{/:Italic h}_f"},
	{"deposit-height", "height of the deposit above the bed", "{/:Italic h}_f"},
	{"mean-velocity", "velocity averaged over the layers", "{/:Italic u}"},
	{"front-velocity", "greatest front velocity", "{/:Italic v}"},
	{"front-velocity-time", "time of the greatest front velocity", "{/:Italic t}"},
	{"cpu-seconds", "CPU time", ""},
	{"bagnold-error", "relative error of the velocity", ""},
};

static const struct known *find_known(const char *name)
{
	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if (!strcmp(known[i].name, name))
			return &known[i];
	return NULL;
}

const char *meaning_words(const char *name)
{
	const struct known *row = find_known(name);

	return row ? row->words : NULL;
}

double meaning_settles(const char *name)
{
	/* the slope over a trailing window says nothing before the window is full */
	return strcmp(name, "front_velocity") ? 0 : 0.02;
}

/* NULL: nothing takes the unit away. */
static const struct scale *find_scale(const char *name, const char *unit)
{
	struct text short_unit = {0};
	const struct scale *scale;

	meaning_unit(unit, &short_unit);
	scale = scale_find(name, text_string(&short_unit));
	text_clean(&short_unit);
	return scale;
}

double meaning_scale(const char *name, const char *unit, const struct config *config)
{
	const struct scale *scale = find_scale(name, unit);

	return scale ? scale->value(config) : 1;
}

void meaning_unit(const char *unit, struct text *out)
{
	for (const char *at = unit; *at; at++) {
		if (*at == ' ' && strchr(at, '-')) {
			const char *minus = strchr(at, '-');

			text_addf(out, "/%.*s", (int)(minus - at - 1), at + 1);
			if (minus[1] == '2' || minus[1] == '3')
				text_add(out, minus[1] == '2' ? "²" : "³");
			at = minus + (minus[1] != '\0');
		} else {
			text_add_bytes(out, at, 1);
		}
	}
}

/* May it stand among gnuplot's marks? */
static bool is_harmless(const char *string)
{
	for (; *string; string++)
		if (!isalnum((unsigned char)*string) && !strchr(" /%-()", *string) &&
			(unsigned char)*string < 0x80)
			return false;
	return true;
}

static void add_unit(const struct meaning *meaning, struct text *out)
{
	if (meaning->shown)
		text_addf(out, SPACE "(%s)", meaning->shown);
	else if (*meaning->unit && strcmp(meaning->unit, "1") != 0) {
		text_add(out, SPACE "(");
		meaning_unit(meaning->unit, out);
		text_add(out, ")");
	}
}

void meaning_label(const struct meaning *meaning, struct figure_text *out)
{
	const struct known *row = find_known(meaning->name);
	const struct scale *scale =
		meaning->dimensionless ? find_scale(meaning->name, meaning->unit) : NULL;
	const char *words = meaning->words && *meaning->words && strlen(meaning->words) <= LABEL_MAX
							? meaning->words
							: meaning->name;
	struct text unit = {0};

	add_unit(meaning, &unit);
	out->marked = row && is_harmless(text_string(&unit));
	if (!out->marked && scale)
		text_addf(&out->text, "%s/%s", row ? row->words : words, scale->name);
	else if (!out->marked)
		text_addf(&out->text, "%s%s", row ? row->words : words, text_string(&unit));
	else if (scale)
		text_addf(&out->text, "%s" SPACE "%s/%s", row->words, row->symbol, scale->marked);
	else
		text_addf(&out->text, "%s%s%s%s", row->words, *row->symbol ? SPACE : "", row->symbol,
			text_string(&unit));
	out->text.failed |= unit.failed;
	text_clean(&unit);
}
