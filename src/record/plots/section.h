/* Sections through snapshots: which points of a group of snapshots a plot shows, and their values over time
 * as a file of floats for gnuplot. */
#ifndef SELAS_RECORD_PLOTS_SECTION_H
#define SELAS_RECORD_PLOTS_SECTION_H

#include "record/parts.h"

/* A plane (or line) of points. Coordinates are those of the body's own frame. */
struct section {
    char title[96];
    int axis[2];                        /* axes of the body along the page and up it */
    bool downwards;                     /* second axis points down the page */
    size_t along, across;               /* lattice of the section; 0, 0: loose points */
    size_t points;                      /* that are shown */
    size_t start, stride, count, block; /* rows of the data set that hold them */
    size_t *pick;                       /* [points] of the rows read; NULL: all */
    float *coordinate;                  /* [2 * points] */
    double low[2], high[2];
    bool regular;   /* columns of a lattice: drawn as an image ... */
    size_t fine[2]; /* ... of this many pixels, values in between cubic */
    float *row;     /* [pixels] rows at them, counted in points, NAN: outside; NULL: equally spaced */
};

struct frame {
    size_t number; /* of the snapshot */
    double time;
    double largest[2]; /* magnitude in each section */
    size_t skip[2];    /* bytes before its values in the data file: floats, one a pixel or x y value */
};

/* All snapshots of one group. */
struct film {
    const struct output_choice *output; /* the scene's, for names of units */
    const char *axes;                   /* behind names of axes: whose they are */
    size_t group;
    selas_field field;
    size_t component;
    size_t frames;
    struct frame *frame; /* [frames] */
    size_t sections;
    struct section section[2];
    double largest[2]; /* over all frames */
    double scale[2];   /* for maps that share one scale */
    double *value;     /* a field as it is read for one section */
};

/* Chooses sections, field and component; false if there is nothing to draw. */
bool film_create(const struct recorder *recorder, size_t group, struct film *film, struct messages *messages);
/* Writes the values of all frames; false if they cannot be read back. */
bool film_write(const struct recorder *recorder, struct film *film, FILE *data, struct messages *messages);
void film_free(struct film *film);

/* image.c: decides whether a section is drawn as an image; writes its pixels. */
void image_prepare(struct section *section);
bool image_write(const struct section *section, const double *value, size_t components, FILE *data);

#endif
