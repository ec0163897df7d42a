#include "base/json.h"

#include <math.h>

void json_add_string(struct text *out, const char *string)
{
	text_add(out, "\"");
	while (*string) {
		size_t size = text_character_size(string);

		if (!size)
			text_add(out, "\\ufffd");
		else if (*string == '"' || *string == '\\')
			text_addf(out, "\\%c", *string);
		else if ((unsigned char)*string < 0x20)
			text_addf(out, "\\u%04x", (unsigned)*string);
		else
			text_add_bytes(out, string, size);
		string += size ? size : 1;
	}
	text_add(out, "\"");
}

void json_add_real(struct text *out, double value)
{
	char buffer[TEXT_REAL_SIZE];

	text_add(out, isfinite(value) ? text_real(value, buffer) : "null");
}
