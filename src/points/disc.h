/* What a rectangle has of a disc. */
#ifndef SELAS_POINTS_DISC_H
#define SELAS_POINTS_DISC_H

/* Area and first moments over x and y of what lies in both, exact but for rounding. low[2] < high[2]: corners of the
 * rectangle, from the disc's centre. */
void disc_and_rectangle(const double low[2], const double high[2], double radius, double moment[3]);

#endif
