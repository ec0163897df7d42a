#include "base/json.h"

#include <math.h>
#include <string.h>

/* Bytes of the UTF-8 character at `string`, 0 if there is none (overlong, surrogate, cut short). */
static size_t character_size(const unsigned char *string)
{
	size_t size = string[0] < 0x80   ? 1
				  : string[0] < 0xC2 ? 0
				  : string[0] < 0xE0 ? 2
				  : string[0] < 0xF0 ? 3
				  : string[0] < 0xF5 ? 4
									 : 0;

	for (size_t i = 1; i < size; i++)
		if ((string[i] & 0xC0) != 0x80)
			return 0;
	if ((string[0] == 0xE0 && string[1] < 0xA0) || (string[0] == 0xED && string[1] > 0x9F) ||
		(string[0] == 0xF0 && string[1] < 0x90) || (string[0] == 0xF4 && string[1] > 0x8F))
		return 0;
	return size;
}

void json_add_string(struct text *out, const char *string)
{
	text_add(out, "\"");
	while (*string) {
		size_t size = character_size((const unsigned char *)string);

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
