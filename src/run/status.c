#include "run/status.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/build.h"
#include "base/file.h"
#include "config/yaml.h"

#define NAME "status.yaml"

enum { ENDED_MAX = 20 }; /* attempts whose ends are kept */

/* `key: 'text'`, with what YAML or a reader of one line would trip over taken out. */
static void add_quoted(struct text *out, const char *key, const char *text, size_t length)
{
	text_addf(out, "%s '", key);
	for (; length; text++, length--) {
		unsigned char c = (unsigned char)*text;

		text_add_bytes(out, c < ' ' || c == 0x7F ? " " : text, 1);
		if (c == '\'')
			text_add(out, "'");
	}
	text_add(out, "'\n");
}

static void add_ended(struct text *out, const char *lines)
{
	text_add(out, *lines ? "ended:\n" : "");
	while (*lines) {
		size_t length = strcspn(lines, "\n");

		add_quoted(out, "  -", lines, length);
		lines += length + (lines[length] == '\n');
	}
}

/* The list in status.yaml as lines. */
static void read_ended(const struct node *root, struct text *out)
{
	const struct node *list = node_find(root, "ended");

	for (size_t i = 0; list && i < list->count; i++)
		if (list->items[i].text && list->count - i < ENDED_MAX)
			text_addf(out, "%s\n", list->items[i].text);
}

static void note(struct attempt *attempt, int number, const char *state, const char *reason)
{
	char stamp[CLOCK_STAMP_SIZE];

	text_addf(&attempt->ended, "%s attempt %d: %s%s%s\n", clock_stamp(stamp), number, state,
		*reason ? ": " : "", reason);
}

void status_note_end(struct attempt *attempt, enum run_state state, const char *reason)
{
	char line[1024];

	attempt->failures += state == RUN_STATE_FAILED;
	note(attempt, attempt->number, run_state_name(state), text_excerpt(reason, line, sizeof line));
}

/* The nodes of status.yaml; false where there is none that can be read, with EX_SOFTWARE in `err` where
 * that is for want of memory. Clean them in every case. */
static bool load(const char *folder, struct node *root, struct error *err)
{
	struct error ignored = {0};
	struct text path = {0};
	bool found;

	*root = (struct node){0};
	found = file_path(&path, folder, NAME, &ignored) == 0 &&
			yaml_load(root, text_string(&path), &ignored) == 0 && root->kind == NODE_MAPPING;
	if (ignored.code == EX_SOFTWARE)
		*err = ignored;
	text_clean(&path);
	return found;
}

static void read_real(const struct node *root, const char *key, double *value)
{
	const struct node *node = node_find(root, key);

	if (node && node->text)
		(void)text_to_real(node->text, value);
}

static void read_count(const struct node *root, const char *key, int *count)
{
	double value = *count;

	read_real(root, key, &value);
	if (value >= 0 && value < 1e9)
		*count = (int)value;
}

static void read_counts(const struct node *root, struct run_report *report)
{
	read_count(root, "attempts", &report->attempts);
	read_count(root, "failures", &report->failures);
}

int status_read_past(struct attempt *attempt, struct error *err)
{
	struct run_report before = {0};
	const struct node *state;
	struct node root;

	if (load(attempt->folder, &root, err)) {
		read_counts(&root, &before);
		attempt->failures = before.failures;
		read_ended(&root, &attempt->ended);
		state = node_find(&root, "state");
		if (state && state->text && !strcmp(state->text, run_state_name(RUN_STATE_RUNNING)))
			note(attempt, before.attempts, "ended without a word",
				"killed, or the machine was lost");
	}
	attempt->number = before.attempts + 1;
	node_clean(&root);
	return err->code ? -1 : 0;
}

void run_report_history(const char *folder, struct text *out)
{
	struct error err = {0};
	struct node root;

	if (load(folder, &root, &err))
		read_ended(&root, out);
	out->failed |= err.code == EX_SOFTWARE;
	node_clean(&root);
}

void status_write(struct attempt *attempt, enum run_state state, const char *reason)
{
	double left = state == RUN_STATE_RUNNING ? attempt_wall_left(attempt) : NAN;
	char number[TEXT_REAL_SIZE], stamp[CLOCK_STAMP_SIZE], host[BUILD_HOST_SIZE];
	struct error err = {0};
	struct text out = {0};

	text_addf(&out, "state: %s\n", run_state_name(state));
	text_addf(&out, "attempts: %d\n", attempt->number);
	text_addf(&out, "step: %llu\n", (unsigned long long)attempt->step);
	text_addf(&out, "time: %s\n", text_real(attempt->time, number));
	text_addf(&out, "end: %s\n", text_real(attempt->config->time.end, number));
	text_addf(&out, "cpu_seconds: %.3f\n", attempt_cpu(attempt));
	if (isfinite(left))
		text_addf(&out, "wall_left: %.1f\n", left);
	text_addf(&out, "process: %ld on %s\n", (long)getpid(), build_host(host));
	text_addf(&out, "updated: %s\n", clock_stamp(stamp));
	text_addf(&out, "failures: %d\n", attempt->failures);
	add_quoted(&out, "reason:", reason, strlen(reason));
	add_ended(&out, text_string(&attempt->ended));
	if (!out.failed &&
		file_replace(&(struct file_place){.folder = attempt->folder, .name = NAME},
			&(struct file_part){out.data, out.length}, 1, &err) != 0 &&
		!attempt->status_failed) {
		char message[sizeof err.text + sizeof err.file];

		attempt->status_failed = true;
		attempt_say(attempt, RUN_VOICE_WARNING, "%s", error_format(&err, message, sizeof message));
	}
	text_clean(&out);
}

bool status_read(const char *folder, struct run_report *report)
{
	struct error err = {0};
	const struct node *reason;
	struct node root;
	bool found = load(folder, &root, &err);

	if (found) {
		read_counts(&root, report);
		read_real(&root, "time", &report->time);
		read_real(&root, "end", &report->end);
		read_real(&root, "cpu_seconds", &report->cpu_seconds);
		read_real(&root, "wall_left", &report->wall_left);
		reason = node_find(&root, "reason");
		if (reason && reason->text)
			(void)snprintf(report->reason, sizeof report->reason, "%s", reason->text);
	}
	report->unknown |= err.code == EX_SOFTWARE;
	node_clean(&root);
	return found;
}
