/* Quantities: a decimal number and a unit, read into SI. */
#ifndef TALUS_QUANTITY_H
#define TALUS_QUANTITY_H

#include "talus/error.h"
#include "talus/text.h"

/* Read `given` as a quantity whose SI unit is `unit`, a row of the table in quantity.c ("m", "1/s",
 * "1" for a plain number). A bare number is in SI; an angle ("rad") must say deg or rad; a plain
 * number may be written `tan(25.5 deg)`. Units that are a power of ten of the SI unit are exact:
 * 1.82 mm gives the double nearest to 0.00182. EX_DATAERR says what is wrong, without a place. */
int quantity_read(const char *given, const char *unit, double *value, struct error *err);

/* The SI unit of the kind of `unit`, as quantity_read wants it; NULL: no such unit is known. */
const char *quantity_si(const char *unit);

/* `value` and its SI unit, as quantity_read reads it back to the same bits. */
void quantity_print(double value, const char *unit, struct text *out);

/* Words for the reference: "a length (m, km, cm, mm or um)". */
void quantity_describe(const char *unit, struct text *out);

#endif
