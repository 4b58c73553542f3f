/* Moment tensors in averaged ground (doc/theory/general-ground.md, section 6). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_GLUT_H
#define SELAS_METHOD_CONSISTENT_GENERAL_GLUT_H

#include "method/consistent/general/general.h"

/* Stresses along an interface in plane strain (G24): 2 mu, 2 mu lambda / M, lambda / M. */
enum along { ALONG_SHEAR, ALONG_SPREAD, ALONG_RATIO, ALONGS };

/* A moment tensor beside an interface. */
struct glut {
    const struct consistent *c;
    double centre[3]; /* by axis, of the lattice */
    int across;       /* the axis nearest to the interface's normal */
    double spacing;   /* along it */
    bool surface;     /* normal is that of a surface on which the rock is the same ... */
    double away;      /* ... so many spacings from the source */
    bool beneath;     /* the source is right below a free face, where the axis across begins, ... */
    struct consistent_face face; /* ... and the rock changes along its normal alone */
    double normal[3];            /* by slot, as all that follows */
    double lambda, mu;           /* at the source */
    double strain[3][3];         /* Gamma (G21); of a displacement that of (G30) */
    double tangent[3][3];        /* what is left of M for strains along the interface */
    double slip[3];              /* the part of M n along the interface, over mu */
    double lag, press, slack;    /* (G23), E_M and E_r of (G30): lengths, over stresses but for the last */
    double stay[ALONGS];         /* (G24): lengths times stresses */
    bool plain, half;      /* a displacement is read: by the splines' values; halved on symmetry planes */
    bool seen;             /* a strain is read: ranks have few planes beside it */
    double *share;         /* [knots] of the axis across (G22) */
    double *line[4][3][3]; /* [count] by component and direction; 1 + axis: to be differentiated along it */
    double *row[2];        /* [largest count] work */
};

/* Together. What lies beside an interface acts by (G21) to (G25); `moment` keeps the part of strains along it. */
moment_beside general_add_glut;
moment_beside general_add_seen; /* what reads M : eps there */
/* glut.c: lines, all 0, and work. To be freed; NULL: no memory. */
double *glut_room(struct glut *glut, double *work[3]);
void glut_clear(struct glut *glut); /* lines := 0 */
/* Adds the stress of `strain` at the points, by their shares (G22), to the lines; of a moment tensor (G25) too. */
void glut_add_points(struct glut *glut, double *const work[3]);
/* Adds `share` of a stress, by slot, at x of the axis across to a set of lines. */
void glut_add_stress(struct glut *glut, int set, double x, double share, double stress[3][3]);
/* Adds products of a set's lines across with those along the interface. */
void glut_add_lines(struct glut *glut, int set, double *const work[3], struct dense *field);

static inline double glut_spacing(const struct spline *spline)
{
    return (spline->high - spline->low) / (double)spline->cells;
}
/* rise.c: sets normal and across. False: the rock is the same all about the source, or a symmetry plane is near. */
bool general_find_normal(struct glut *glut);
/* traction.c: the eigenvector of the largest eigenvalue, by squares of squares, of a matrix without negative ones,
 * which is used up. False: all are 0. */
bool general_steepest(double turn[3][3], double normal[3]);
/* settle.c: adds what makes the forces of the moment (by slot) right in ground that varies along the normal alone
 * (G28). False: no memory. */
bool general_settle(const struct glut *glut, const struct load *load, double moment[3][3],
                    struct dense *field);
/* lag.c: sets lag and stay; of a displacement lag, press and slack. */
void general_find_lag(struct glut *glut);

#endif
