/* Clocks. */
#ifndef TALUS_CLOCK_H
#define TALUS_CLOCK_H

double clock_wall(void); /* s since some moment; never runs backwards */
double clock_cpu(void);  /* CPU time of this process, all threads, s */

/* The present moment as "2025-01-31T23:59:59Z". Returns `buffer`. */
enum { CLOCK_STAMP_SIZE = 24 };
char *clock_stamp(char buffer[CLOCK_STAMP_SIZE]);

/* A duration in s for people: "4.2 s", "3 min 05 s", "2 h 07 min". Returns `buffer`. */
enum { CLOCK_SPAN_SIZE = 32 };
char *clock_span(double span, char buffer[CLOCK_SPAN_SIZE]);

#endif
