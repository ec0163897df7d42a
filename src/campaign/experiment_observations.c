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

int experiment_observations_read(
	const struct reader *reader, const struct node *node, struct experiment *experiment)
{
	static const struct reader_key keys[] = {
		{"file", read_file},
		{"title", read_title},
		{"only", read_only},
	};

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
		TRY(reader_keys(reader, &node->items[i], keys, sizeof keys / sizeof *keys, observation));
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
