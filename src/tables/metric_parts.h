/* Metrics that live in files of their own, and what all share. */
#ifndef TALUS_METRIC_PARTS_H
#define TALUS_METRIC_PARTS_H

#include "tables/metric.h"

/* A dataset that holds at least one value; its values are the caller's. EX_DATAERR. */
int metric_read(struct run_file *file, const char *name, struct dataset *out, struct error *err);

size_t metric_count(const struct dataset *data);

/* The row of `time` in profile_time. EX_DATAERR where there is none. */
int metric_profile_row(struct run_file *file, double time, size_t *row, struct error *err);

/* metric_cost.c: CPU time, of the whole or the share of one of its series, and steps. */
int metric_cpu_seconds(const struct sample *sample, double *out, struct error *err);
int metric_speed_up(const struct sample *sample, double *out, struct error *err);
int metric_ns_per_unknown(const struct sample *sample, double *out, struct error *err);
int metric_share(const struct sample *sample, double *out, struct error *err);
int metric_steps(const struct sample *sample, double *out, struct error *err);

/* metric_front.c: how far the front goes, how fast, and until when. */
int metric_runout(const struct sample *sample, double *out, struct error *err);
int metric_runout_change(const struct sample *sample, double *out, struct error *err);
int metric_stopping_time(const struct sample *sample, double *out, struct error *err);
int metric_front_velocity(const struct sample *sample, double *out, struct error *err);
int metric_front_velocity_time(const struct sample *sample, double *out, struct error *err);
int metric_first_front_velocity(const struct sample *sample, double *out, struct error *err);

/* metric_thickness.c: h over x at a time, whose `values` belong to the caller; its height at the end, and its
 * difference from the reference run. */
int metric_thickness(
	struct run_file *file, double time, double **values, size_t *cells, struct error *err);
int metric_deposit_height(const struct sample *sample, double *out, struct error *err);
int metric_l1_difference(const struct sample *sample, double *out, struct error *err);
int metric_l2_difference(const struct sample *sample, double *out, struct error *err);

/* metric_observed.c: against what was observed. */
int metric_l2_observed(const struct sample *sample, double *out, struct error *err);
int metric_front_observed(const struct sample *sample, double *out, struct error *err);

/* metric_steady.c: a profile over the layers against the one stored beside it as NAME_steady, relative. */
int metric_steady_l1(const struct sample *sample, double *out, struct error *err);
int metric_steady_l2(const struct sample *sample, double *out, struct error *err);
int metric_steady_linf(const struct sample *sample, double *out, struct error *err);
int metric_layer_max(const struct sample *sample, double *out, struct error *err);

/* metric_place.c: at a profile time and a position. */
int metric_mean_velocity(const struct sample *sample, double *out, struct error *err);

/* metric_reference.c: a profile over x against that of a finer reference run. */
int metric_reference_l1(const struct sample *sample, double *out, struct error *err);

/* metric_drift.c: the greatest distance from the first stored profile, L1 as P1 (35) or of any one value. */
int metric_drift_l1(const struct sample *sample, double *out, struct error *err);
int metric_drift_largest(const struct sample *sample, double *out, struct error *err);
int metric_profile_greatest(const struct sample *sample, double *out, struct error *err);

/* metric_coordinates.c: a thickness of the sample's run changed into the coordinates and onto the cells of its
 * partner; the way of the front at a profile time against that of the partner, along the plane. */
int metric_turn_thickness(
	const struct sample *sample, double **h, size_t *cells, struct error *err);
int metric_front_difference(const struct sample *sample, double *out, struct error *err);

/* metric_series.c: a series and its times, as many, all the caller's; and numbers of a series. */
int metric_read_series(struct run_file *file, const char *name, struct dataset *times,
	struct dataset *values, struct error *err);
int metric_series_last(const struct sample *sample, double *out, struct error *err);
int metric_series_greatest(const struct sample *sample, double *out, struct error *err);
int metric_series_least(const struct sample *sample, double *out, struct error *err);
int metric_series_drift(const struct sample *sample, double *out, struct error *err);
int metric_mass_drift(const struct sample *sample, double *out, struct error *err);
int metric_series_rise(const struct sample *sample, double *out, struct error *err);
int metric_series_rises(const struct sample *sample, double *out, struct error *err);
int metric_series_loss(const struct sample *sample, double *out, struct error *err);
int metric_series_half_time(const struct sample *sample, double *out, struct error *err);
int metric_series_sign_change(const struct sample *sample, double *out, struct error *err);
int metric_series_difference(const struct sample *sample, double *out, struct error *err);

#endif
