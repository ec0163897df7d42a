#include "talus/text.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool reserve(struct text *text, size_t more)
{
	size_t need = text->length + more + 1, capacity = text->capacity ? text->capacity : 256;
	char *data;

	if (text->failed || need <= text->capacity)
		return !text->failed;
	while (capacity < need)
		capacity *= 2;
	data = realloc(text->data, capacity);
	if (!data) {
		text->failed = true;
		return false;
	}
	text->data = data;
	text->capacity = capacity;
	return true;
}

void text_add_bytes(struct text *text, const char *bytes, size_t count)
{
	if (!reserve(text, count))
		return;
	memcpy(text->data + text->length, bytes, count);
	text->length += count;
	text->data[text->length] = '\0';
}

void text_add(struct text *text, const char *string)
{
	text_add_bytes(text, string, strlen(string));
}

void text_addf(struct text *text, const char *format, ...)
{
	va_list args;
	int count;

	va_start(args, format);
	count = vsnprintf(NULL, 0, format, args);
	va_end(args);
	if (count < 0 || !reserve(text, (size_t)count))
		return;
	va_start(args, format);
	(void)vsnprintf(text->data + text->length, (size_t)count + 1, format, args);
	va_end(args);
	text->length += (size_t)count;
}

void text_add_word(struct text *text, const char *string)
{
	const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-=,:@%";

	if (*string && !string[strspn(string, plain)]) {
		text_add(text, string);
		return;
	}
	text_add(text, "'");
	for (; *string; string++)
		if (*string == '\'')
			text_add(text, "'\\''");
		else
			text_add_bytes(text, string, 1);
	text_add(text, "'");
}

const char *text_string(const struct text *text)
{
	return text->data ? text->data : "";
}

void text_clean(struct text *text)
{
	free(text->data);
	*text = (struct text){0};
}

char *text_real(double value, char buffer[TEXT_REAL_SIZE])
{
	for (int digits = 15; digits <= 17; digits++) {
		(void)snprintf(buffer, TEXT_REAL_SIZE, "%.*g", digits, value);
		if (strtod(buffer, NULL) == value)
			break;
	}
	return buffer;
}

bool text_to_real(const char *string, double *value)
{
	char *end;
	double result;

	/* strtod also reads blanks, "nan", "inf" and hexadecimal; a decimal number has none of these */
	if (!*string || string[strspn(string, "+-.0123456789eE")])
		return false;
	errno = 0;
	result = strtod(string, &end);
	if (end == string || *end || !isfinite(result))
		return false;
	*value = result;
	return true;
}

bool text_to_integer(const char *string, int *value)
{
	char *end;
	long result;

	if (!isdigit((unsigned char)string[*string == '-' || *string == '+']))
		return false;
	errno = 0;
	result = strtol(string, &end, 10);
	if (*end || errno || result < INT_MIN || result > INT_MAX)
		return false;
	*value = (int)result;
	return true;
}

char *text_excerpt(const char *string, char *buffer, size_t size)
{
	size_t length = strlen(string);
	bool cut = length >= size;

	if (cut) {
		length = size - sizeof "...";
		while (length > 0 && ((unsigned char)string[length] & 0xC0) == 0x80)
			length--; /* not in the middle of a UTF-8 character */
	}
	for (size_t i = 0; i < length; i++)
		buffer[i] = string[i] == '\t' ? ' ' : iscntrl((unsigned char)string[i]) ? '?' : string[i];
	(void)snprintf(buffer + length, size - length, "%s", cut ? "..." : "");
	return buffer;
}

char *text_tame(char *string)
{
	for (char *c = string; c && *c; c++) {
		bool line_end = *c == '\n' || (*c == '\r' && c[1] == '\n'); /* CSV has the second */

		if (iscntrl((unsigned char)*c) && !line_end && *c != '\t')
			*c = '?';
	}
	return string;
}

int text_distance(const char *a, const char *b)
{
	enum { LIMIT = 64 };
	int row[3][LIMIT]; /* two rows back, last row, this row */
	size_t n = strlen(a), m = strlen(b);

	if (n >= LIMIT || m >= LIMIT)
		return INT_MAX;
	for (size_t j = 0; j <= m; j++)
		row[1][j] = (int)j;
	for (size_t i = 1; i <= n; i++) {
		row[2][0] = (int)i;
		for (size_t j = 1; j <= m; j++) {
			int best = row[1][j - 1] + (a[i - 1] != b[j - 1]);

			if (row[1][j] + 1 < best)
				best = row[1][j] + 1;
			if (row[2][j - 1] + 1 < best)
				best = row[2][j - 1] + 1;
			if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
				row[0][j - 2] + 1 < best)
				best = row[0][j - 2] + 1;
			row[2][j] = best;
		}
		memcpy(row[0], row[1], sizeof row[0]);
		memcpy(row[1], row[2], sizeof row[0]);
	}
	return row[1][m];
}

size_t text_character_size(const char *start)
{
	const unsigned char *string = (const unsigned char *)start;
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
