/* Hyperelastic laws: first Piola-Kirchhoff stress P(H) and energy per reference volume, H = grad u. */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_ELASTIC_LAW_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_ELASTIC_LAW_H

#include "scene/scene.h"

enum elastic_law { ELASTIC_LAWS(CHOICE_SYMBOL) };

struct elastic {
    enum elastic_law law;
    int dimension;
    bool thin;           /* plane stress (2D) or a thin bar (1D): no stress across */
    double lambda, mu;   /* of the solid */
    double plane_lambda; /* of Hooke's law in the scene's dimension */
};

struct elastic elastic_of(const struct material *material, enum elastic_law law, int dimension,
                          enum plane plane);

/* Tensors are row-major dimension x dimension: H[a * dimension + b] = d u_a / d X_b. */
void elastic_stress(const struct elastic *elastic, const double *H, double *P);
double elastic_energy(const struct elastic *elastic, const double *H);
/* Cauchy stress xx yy zz xy yz zx in the body's frame, and the (Green or small) strain; across-thickness
 * components included. */
void elastic_observe(const struct elastic *elastic, const double *H, double stress[6], double strain[6]);

const char *elastic_law_name(enum elastic_law law);

#endif
