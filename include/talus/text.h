/* Text that grows, and numbers that read back to the same bits. */
#ifndef TALUS_TEXT_H
#define TALUS_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* An empty text is all zeros. After an allocation fails every call does nothing and `failed` says
 * so: check it once, at the end. */
struct text {
	char *data;      /* terminated; NULL while empty */
	size_t length;   /* without the terminator */
	size_t capacity; /* bytes allocated */
	bool failed;     /* an allocation failed */
};

void text_add(struct text *text, const char *string);
void text_add_bytes(struct text *text, const char *bytes, size_t count);
void text_addf(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The text as a string: "" while empty. Owned by `text`. */
const char *text_string(const struct text *text);

/* Free what the text holds and make it empty. */
void text_clean(struct text *text);

enum { TEXT_REAL_SIZE = 32 };

/* The shortest of %.15g, %.16g and %.17g that strtod reads back to the same bits. Returns `buffer`. */
char *text_real(double value, char buffer[TEXT_REAL_SIZE]);

/* Whole `string` as a finite decimal number: no hexadecimal, nan, inf, blanks or trailing characters.
 * Overflow is refused. */
bool text_to_real(const char *string, double *value);

/* Whole `string` as a decimal integer in the range of int. */
bool text_to_integer(const char *string, int *value);

/* `string` in one printable line for a message: a tab becomes a blank, other control
 * characters '?', and what does not fit `size` bytes ends in "...". Returns `buffer`. */
char *text_excerpt(const char *string, char *buffer, size_t size);

/* Control characters but for tabs and ends of lines become '?': texts of strangers do not speak to the
 * terminal. NULL is nothing. */
char *text_tame(char *string);

/* Bytes of the UTF-8 character at `start`, 0 if there is none (overlong, surrogate, cut short). */
size_t text_character_size(const char *start);

/* `string` as one word of a shell, quoted where it has to be. */
void text_add_word(struct text *text, const char *string);

/* Edit distance (insert, delete, substitute, swap neighbours), for "did you mean". Strings longer
 * than 63 bytes count as infinitely far apart. */
int text_distance(const char *a, const char *b);

#endif
