#include "run/status.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/build.h"
#include "base/file.h"
#include "config/yaml.h"

#define NAME "status.yaml"

/* `key: 'text'`, with what YAML or a reader of one line would trip over taken out. */
static void add_quoted(struct text *out, const char *key, const char *text)
{
	text_addf(out, "%s: '", key);
	for (; *text; text++) {
		unsigned char c = (unsigned char)*text;

		text_add_bytes(out, c < ' ' ? " " : text, 1);
		if (c == '\'')
			text_add(out, "'");
	}
	text_add(out, "'\n");
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
	add_quoted(&out, "reason", reason);
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

static void read_real(const struct node *root, const char *key, double *value)
{
	const struct node *node = node_find(root, key);

	if (node && node->text)
		(void)text_to_real(node->text, value);
}

bool status_read(const char *folder, struct run_report *report)
{
	struct error ignored = {0};
	const struct node *reason;
	struct node root = {0};
	struct text path = {0};
	double attempts = report->attempts;
	bool found;

	found = file_path(&path, folder, NAME, &ignored) == 0 &&
			yaml_load(&root, text_string(&path), &ignored) == 0 && root.kind == NODE_MAPPING;
	if (found) {
		read_real(&root, "attempts", &attempts);
		if (attempts >= 0 && attempts < 1e9)
			report->attempts = (int)attempts;
		read_real(&root, "time", &report->time);
		read_real(&root, "end", &report->end);
		read_real(&root, "cpu_seconds", &report->cpu_seconds);
		read_real(&root, "wall_left", &report->wall_left);
		reason = node_find(&root, "reason");
		if (reason && reason->text)
			(void)snprintf(report->reason, sizeof report->reason, "%s", reason->text);
	}
	report->unknown |= ignored.code == EX_SOFTWARE;
	node_clean(&root);
	text_clean(&path);
	return found;
}
