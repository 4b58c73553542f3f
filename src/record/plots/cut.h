/* Cuts through the ground as a run sees it: speeds on a grid of pixels, and where they jump. */
#ifndef SELAS_RECORD_PLOTS_CUT_H
#define SELAS_RECORD_PLOTS_CUT_H

#include "scene/scene.h"

#include <stdio.h>

/* A plane through the body and its absorbing layers, in the body's own frame. */
struct cut {
    char name[2][40]; /* of the axes along the page and up it, "x", "distance along A-B" */
    bool downwards;   /* the second axis points down the page */
    double origin[3]; /* place = origin + first coordinate * along + second * across */
    double along[3], across[3];
    double low[2], high[2];           /* of the page, layers included */
    double body_low[2], body_high[2]; /* the body's part of it */
    int face[2][2];                   /* faces at its ends, -1: none */
    size_t pixels[2];
    float *speed[2]; /* [pixels] of S and P waves; above the surface NaN */
    double least[2], greatest[2];
};

/* The surface, z- face. */
void cut_map(const struct scene *scene, struct cut *cut);
/* The plane over depth through two places (of the body's frame); of a scene in two dimensions all. */
void cut_section(const struct scene *scene, const double from[3], const double to[3], struct cut *cut);
/* Takes the speeds; false without memory. */
bool cut_fill(const struct scene *scene, struct cut *cut);
/* Coordinates in a cut of a place; returns how far it lies from it. */
double cut_project(const struct cut *cut, const double place[3], double at[2]);
/* Middles of the edges between pixels between which the rock jumps, as lines of two numbers; false: none. */
bool cut_write_jumps(const struct scene *scene, const struct cut *cut, FILE *script);
/* The surface along a section, as lines of two numbers; none where it is level, or of a map. */
void cut_write_surface(const struct scene *scene, const struct cut *cut, FILE *script);
/* The rim of a rectangle of the page, of what lies below the surface: lines of two numbers and an empty one. */
void cut_write_part(const struct scene *scene, const struct cut *cut, const double low[2],
                    const double high[2], FILE *script);
/* The rims of the absorbing layers; false: none. */
bool cut_write_layers(const struct scene *scene, const struct cut *cut, FILE *script);
bool cut_write_speed(const struct cut *cut, int which, FILE *data);
void cut_free(struct cut *cut);

#endif
