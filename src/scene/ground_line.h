/* Ground that varies across one direction alone: in the place of that of the deck about a source
 * (doc/theory/general-ground.md, section 6). */
#ifndef SELAS_SCENE_GROUND_LINE_H
#define SELAS_SCENE_GROUND_LINE_H

#include "scene/ground.h"

/* Rock along the normal through a place, in steps; directions by axis of the body's frame, those along the interface
 * first. */
struct ground_line {
    int dimension;
    double origin[3], basis[3][3];
    double from, step; /* the first step begins so far along the normal */
    size_t count;
    struct rock *rock; /* [count] */
    struct rock here;  /* at the place */
};

/* `reach` on either side. False: no memory; free it all the same. */
bool ground_line_new(const struct scene *scene, const double origin[3], const double normal[3], double step,
                     double reach, struct ground_line *line);
void ground_line_free(struct ground_line *line);
/* Rock at a place, if the ground is as the line says. */
const struct rock *ground_line_at(const struct ground_line *line, const double place[3]);

/* A place by local direction, from the origin; the step that a distance along the normal lies in, the nearest one, and
 * its part of the way through it. */
void ground_line_local(const struct ground_line *line, const double place[3], double local[3]);
size_t ground_line_step(const struct ground_line *line, double along, double *part);
/* As ground_jumps() and ground_jumps_at_most(). */
size_t ground_line_jumps(const struct ground_line *line, const double place[3], int axis, double from,
                         double to, double *at);
size_t ground_line_jumps_at_most(const struct ground_line *line);

#endif
