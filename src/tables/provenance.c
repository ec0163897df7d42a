#include "tables/provenance.h"

#include <stdlib.h>
#include <string.h>

static void add_variant(struct provenance *provenance, struct variants *variants, const char *value)
{
	char **items, *copy;

	for (size_t i = 0; i < variants->count; i++)
		if (!strcmp(variants->items[i], value))
			return;
	items = realloc(variants->items, (variants->count + 1) * sizeof *items);
	if (items)
		variants->items = items;
	copy = items ? strdup(value) : NULL;
	if (copy)
		items[variants->count++] = copy;
	else
		provenance->failed = true;
}

/* Attributes joined by blanks; one that the file lacks is left out. */
static void add_attributes(struct provenance *provenance, struct variants *variants,
	struct run_file *file, const char *const *names, size_t count)
{
	struct text all = {0};

	for (size_t i = 0; i < count; i++) {
		struct text one = {0};
		struct error err = {0};

		if (!run_file_text(file, names[i], &one, &err))
			text_addf(&all, "%s%s", all.length ? ", " : "", text_string(&one));
		provenance->failed |= err.code == EX_SOFTWARE;
		text_clean(&one);
	}
	provenance->failed |= all.failed;
	add_variant(provenance, variants, text_string(&all));
	text_clean(&all);
}

void provenance_add(struct provenance *provenance, struct run_file *file)
{
	static const char *const build[] = {
		"talus_version", "git_revision", "compiler", "compiler_flags"};
	static const char *const host[] = {"host"};

	add_attributes(provenance, &provenance->builds, file, build, sizeof build / sizeof *build);
	add_attributes(provenance, &provenance->hosts, file, host, sizeof host / sizeof *host);
}

static void print_variants(
	const struct variants *variants, const char *noun, bool flag, struct text *out)
{
	if (flag && variants->count > 1)
		text_addf(out,
			"Beware: the runs were made by %zu different %ss, so their times do not compare.\n",
			variants->count, noun);
	for (size_t i = 0; i < variants->count; i++)
		text_addf(out, "Made %s %s.\n", noun[0] == 'b' ? "by talus" : "on", variants->items[i]);
}

void provenance_print(const struct provenance *provenance, bool timing, struct text *out)
{
	print_variants(&provenance->builds, "build", timing, out);
	print_variants(&provenance->hosts, "machine", timing, out);
	out->failed |= provenance->failed;
}

static void variants_clean(struct variants *variants)
{
	for (size_t i = 0; i < variants->count; i++)
		free(variants->items[i]);
	free(variants->items);
}

void provenance_clean(struct provenance *provenance)
{
	variants_clean(&provenance->builds);
	variants_clean(&provenance->hosts);
	*provenance = (struct provenance){0};
}
