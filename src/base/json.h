/* JSON values. */
#ifndef TALUS_JSON_H
#define TALUS_JSON_H

#include "talus/text.h"

/* A string in quotes; bytes that are not UTF-8 become U+FFFD. */
void json_add_string(struct text *out, const char *string);

/* A number that reads back to the same bits; null for NaN and the infinities. */
void json_add_real(struct text *out, double value);

#endif
