/* Clouds: the points of a body with the volumes they stand for and the elements of its surface.
 *
 * All lengths are in the deck's units and in the body's own frame (see scene.h). Unused components are 0. The
 * volumes add up to the body's volume (area in 2D, length in 1D) to rounding, the areas of a face's elements
 * to the face's area (length in 2D, 1 in 1D). SPH points lie about half a spacing inside the surface. */
#ifndef SELAS_CLOUD_H
#define SELAS_CLOUD_H

#include "scene/scene.h"

#include <stdint.h>

/* A piece of the surface: a face of the box, of the hole, or FACES for surfaces without a name (files). */
struct face_element {
    double position[3]; /* its middle, on the surface */
    double normal[3];   /* outward, unit */
    double width[3]; /* extent along the axes (0 along the normal); 0 where it is not an axis-aligned box */
    double area;
    int face; /* enum face or FACES */
};

/* What a part of points of a file knows of the whole body. */
struct cloud_all {
    double volume, square;           /* of all points; cloud_mean_power() of order 2 */
    size_t elements, of_face[FACES]; /* of the surface, and those on each face */
    double area[FACES];              /* on each face */
    double *position;                /* [3 * whole] deck coordinates */
};

/* Of a body whose points stand in planes or layers over an axis, a part: the points first .. first + points - 1 in
 * the body's order, and the elements of its surface whose coordinate along the axis is low .. high. */
struct cloud {
    int dimension;
    size_t points;
    size_t first, whole; /* 0 and `points` where it is no part */
    int axis;            /* the last one; of points of a file in layers the longest */
    double low, high;
    size_t layers, *start; /* points of a file in layers: the first of each, [layers + 1]; else 0, NULL */
    uint32_t *number;      /* [whole] of the same: their places in the file, from 0 on; else NULL */
    struct cloud_all *all; /* of a part of them; else NULL */
    double *position;      /* [3 * points] */
    double *volume;        /* [points] */
    double spacing;        /* nominal */
    size_t grid[3];        /* points per axis of the body where they form a lattice (x fastest), else 0 */
    size_t elements;
    struct face_element *element;
};

/* Points of scene->body as its shape, arrangement, jitter and seed say; points from outside without areas get the
 * surface of the box if their volumes fill it to 2 %. SELAS_BAD_SCENE with the reason where
 * they cannot be made. On failure *cloud is NULL. */
selas_status cloud_create(const struct scene *scene, struct cloud **cloud, struct messages *messages);
/* Points per axis of a scene whose points can be made plane by plane: those of a box in two or three dimensions on a
 * lattice, with so little jitter that each one's volume hangs on those within the reach of cloud_margin(). False: they
 * cannot. */
bool cloud_in_planes(const struct scene *scene, size_t grid[3]);
/* The part of such a cloud with the planes from .. end - 1 over the last axis (of a lattice with jitter: before it).
 * SELAS_NO_MEMORY. */
selas_status cloud_create_planes(const struct scene *scene, size_t from, size_t end, struct cloud **cloud,
                                 struct messages *messages);
/* Planes at either end of such a part whose volumes are not those of the body. */
size_t cloud_margin(const struct scene *scene);
/* A point of such a cloud by its number in the body, deck coordinates. */
void cloud_place(const struct scene *scene, size_t point, double position[3]);
void cloud_free(struct cloud **cloud);

/* points/layers.c: sorts points of a file into layers, about a spacing thick, over the longest axis of the body's box
 * (of several the last), in each of which they keep their order; elements of the surface too. SELAS_NO_MEMORY. */
selas_status cloud_sort(struct cloud *cloud, const struct body *body, struct messages *messages);
/* The layer that a place of the body's frame is in; those beyond the ends are in the first and last one. */
size_t cloud_layer(const struct cloud *cloud, const struct body *body, const double place[3]);
/* The layers from .. end - 1 of such a cloud, in place of it, whatever the status. SELAS_NO_MEMORY. */
selas_status cloud_cut(struct cloud **cloud, const struct body *body, size_t from, size_t end,
                       struct messages *messages);
/* Elements of the surface that the whole body has on a face, and their area. */
size_t cloud_on_face(const struct cloud *cloud, int face, double *area);
/* The number of a point in the body or its file, from 1 on, for messages. */
size_t cloud_number(const struct cloud *cloud, size_t point);

double cloud_volume(const struct cloud *cloud); /* of all points of the body */
/* The same over the volume of the body's box. */
double cloud_filling(const struct cloud *cloud, const struct body *body);
/* Volume (area, length) of the body: box minus hole. */
double body_volume(const struct body *body, int dimension);
/* Angles from the hole's centre that lie in the box: all round, half or a quarter (centre on a face or a
 * corner). */
void hole_angles(const struct body *body, double *first, double *last);

/* The parts, for those who build clouds: room for points (volumes 0) and for surface elements. */
selas_status cloud_allocate(int dimension, size_t points, struct cloud **cloud, struct messages *messages);
/* Nothing to add: the element lies beside the part. */
selas_status cloud_add_element(struct cloud *cloud, const struct face_element *element,
                               struct messages *messages);
/* points/surface.c: elements of the box faces (and the hole) about one spacing wide. */
selas_status cloud_surface(struct cloud *cloud, const struct body *body, struct messages *messages);
/* points/rings.c: plates with a hole. */
selas_status cloud_plate(const struct body *body, struct cloud **cloud, struct messages *messages);
/* points/points_file.c: text or HDF5. Bytes a point that it takes at most. */
enum { CLOUD_READING = 104 };
selas_status cloud_read(const struct scene *scene, struct cloud **cloud, struct messages *messages);
/* points/points_check.c: SELAS_BAD_SCENE if two points are closer than a millionth of the spacing; path, line
 * [points]: the file and where they stand in it, or NULL. */
selas_status points_check_apart(size_t points, const double *position, double spacing, const char *path,
                                const size_t *line, struct messages *messages);
/* Warns of volumes that do not fit into a closed surface. */
void points_warn_of_volumes(const struct cloud *cloud, const struct body *body, struct messages *messages);
/* Warns of a body%spacing that the points do not have. */
void points_warn_of_spacing(const struct cloud *cloud, const struct body *body, struct messages *messages);
/* Warns of places of the box without a point within a spacing (position in the body's frame). */
selas_status points_warn_of_gaps(const struct body *body, int dimension, size_t points,
                                 const double *position, struct messages *messages);
/* points/local_spacing.c: spacing about each point, [points]: the d-th root of the mean volume of the points within
 * three of its own spacings, which leaves out the noise of single volumes. SELAS_NO_MEMORY. */
selas_status cloud_local_spacing(const struct cloud *cloud, double *spacing, struct messages *messages);
/* What a wave's error of an order in the spacing is on the points, over that at cloud->spacing: mean over the body of
 * (spacing / cloud->spacing)^order. */
double cloud_mean_power(const struct cloud *cloud, double order);
/* points/cells.c: volumes of the Voronoi cells inside the body (3D: boxes only). */
selas_status cloud_cells(struct cloud *cloud, const struct body *body, struct messages *messages);

#endif
