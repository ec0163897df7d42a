#include "campaign/experiment_observations.h"

#include <stdlib.h>
#include <string.h>

#include "campaign/setting.h"

static int read_file(const struct reader *reader, const struct node *node, void *target)
{
	struct experiment_observation *observation = target;

	observation->file = (struct term){NULL, node->line, node->column};
	return reader_text(reader, node, &observation->file.text);
}

static int read_title(const struct reader *reader, const struct node *node, void *target)
{
	return reader_text(reader, node, &((struct experiment_observation *)target)->title);
}

static int read_only(const struct reader *reader, const struct node *node, void *target)
{
	return reader_settings(reader, node, &((struct experiment_observation *)target)->only);
}

static const struct reader_key observation_keys[] = {
	{"file", read_file,
		"path of a CSV file, relative to this one (experiments/README.md); required"},
	{"title", read_title, "in the legend (default: observed)"},
	{"only", read_only, "values that runs must have to be compared with it"},
};

void experiment_observations_reference(struct text *out)
{
	reader_reference(out, "An observation", observation_keys,
		sizeof observation_keys / sizeof *observation_keys);
}

int experiment_observations_read(
	const struct reader *reader, const struct node *node, struct experiment *experiment)
{
	if (node->kind != NODE_SEQUENCE)
		return reader_fail(reader, node, "a list of mappings with their 'file' is wanted here");
	experiment->observations =
		calloc(node->count ? node->count : 1, sizeof *experiment->observations);
	if (!experiment->observations)
		return error_memory(reader->err, node->count * sizeof *experiment->observations);
	for (size_t i = 0; i < node->count; i++) {
		struct experiment_observation *observation = &experiment->observations[i];

		experiment->observation_count = i + 1;
		observation->title = "observed";
		TRY(reader_keys(reader, &node->items[i], observation_keys,
			sizeof observation_keys / sizeof *observation_keys, observation));
		if (!observation->file.text)
			return reader_fail(reader, &node->items[i], "these observations lack their 'file'");
		observation->path = reader_file(reader, observation->file.text);
		if (!observation->path)
			return error_memory(reader->err, strlen(observation->file.text));
	}
	return 0;
}

void experiment_observations_clean(struct experiment *experiment)
{
	for (size_t i = 0; i < experiment->observation_count; i++) {
		free(experiment->observations[i].path);
		setting_list_clean(&experiment->observations[i].only);
	}
	free(experiment->observations);
}
