/* Static fields of ground that varies across an interface alone, and accelerated ones, up to second order along it
 * (doc/theory/general-ground.md, Eqs G26 and G27). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_STEADY_H
#define SELAS_METHOD_CONSISTENT_GENERAL_STEADY_H

#include "scene/ground_line.h"

/* A vector, by local direction, differentiated along the interface. */
struct slopes {
    double of[2][3];
};
/* At the place: displacement, its slopes and bends, traction across the interface and its slopes, acceleration. */
struct steady {
    double shift[3], pull[3], acceleration[3];
    struct slopes slope, bend[2], pull_slope;
    double (*shift_at)[3], (*pull_at)[3]; /* [count + 1] along the normal */
    struct slopes *slope_at;
};
enum { STEADY_MOST = 30 };

/* All of them, each with displacements of about `length` within that of the place; their number, 0: no memory. */
size_t steady_all(const struct ground_line *line, double length, struct steady list[STEADY_MOST]);
void steady_free(struct steady list[STEADY_MOST]);
/* Displacement at a place, by axis. */
void steady_at(const struct ground_line *line, const struct steady *steady, const double place[3],
               double displacement[3]);
/* Stress at a place times a normal. */
void steady_pull(const struct ground_line *line, const struct steady *steady, const double place[3],
                 const double normal[3], double pull[3]);
/* Its slopes [component][direction] at the origin, and the acceleration, by axis. */
void steady_slopes(const struct ground_line *line, const struct steady *steady, double slopes[3][3]);
void steady_acceleration(const struct ground_line *line, const struct steady *steady, double acceleration[3]);

#endif
