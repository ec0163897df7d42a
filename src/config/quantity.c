#include "config/quantity.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The first row of each SI unit is that unit. A quantity is number * 10^exponent * factor. */
static const struct unit {
	const char *name, *si;
	int exponent;
	long double factor;
} units[] = {
	{"", "1", 0, 1},
	{"m", "m", 0, 1},
	{"km", "m", 3, 1},
	{"cm", "m", -2, 1},
	{"mm", "m", -3, 1},
	{"um", "m", -6, 1},
	{"s", "s", 0, 1},
	{"ms", "s", -3, 1},
	{"us", "s", -6, 1},
	{"min", "s", 0, 60},
	{"h", "s", 0, 3600},
	{"rad", "rad", 0, 1},
	{"deg", "rad", 0, M_PIl / 180},
	{"m/s", "m/s", 0, 1},
	{"cm/s", "m/s", -2, 1},
	{"mm/s", "m/s", -3, 1},
	{"1/s", "1/s", 0, 1},
	{"kg/m3", "kg/m3", 0, 1},
	{"g/cm3", "kg/m3", 3, 1},
	{"m2/s2", "m2/s2", 0, 1},
	{"Pa s", "Pa s", 0, 1},
	{"mPa s", "Pa s", -3, 1},
};

static const struct dimension {
	const char *si, *name;
} dimensions[] = {
	{"1", "a plain number"},
	{"m", "a length"},
	{"s", "a time"},
	{"rad", "an angle"},
	{"m/s", "a speed"},
	{"1/s", "a rate"},
	{"kg/m3", "a density"},
	{"m2/s2", "a pressure over density"},
	{"Pa s", "a viscosity"},
};

enum { UNITS = sizeof units / sizeof *units, QUANTITY_SIZE = 128 };

static const char *dimension_name(const char *si)
{
	for (size_t i = 0; i < sizeof dimensions / sizeof *dimensions; i++)
		if (!strcmp(dimensions[i].si, si))
			return dimensions[i].name;
	return si;
}

static const struct unit *unit_find(const char *name)
{
	for (size_t i = 0; i < UNITS; i++)
		if (!strcmp(units[i].name, name))
			return &units[i];
	return NULL;
}

const char *quantity_si(const char *unit)
{
	const struct unit *row = unit_find(unit);

	return row ? row->si : NULL;
}

/* "m, km, cm, mm or um" */
static void list_units(const char *si, struct text *out)
{
	size_t count = 0, seen = 0;

	for (size_t i = 0; i < UNITS; i++)
		count += !strcmp(units[i].si, si);
	for (size_t i = 0; i < UNITS; i++)
		if (!strcmp(units[i].si, si))
			text_addf(out, "%s%s", seen++ == 0 ? "" : seen == count ? " or " : ", ", units[i].name);
}

void quantity_describe(const char *unit, struct text *out)
{
	text_add(out, dimension_name(unit));
	if (strcmp(unit, "1") != 0) {
		text_add(out, " (");
		list_units(unit, out);
		text_add(out, ")");
	}
}

static int refuse_unit(const char *text, const char *name, const char *unit, struct error *err)
{
	const struct unit *other = unit_find(name);
	struct text right = {0};

	text_addf(&right, "%s has no unit", dimension_name(unit));
	if (strcmp(unit, "1") != 0) {
		text_clean(&right);
		text_addf(&right, "%s is given in ", dimension_name(unit));
		list_units(unit, &right);
	}
	if (other)
		(void)error_set(
			err, EX_DATAERR, "%s is %s; %s", text, dimension_name(other->si), text_string(&right));
	else
		(void)error_set(
			err, EX_DATAERR, "%s: unknown unit '%s'; %s", text, name, text_string(&right));
	text_clean(&right);
	return -1;
}

/* Bytes of the decimal number that `text` begins with, 0 if none; `*mantissa` of them stand before
 * the exponent. strtod would also take nan, inf, hexadecimal and leading blanks. */
static size_t number_length(const char *text, size_t *mantissa)
{
	const char *digits = "0123456789";
	size_t sign = *text == '-' || *text == '+', n = sign + strspn(text + sign, digits), more = 0;
	size_t count = n - sign;

	*mantissa = 0;
	if (text[n] == '.') {
		more = strspn(text + n + 1, digits);
		n += 1 + more;
	}
	if (count + more == 0)
		return 0;
	*mantissa = n;
	if (text[n] == 'e' || text[n] == 'E') {
		size_t first = n + 1 + (text[n + 1] == '-' || text[n + 1] == '+');

		if (strspn(text + first, digits))
			n = first + strspn(text + first, digits);
	}
	return n;
}

/* The number scaled by the unit. The unit's power of ten goes into the number's own exponent, so that
 * strtod rounds once and 1.82 mm is the same double as 0.00182. */
static int scale(
	const char *text, size_t mantissa, const struct unit *unit, double *value, struct error *err)
{
	char number[QUANTITY_SIZE + 32];
	long exponent = 0;

	if (text[mantissa] == 'e' || text[mantissa] == 'E')
		exponent = strtol(text + mantissa + 1, NULL, 10); /* 0 where a unit begins with e */
	if (labs(exponent) > 10000)
		exponent = exponent > 0 ? 10000 : -10000;
	(void)snprintf(
		number, sizeof number, "%.*se%ld", (int)mantissa, text, exponent + unit->exponent);
	*value = strtod(number, NULL);
	if (unit->factor != 1)
		*value = (double)(*value * unit->factor);
	if (!isfinite(*value) || (*value == 0 && number[strcspn(number, "123456789e")] != 'e'))
		return error_set(err, EX_DATAERR, "%s is beyond what a double can hold", text);
	*value += 0.0; /* -0 and 0 are one value with two spellings */
	return 0;
}

/* tan(ANGLE), the argument already without its "tan(". */
static int read_tangent(const char *text, const char *argument, double *value, struct error *err)
{
	char angle[QUANTITY_SIZE];
	size_t length = strlen(argument);
	double radians = 0;

	if (length == 0 || argument[length - 1] != ')')
		return error_set(err, EX_DATAERR, "%s: the bracket is not closed at the end", text);
	(void)snprintf(angle, sizeof angle, "%.*s", (int)length - 1, argument);
	if (quantity_read(angle, "rad", &radians, err) != 0)
		return error_context(err, "%s", text);
	/* in long double, where the C library has one version for all processors: the bits of a config
	 * must not depend on the machine that reads it */
	*value = (double)tanl(radians);
	return 0;
}

/* `text` without outer blanks and with control characters masked, as the messages show it. */
static int trim(const char *text, char buffer[QUANTITY_SIZE], struct error *err)
{
	size_t length;

	text += strspn(text, " \t");
	if (!*text)
		return error_set(err, EX_DATAERR, "the value is missing");
	(void)text_excerpt(text, buffer, QUANTITY_SIZE);
	if (strlen(text) >= QUANTITY_SIZE)
		return error_set(err, EX_DATAERR, "%s is too long for a number", buffer);
	for (length = strlen(buffer); buffer[length - 1] == ' '; length--)
		buffer[length - 1] = '\0';
	return 0;
}

int quantity_read(const char *given, const char *unit, double *value, struct error *err)
{
	char text[QUANTITY_SIZE] = "";
	const char *name;
	size_t mantissa, length;
	const struct unit *row;
	bool hexadecimal;

	TRY(trim(given, text, err));
	if (!strcmp(unit, "1") && !strncmp(text, "tan(", 4))
		return read_tangent(text, text + 4, value, err);
	length = number_length(text, &mantissa);
	hexadecimal = length <= 2 && (text[length] == 'x' || text[length] == 'X');
	if (length == 0 || hexadecimal)
		return error_set(err, EX_DATAERR, "%s is not a finite decimal number", text);
	name = text + length + strspn(text + length, " ");
	if (!*name && !strcmp(unit, "rad"))
		return error_set(err, EX_DATAERR,
			"%s has no unit; an angle must say deg or rad, as in %s deg", text, text);
	row = unit_find(*name || !strcmp(unit, "1") ? name : unit);
	if (!row || strcmp(row->si, unit) != 0)
		return refuse_unit(text, name, unit, err);
	return scale(text, mantissa, row, value, err);
}

void quantity_print(double value, const char *unit, struct text *out)
{
	char number[TEXT_REAL_SIZE];

	text_add(out, text_real(value, number));
	if (strcmp(unit, "1") != 0)
		text_addf(out, " %s", unit);
}
