/* How far the front goes, how fast, and until when. */
#include <math.h>
#include <stdlib.h>

#include "tables/metric_parts.h"

/* The final front, from the gate. */
int metric_runout(const struct sample *sample, double *out, struct error *err)
{
	TRY(metric_series_last(sample, out, err));
	*out -= sample->config->initial.front;
	return 0;
}

/* In percent of that of the reference run. */
int metric_runout_change(const struct sample *sample, double *out, struct error *err)
{
	struct sample other = *sample;
	double reference;

	other.file = sample->partner;
	TRY(metric_runout(&other, &reference, err));
	TRY(metric_runout(sample, out, err));
	*out = 100 * (*out / reference - 1);
	return 0;
}

/* The last moment at which the speed `dataset` was above the static speed. */
int metric_stopping_time(const struct sample *sample, double *out, struct error *err)
{
	struct dataset time = {0}, speed = {0};
	size_t i;

	TRY(metric_read_series(sample->file, sample->metric->dataset, &time, &speed, err));
	i = metric_count(&speed);
	while (i > 0 && fabs(speed.values[i - 1]) < sample->config->output.static_speed)
		i--;
	if (i < metric_count(&speed))
		*out = time.values[i];
	else
		(void)error_set(err, EX_DATAERR, "it still flows at the end");
	free(time.values);
	free(speed.values);
	return err->code ? -1 : 0;
}

/* The first and the greatest velocity of the front, and when it has that. At the release it jumps to the
 * next cell, which is no flow. */
static int front_peak(
	const struct sample *sample, double *first, double *velocity, double *when, struct error *err)
{
	const double settled = 0.04; /* s: the window of 0.02 s has left the release behind */
	struct dataset time = {0}, front = {0};

	*first = *velocity = *when = NAN;
	TRY(metric_read_series(sample->file, "front_velocity", &time, &front, err));
	for (size_t i = 0; i < metric_count(&front); i++)
		if (time.values[i] >= settled && !(front.values[i] <= *velocity)) {
			if (isnan(*first))
				*first = front.values[i];
			*velocity = front.values[i];
			*when = time.values[i];
		}
	free(time.values);
	free(front.values);
	return 0;
}

int metric_front_velocity(const struct sample *sample, double *out, struct error *err)
{
	double first, when;

	return front_peak(sample, &first, out, &when, err);
}

int metric_front_velocity_time(const struct sample *sample, double *out, struct error *err)
{
	double first, velocity;

	return front_peak(sample, &first, &velocity, out, err);
}

int metric_first_front_velocity(const struct sample *sample, double *out, struct error *err)
{
	double velocity, when;

	return front_peak(sample, out, &velocity, &when, err);
}
