/* The surface of the ground (doc/theory/topography.md): how far it lies below the plane of
 * face z-, and the map of a lattice that follows it,
 *
 *   z = zeta + s(x, y) f(zeta),   f from 1 at the plane to 0 at a depth,                                 (G16)
 *
 * all else along the axes. With topography the "body's own frame" is that of the lattice: body_from_deck() and
 * body_to_deck() go through the map. */
#ifndef SELAS_SCENE_TOPOGRAPHY_H
#define SELAS_SCENE_TOPOGRAPHY_H

#include "scene/height_map.h"
#include "scene/scene.h"

enum topography_shape { TOPOGRAPHY_SHAPES(CHOICE_SYMBOL) };

/* Coordinates beyond `from` are drawn out over `width`, to the surface's being level across the face; 0: not. */
struct drawn_out {
    double from, width;
};

struct topography {
    enum topography_shape shape;
    double height, centre[2], width; /* of the shapes: centre and standard deviation */
    double across[2];                /* unit vector across a ridge or canyon */
    struct height_map *map;          /* of a file, in place of a shape; NULL: none */
    int axis;                        /* the vertical one */
    double plane;                    /* where the vertical axis cuts face z- */
    double depth;                    /* below the plane the lattice is level */
    double top;                 /* how far its highest point lies below the plane; a hill's is negative */
    struct drawn_out end[2][2]; /* [horizontal axis][low, high] */
    double changed;             /* by that, at the points of the surface at most */
    char text
        [4]
        [200]; /* for the plan: heights and slope, lattice, what splines and what absorbing layers changed */
};
enum { TOPOGRAPHY_LINES = 4 };

/* s at a place (x, y): how far the surface lies below the plane of face z-; a hill's is negative. */
double topography_drop(const struct topography *topography, const double place[2]);
/* Is the place one where the surface is drawn out? */
bool topography_drawn(const struct topography *topography, const double place[2]);
/* Draws the surface out as faces and box of the scene ask: absorbing layers go on as it is at the face, level across
 * it. */
void topography_draw_out(struct scene *scene);
/* By how much that changes heights from low to high along the horizontal axes, at most. */
double topography_changed(const struct topography *topography, double spacing, const double low[2],
                          const double high[2]);
/* That change, of the slowest wave's length at the source's cutoff; 0: not known. Velocities differed from those of a
 * box with the whole surface in it by 1 to 3 times as much (hills from files drawn by chance,
 * regress/studies/real-ground). */
#define TOPOGRAPHY_LEVELLED 0.002 /* what the program takes without a word */
double topography_levelled(const struct scene *scene, double changed);
/* f at a depth below the plane of face z-, its slope over depth in *slope. */
double topography_share(const struct topography *topography, double depth, double *slope);
/* Vertical coordinate of a place of the lattice whose column has a surface `drop` below the plane, and the other way.
 */
double topography_real(const struct topography *topography, double drop, double lattice);
double topography_lattice(const struct topography *topography, double drop, double real);
/* A place of the deck becomes one of the lattice, and the other way. */
void topography_to_lattice(const struct topography *topography, double place[3]);
void topography_to_deck(const struct topography *topography, double place[3]);
/* Is the surface its own image across the middle of the body along an axis? */
bool topography_mirrors(const struct body *body, int dimension, int axis);
void topography_free(struct topography *topography); /* takes NULL */

#endif
