/* The smoothed point method as published by Ding, Wu, Long & Liang (2006), with its misprints corrected:
 * what its files share. doc/theory/paper-method.md has the equations; numbers in the comments are the paper's.
 *
 * Unknowns are the components of u at the points in deck coordinates: u[dimension * point + component]. */
#ifndef SELAS_METHOD_PAPER_PAPER_H
#define SELAS_METHOD_PAPER_PAPER_H

#include "kernel/kernel.h"
#include "model/model.h"
#include "points/lattice.h"
#include "points/neighbours.h"

struct paper_options {
    const struct kernel *kernel;
    double smoothing_length; /* h in spacings */
    bool volume_factors;     /* F^V of Eqs 24, 25 */
    bool area_factors;       /* F^A of Eqs 26, 27 */
    bool kernel_correction;  /* alpha of Eqs 28, 29 for boundary points */
    bool boundary_term;      /* Gamma of Eqs 15, 22 */
    bool zero_row_sums;      /* K (u_b - u_a) in place of K u_b: constants give no force */
    bool load_distributed;   /* Eq 19 as sum of W_ab A_b T_b at every point; false: T_a sum of W_ab A_b */
    bool patch_overlap;      /* the patch carries its own area; false: whole points inside the closed patch */
    double filter;           /* alpha of Eq 35; 0 = none */
    bool filter_increment;   /* Eq 35 on u(n+1) - u(n); false: on u(n+1) as printed */
    bool deconvolution;      /* Eq 38 for what is recorded */
};

/* Part of a face that belongs to one of its points. */
struct surface_element {
    uint32_t point;
    enum face face;
    double normal[3]; /* outward, deck coordinates */
    double area;      /* statistical area, Eq 27 */
};

/* Lysmer-Kuhlemeyer dampers of one point, Eqs 31-33: rho times this dim x dim matrix times v is the force
 * per volume. */
struct damper {
    size_t point;
    double matrix[9];
};

/* Components along the body's axes that boundaries prescribe at one point. */
struct constraint {
    size_t point;
    bool held[3];
    enum face face[3]; /* whose motion drives it */
    double factor[3];  /* times motion[face] is the acceleration; 0 at rest */
};

/* One load made ready: tractions on surface elements or accelerations at points. */
struct paper_load {
    size_t elements; /* traction: elements of its face */
    size_t *element; /* [elements] */
    double *share;   /* [elements]: traction of the element per unit of history */
    size_t points;   /* body force, moment tensor: points that feel it */
    size_t *point;   /* [points] */
    double *push;    /* [dimension * points]: force per volume per unit of history */
};

struct paper {
    struct model model; /* first, so that a model pointer is a paper pointer */
    struct paper_options options;
    const struct material *material;
    int dimension;
    double h;
    struct point_set set;
    struct neighbours near; /* pairs within the support, each point among its own */
    double *volume;         /* [points], Eq 25 */
    double *alpha;          /* [points], Eq 29 (1 inside) */
    double *whole;          /* [points]: alpha_a times the sum of W_ab V_b */
    double *kernel_volume;  /* [pairs]: W_ab V_b without alpha */
    double *block;          /* [dimension^2 * pairs]: row a, column b of K V + Gamma A */

    size_t elements;
    struct surface_element *element; /* [elements], by point, then face */
    size_t *first_element;           /* [points + 1] */
    double face_normal[BOX_FACES][3];

    size_t *load_start;      /* [points + 1]: rows of Eq 19 */
    uint32_t *load_element;  /* element that loads the point */
    double *load_value;      /* alpha_a W_ab A_b */
    double *traction;        /* [3 * elements] scratch: tractions of this instant */
    struct paper_load *load; /* [scene->loads] */

    size_t dampers, constraints;
    struct damper *damper;
    struct constraint *constraint;
    bool *told;      /* [points]: faces prescribe all components */
    double *scratch; /* [unknowns] for the filter */
};

/* Builds the model with these options (its method reads them from the deck). */
selas_status paper_create(const struct scene *scene, const struct paper_options *options,
                          struct model **model, struct messages *messages);
struct paper_options paper_options_default(void);
/* Options from the names of &method (method/paper/options.c). */
selas_status paper_options_read(const struct scene *scene, struct paper_options *options,
                                struct messages *messages);
extern const struct method method_paper;

/* The parts of create, in this order; each leaves what it took in `paper` for paper_destroy. */
selas_status paper_make_elements(struct paper *paper, struct messages *messages);
selas_status paper_make_statistics(struct paper *paper, struct messages *messages);
selas_status paper_make_operator(struct paper *paper, struct messages *messages);
selas_status paper_make_boundary(struct paper *paper, struct messages *messages);
/* Replaces the held components of the constraint's point in `field` (body's axes) by those of `wanted`. */
void paper_hold(const struct paper *paper, const struct constraint *constraint, const double wanted[3],
                double *field);
void paper_initialise(struct model *model, double *y);
selas_status paper_make_loads(struct paper *paper, struct messages *messages);
void paper_free_loads(struct paper *paper);

/* alpha_a times the sum of W_ab A_b over the points of one face; 0 where a does not see the face. */
double paper_face_sum(const struct paper *paper, size_t point, enum face face);
/* Adds the loads of this instant to the force per volume: fills paper->traction, then point forces into a.
 * Returns whether there is any traction. */
bool paper_tractions(struct paper *paper, const struct drive *drive);
void paper_point_loads(const struct paper *paper, const struct drive *drive, double *force);

/* What is seen of the state (method/paper/observe.c). */
selas_status paper_probe(struct model *model, const double position[3], struct probe *probe,
                         struct messages *messages);
void paper_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                 size_t end, double *value);
void paper_energy(struct model *model, const double *y, struct energy *energy);
void paper_power(struct model *model, const struct drive *drive, const double *y, double *load,
                 double *absorbed);
void paper_describe(const struct model *model,
                    void (*tell)(void *context, const char *key, const char *value), void *context);

#endif
