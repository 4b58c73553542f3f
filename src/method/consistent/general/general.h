/* The general operator of the consistent method: material that varies in all directions
 * (doc/theory/general-ground.md).
 *
 * The strain energy is taken at three families of points, on the knots of one axis and in the middles of the
 * cells of the others (G1), for splines of degree 2; the mass inverse is that of an even ground between two
 * diagonals (G4). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_GENERAL_H
#define SELAS_METHOD_CONSISTENT_GENERAL_GENERAL_H

#include "method/consistent/galerkin/hform.h"
#include "method/consistent/galerkin/surface.h"
#include "method/consistent/general/points.h"

/* Points of one family: n[slot] of them, x fastest. Moduli are times the weight of the point (G2). */
struct family {
    size_t n[3];
    enum at at[3]; /* by slot */
    double *lambda, *mu;
    size_t runs, *first_run; /* [n[1] * n[2] + 1]: the first run of each row */
    struct run_of_points *run;
    double *stiffness; /* of all runs */
};

/* Shares of d at the points of an axis, and their plain weights, in cells (edges.c). */
struct edge_line {
    size_t n;
    double *share, *plain;
};

/* What a point sees of a component: control values of some planes, rows and columns. Slopes of their functions along
 * the axes, in edges.slope from `at` on: [planes][rows][slot][EDGE_LANES], of which
 * columns are there; points that see alike
 * share them. */
enum { EDGE_LANES = 4, EDGE_ROW = 3 * EDGE_LANES };
struct edge_taps {
    size_t plane, planes, row, rows, column, columns, at;
};

/* A point near an edge that is of no family; moduli times its weight; planes and rows that it sees; by slot of the
 * component. */
struct edge_point {
    double lambda, mu;
    size_t plane, plane_end, row, row_end;
    struct edge_taps of[3];
};

struct edges {
    struct edge_line line[3][2]; /* [slot][at] */
    size_t count, most;          /* points; at most so many begin in a plane */
    size_t *start; /* [n[DEPTH] + 1]: those that see plane k first are start[k] to start[k + 1] */
    struct edge_point *point;
    size_t used, room; /* numbers of `slope` */
    double *slope;
};

/* The map of a surface that is not level, by the splines of the displacements (hill.c). */
struct hill {
    double *drop[3], *slope[3][2]; /* [family][n[0] * n[1] of its points]: s and its slopes */
    double *share[2], *fall[2];    /* [at][points over depth]: f and its slope */
    size_t level[2];               /* [at]: planes from here on are level */
};

/* What rise.c found about the place that was asked for last, by axis. */
struct slopes_about {
    bool known;
    double place[3], slope[4][3];
};

struct general {
    size_t cells[3];            /* by slot; over depth those whose control values the window has */
    size_t first;               /* over depth: the first of them in the body */
    struct taps *taps[3][2][2]; /* [slot][odd][at] */
    struct family family[3];
    struct edges *edges;         /* NULL: no two faces meet */
    struct hill *hill;           /* NULL: the surface is level */
    struct sweep *sweep;         /* NULL: steps are made with the operator */
    struct general_layer *layer; /* [layers] */
    size_t layers;
    size_t moments; /* numbers of phi of all layers; behind them in extra, as many forces along the layers */
    double *pulled, *middle; /* [moments] those of the last general_forces(); phi in the middle of a step */
    bool made;               /* `force` is that of the state that memory has been brought to */
    double *root;            /* 1 / sqrt(R) at the control values (G4, G5) */
    struct tensor_plan *inverse; /* N */
    double *force;               /* [unknowns] F - K u, times root */
    double *work;                /* [unknowns] */
    bool *loud;                  /* [n[1] * n[2]] rows of control values that move anything */
    double **buffer;             /* [threads] */
    size_t pitch, buffer_size;   /* of rows in the buffers; numbers of a buffer */
    size_t bytes, setup_bytes;   /* held; while the ground is averaged */
    struct slopes_about slopes;
};

/* Builds c->general; needs c->hform and the loads. */
selas_status general_create(struct consistent *c, struct messages *messages);
void general_free(struct consistent *c);

/* Position of a point of an axis, by slot, over depth of the window's; 0 where there is no such axis. */
double general_place(const struct consistent *c, int slot, enum at at, size_t i);

/* a = M^-1 (F - K u - C v). */
void general_accelerate(struct consistent *c, const struct drive *drive, double half_step, const double *u,
                        const double *v, double *a);
void general_weigh(struct consistent *c, const double *v, double *product); /* M v */
void general_energy(struct consistent *c, const double *y, struct energy *energy);
double general_damper_power(struct consistent *c, const double *v);

/* forces.c: force := -K u, with the memory of absorbing layers if extra is not NULL, which then keep the forces of
 * stresses along them. */
void general_forces(struct consistent *c, const double *u, const double *extra, double *force);

/* Part of a plane: rows of control values row .. row_end - 1, numbers from .. end - 1 of the unclamped splines
 * along x. */
struct part {
    size_t row, row_end, from, end;
};
struct part general_whole(const struct consistent *c);
/* Values and slopes over depth of a part of plane m of points into a buffer; no pulls there. */
void general_read(const struct consistent *c, enum at at, size_t m, const struct part *part, const double *u,
                  double *buffer);
/* apart: pulls along y are kept apart. */
struct point_plane general_plane(const struct consistent *c, const struct family *family, bool apart,
                                 double *buffer);
/* Rows of control values whose displacements are not below `quiet` times the largest: c->general->loud. */
void general_look(struct consistent *c, const double *u);
/* Does any of the rows of control values that a row of points reads move anything? */
bool general_row_is_loud(const struct consistent *c, const struct taps *y, const struct taps *z);
/* Does a plane of points reach planes from .. end - 1, and does it move anything? */
bool general_plane_counts(const struct consistent *c, enum at at, size_t m, size_t from, size_t end);

/* layers.c: absorbing layers (doc/theory/general-ground.md, section 5). */
selas_status general_layers_create(struct consistent *c, struct messages *messages);
void general_layers_free(struct consistent *c);
/* Adds their memory to the slopes of points from .. end - 1 of row j in plane m. */
void general_layers_add(const struct consistent *c, const struct point_plane *plane,
                        const struct family *family, size_t j, size_t m, size_t from, size_t end,
                        const double *extra);
/* Forces of stresses along the layers in planes from .. end - 1 := 0; less what rows of pulls along each slot make of
 * them in row j of plane k, with the weights of value and slope over depth. */
void general_layers_forget(const struct consistent *c, size_t from, size_t end);
void general_layers_keep(const struct consistent *c, size_t component, size_t j, size_t k, double value,
                         double slope, const double *const pull[3]);
/* Their own part of the forces. */
void general_layers_pull(const struct consistent *c, const double *extra, double *force);
/* Memory at the start: of the forces of u. */
void general_layers_start(struct consistent *c, const double *u, double *extra);
/* As pml_remember(); leaves the forces at the step's end (made). */
void general_layers_remember(struct consistent *c, double dt, double to_middle, const double *u,
                             const double *v, double *extra);

/* edges.c: what is added at edges, the weights and, once the families have moduli, the points. False: no memory. */
bool general_lay_edges(struct consistent *c);
bool general_lay_edge_points(struct consistent *c);
void general_free_edges(struct consistent *c);
/* Added weight of a point, without the map's Jacobian. */
double general_added(const struct consistent *c, const enum at at[3], const size_t place[3]);
/* stress += that of slopes [component][slot] along the axes, times the weight of the point. */
void general_edge_stress(const struct edge_point *point, double slope[3][3], double stress[3][3]);
/* Adds -K u of these points in planes from .. end - 1. */
void general_edges(const struct consistent *c, const double *u, size_t from, size_t end, double *force);

/* material.c: lays moduli at the points, those of a part of damped ground too, and the mass of each control value.
 * False: no memory. */
bool general_material(struct consistent *c, double *mass);
/* Weight of a point, with the map's Jacobian. */
double general_weight(const struct consistent *c, const struct family *family, const size_t at[3]);

/* stiffness.c: is the solid at a point of a family not isotropic? */
bool general_is_turned(const struct family *family, const size_t at[3]);
/* Adds its C, times the weight of the point, in Voigt's order of the slots. */
void general_add_stiffness(const struct family *family, const size_t at[3], double factor,
                           double stiffness[STRESSES][STRESSES]);

/* hill.c: false: no memory. */
bool general_lay_hill(struct consistent *c);
void general_free_hill(struct consistent *c);
/* Metric at any point; at points of a family. */
struct metric general_metric_of(const struct consistent *c, const enum at at[3], const size_t place[3]);
struct metric general_metric_at(const struct consistent *c, const struct family *family, size_t i, size_t j,
                                size_t k);
/* Row j of points in plane k as the kernels take it; false: it is level. */
bool general_hill_row(const struct consistent *c, const struct family *family, size_t j, size_t k,
                      struct hill_row *row);

/* scaling.c: R from the mass of each control value (G5), by all ranks together; false: no memory. */
bool general_scale(struct consistent *c, const double *mass);

#endif
