/* A plot of the ground: its page, and what it shows beside the ground: sources, receivers, faces, interfaces. */
#ifndef SELAS_RECORD_PLOTS_MARKS_H
#define SELAS_RECORD_PLOTS_MARKS_H

#include "record/plots/cut.h"

enum { NAMED = 12 /* receivers, at most, whose names are written */, NAME_TAGS = 10 };

struct page {
    const struct scene *scene;
    FILE *script;
    int width, height;
    size_t cuts;
    struct cut cut[2]; /* section, map */
    double least[2], greatest[2];
    int size[2][2]; /* pixels of each cut's panel */
    size_t sources, receivers;
    bool jumps, layers; /* an interface, an absorbing layer is seen */
};

enum face_look { LOOK_DAMPED, LOOK_HELD, LOOKS };

/* Where the section goes (body's frame): first source that has a place, else first receiver, else the middle;
 * the receiver farthest from it. */
void marks_line(const struct scene *scene, double from[3], double to[3]);
/* The data of a cut: $sources, $receivers, $jumps, $surface, $layers, $body, $patches (rims), each with the
 * cut's number, and $facesCUT_LOOK. */
void marks_write(struct page *page, size_t c);
/* Sets labels NAME_TAGS and so on: the receivers' names, none on another. */
void marks_names(const struct page *page, size_t c);
/* Are there faces that look so? */
bool marks_any_face(const struct page *page, enum face_look look);

#endif
