/* Clocks of this process. */
#ifndef SELAS_BASE_CLOCK_H
#define SELAS_BASE_CLOCK_H

/* Wall clock and CPU time of all threads, seconds. */
double wall_seconds(void);
double cpu_seconds(void);

#endif
