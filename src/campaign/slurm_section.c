/* The section `slurm:` of an experiment. */
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/setting.h"
#include "campaign/slurm.h"
#include "config/quantity.h"

enum { EXCERPT = 80, MINUTE = 60, HOUR = 3600, DAY = 86400, TIME_MAX = 365 * DAY };

/* A directive line of a batch script is read by sbatch alone; these characters mean nothing there that
 * would begin a comment, a word or a line. */
static bool is_plain(const char *text)
{
	for (; *text; text++)
		if (!isalnum((unsigned char)*text) && !strchr("._,:;+-=@/&|!*()[]%", *text))
			return false;
	return true;
}

static int read_word(const struct reader *reader, const struct node *node, const char **out)
{
	char shown[EXCERPT];

	TRY(reader_text(reader, node, out));
	if (is_plain(*out))
		return 0;
	return reader_fail(reader, node,
		"%s: letters, digits and ._,:;+-=@/&|!*()[]%% are wanted here, and no blanks or quotes",
		text_excerpt(*out, shown, sizeof shown));
}

static int read_partition(const struct reader *reader, const struct node *node, void *target)
{
	return read_word(reader, node, &((struct experiment_slurm *)target)->partition);
}

/* A number of at most nine digits, and what follows. */
static bool read_digits(const char **text, long *value)
{
	size_t digits = strspn(*text, "0123456789");

	if (!digits || digits > 9)
		return false;
	*value = strtol(*text, NULL, 10);
	*text += digits;
	return true;
}

/* As Slurm writes times: M:S, H:M:S, D-H, D-H:M, D-H:M:S. */
static bool read_slurm_time(const char *text, long *seconds)
{
	static const long units[] = {DAY, HOUR, MINUTE, 1};
	long parts[4] = {0};
	int first, count = 0;
	bool days = strchr(text, '-') != NULL;

	for (char next = days ? '-' : ':'; count < 4; next = ':') {
		if (!read_digits(&text, &parts[count++]))
			return false;
		if (*text != next)
			break;
		text++;
	}
	if (*text || count < 2 || (!days && count > 3))
		return false;
	first = days ? 0 : 4 - count;
	*seconds = 0;
	for (int i = 0; i < count; i++)
		*seconds += parts[i] * units[first + i];
	return true;
}

/* `2 h`, or as Slurm writes it; a bare number would be seconds to us and minutes to Slurm. */
static int read_seconds(
	const struct reader *reader, const struct node *node, long min, long max, long *out)
{
	struct error refusal = {0};
	char shown[EXCERPT];
	const char *text;
	double value;

	TRY(reader_text(reader, node, &text));
	(void)text_excerpt(text, shown, sizeof shown);
	if (!read_slurm_time(text, out)) {
		if (!text[strspn(text, "0123456789.")])
			return reader_fail(
				reader, node, "%s: say %s min, %s h or %s s", shown, shown, shown, shown);
		if (quantity_read(text, "s", &value, &refusal))
			return reader_fail(reader, node, "%s", refusal.text);
		*out = fabs(value) < TIME_MAX ? (long)ceil(value) : TIME_MAX + 1L;
	}
	if (*out < min || *out > max)
		return reader_fail(reader, node, "%s is not within %ld s and %ld s", shown, min, max);
	return 0;
}

static int read_time(const struct reader *reader, const struct node *node, void *target)
{
	return read_seconds(reader, node, MINUTE, TIME_MAX, &((struct experiment_slurm *)target)->time);
}

static int read_grace(const struct reader *reader, const struct node *node, void *target)
{
	long seconds = 0; /* sbatch keeps it in 16 bits */

	TRY(read_seconds(reader, node, 1, UINT16_MAX, &seconds));
	((struct experiment_slurm *)target)->grace = (int)seconds;
	return 0;
}

/* `4 GB`, `4G`, `4 GiB`: to Slurm they are the same. */
static int read_memory(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment_slurm *slurm = target;
	const char *text, *rest;
	char shown[EXCERPT];
	long value;

	TRY(reader_text(reader, node, &text));
	rest = text;
	if (read_digits(&rest, &value) && value > 0) {
		char unit;

		rest += *rest == ' ';
		unit = (char)toupper((unsigned char)*rest);
		if (unit && strchr("KMGT", unit) &&
			(!rest[1] || !strcmp(rest + 1, "B") || !strcmp(rest + 1, "iB"))) {
			(void)snprintf(slurm->memory, sizeof slurm->memory, "%ld%c", value, unit);
			return 0;
		}
	}
	return reader_fail(reader, node, "%s: a whole number of MB, GB or TB is wanted here",
		text_excerpt(text, shown, sizeof shown));
}

static int read_throttle(const struct reader *reader, const struct node *node, void *target)
{
	return reader_integer(reader, node, 1, 1000000, &((struct experiment_slurm *)target)->throttle);
}

/* What may stand among the directives: which machines are asked for and who pays. Not here, because an
 * experiment may come from a stranger: what runs a command, writes files or mails, or changes the
 * environment (--wrap, --output, --export, ...), and what the executor itself decides (--array, ...). */
static const char *const known_directives[] = {"account", "begin", "constraint", "cores-per-socket",
	"cpus-per-task", "deadline", "exclude", "exclusive", "gres", "hint", "licenses", "mem-per-cpu",
	"mincpus", "nice", "nodelist", "oversubscribe", "prefer", "priority", "qos", "reservation",
	"sockets-per-node", "switches", "thread-spec", "threads-per-core", "tmp", "wckey"};

static int read_directive(
	const struct reader *reader, const struct node *node, struct setting_list *out)
{
	size_t count = sizeof known_directives / sizeof *known_directives, i = 0;
	struct text known = {0};
	const char *value;
	char shown[EXCERPT];

	while (i < count && strcmp(node->key, known_directives[i]) != 0)
		i++;
	if (i < count) {
		TRY(read_word(reader, node, &value));
		return setting_list_add(out, node->key, node, reader->err);
	}
	for (i = 0; i < count; i++)
		text_addf(&known, "%s%s", i ? ", " : "", known_directives[i]);
	error_at(reader->err, EX_DATAERR, reader->path, node->key_line, node->key_column,
		"'%s' is no directive that an experiment may give; those are: %s",
		text_excerpt(node->key, shown, sizeof shown), text_string(&known));
	text_clean(&known);
	return -1;
}

static int read_directives(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment_slurm *slurm = target;

	if (node->kind != NODE_MAPPING)
		return reader_fail(reader, node, "a mapping is wanted here, such as {account: granular}");
	for (size_t i = 0; i < node->count; i++)
		TRY(read_directive(reader, &node->items[i], &slurm->directives));
	return 0;
}

const struct reader_key slurm_keys[SLURM_KEYS] = {
	{"partition", read_partition, "partition that the tasks go to (default: that of the cluster)"},
	{"time", read_time,
		"limit of a task, as `2 h` or as Slurm writes it: \"2:00:00\", \"1-12\" "
		"(default: that of the cluster)"},
	{"grace", read_grace,
		"so long before the limit a run is asked to write its checkpoint and stop (default: 60 s)"},
	{"memory", read_memory, "memory of a task, such as 2 GB (default: that of the cluster)"},
	{"throttle", read_throttle, "tasks at a time; --jobs overrides it (default: any number)"},
	{"directives", read_directives,
		"further options of sbatch with their values; those that choose machines or say who pays"},
};

int slurm_read(const struct reader *reader, const struct node *node, struct experiment_slurm *slurm)
{
	TRY(reader_keys(reader, node, slurm_keys, SLURM_KEYS, slurm));
	/* it would be asked to stop as soon as it has begun, again and again */
	if (slurm->time && slurm->grace >= slurm->time)
		return reader_fail(reader, node, "a grace of %d s leaves nothing of a time of %ld s",
			slurm->grace, slurm->time);
	return 0;
}
