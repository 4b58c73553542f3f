/* Hyperelastic laws.
 *
 *   Hooke                    sigma = l tr(e) I + 2 mu e,   e = (H + H^T)/2
 *   Saint Venant-Kirchhoff   S = l tr(E) I + 2 mu E,   E = (H + H^T + H^T H)/2,   P = F S
 *   Neo-Hooke                psi = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2   (Bonet & Wood 2008, Eq 6.28)
 *
 * Here l is plane_lambda, which makes the stress across a thin plate or bar vanish (exactly: S is linear in E).
 * Neo-Hooke in thin bodies: the stretch f across follows from lambda ln J + mu (f^2 - 1) = 0. */
#include "method/total_lagrangian/elastic_law.h"

#include <math.h>
#include <string.h>

const char *elastic_law_name(enum elastic_law law)
{
    static const char *const names[] = {ELASTIC_LAWS(CHOICE_NAME)};
    return names[law];
}

struct elastic elastic_of(const struct material *material, enum elastic_law law, int dimension,
                          enum plane plane)
{
    return (struct elastic){.law = law,
                            .dimension = dimension,
                            .thin = dimension < 3 && plane == PLANE_STRESS,
                            .lambda = material->lambda,
                            .mu = material->mu,
                            .plane_lambda = material->plane_lambda};
}

/* Green's strain, or the small strain for Hooke's law. */
static void strain_of(const struct elastic *elastic, const double *H, double E[9])
{
    const int d = elastic->dimension;
    for (int a = 0; a < d; a++)
        for (int b = a; b < d; b++) {
            double sum = H[a * d + b] + H[b * d + a];
            if (elastic->law != LAW_LINEAR)
                for (int c = 0; c < d; c++)
                    sum += H[c * d + a] * H[c * d + b];
            E[a * d + b] = 0.5 * sum;
            E[b * d + a] = 0.5 * sum;
        }
}

static double trace(int d, const double *A)
{
    double sum = 0;
    for (int a = 0; a < d; a++)
        sum += A[a * d + a];
    return sum;
}

/* Inverse of F = I + H; returns its determinant. */
static double invert(int d, const double *H, double inverse[9])
{
    double F[9] = {0};
    for (int k = 0; k < d * d; k++)
        F[k] = H[k] + (k % (d + 1) == 0 ? 1 : 0);
    if (d == 1) {
        inverse[0] = 1 / F[0];
        return F[0];
    }
    if (d == 2) {
        const double J = F[0] * F[3] - F[1] * F[2];
        inverse[0] = F[3] / J;
        inverse[1] = -F[1] / J;
        inverse[2] = -F[2] / J;
        inverse[3] = F[0] / J;
        return J;
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const int a1 = (a + 1) % 3;
            const int a2 = (a + 2) % 3;
            const int b1 = (b + 1) % 3;
            const int b2 = (b + 2) % 3;
            inverse[b * 3 + a] = F[a1 * 3 + b1] * F[a2 * 3 + b2] - F[a1 * 3 + b2] * F[a2 * 3 + b1];
        }
    const double J = F[0] * inverse[0] + F[1] * inverse[3] + F[2] * inverse[6];
    for (int k = 0; k < 9; k++)
        inverse[k] /= J;
    return J;
}

/* ln of the stretch across: Newton for lambda (ln J + k x) + mu (exp(2 x) - 1) = 0, k directions across. */
static double across(const struct elastic *elastic, double log_J)
{
    if (!elastic->thin) return 0;
    const double k = 3 - elastic->dimension;
    double x = 0;
    for (int iteration = 0; iteration < 30; iteration++) {
        const double stretch = exp(2 * x);
        const double residual = elastic->lambda * (log_J + k * x) + elastic->mu * (stretch - 1);
        const double change = residual / (elastic->lambda * k + 2 * elastic->mu * stretch);
        x -= change;
        if (fabs(change) < 1e-15) break;
    }
    return x;
}

static void neo_hookean(const struct elastic *elastic, const double *H, double *P)
{
    const int d = elastic->dimension;
    double inverse[9];
    const double log_J = log(invert(d, H, inverse));
    const double pressure = elastic->lambda * (log_J + (3 - d) * across(elastic, log_J)) - elastic->mu;
    for (int a = 0; a < d; a++)
        for (int b = 0; b < d; b++)
            P[a * d + b] = elastic->mu * (H[a * d + b] + (a == b ? 1 : 0)) + pressure * inverse[b * d + a];
}

void elastic_stress(const struct elastic *elastic, const double *H, double *P)
{
    const int d = elastic->dimension;
    if (elastic->law == LAW_NEO_HOOKEAN) {
        neo_hookean(elastic, H, P);
        return;
    }
    double S[9];
    strain_of(elastic, H, S);
    const double pressure = elastic->plane_lambda * trace(d, S);
    for (int k = 0; k < d * d; k++)
        S[k] = 2 * elastic->mu * S[k] + (k % (d + 1) == 0 ? pressure : 0);
    for (int a = 0; a < d; a++)
        for (int b = 0; b < d; b++) {
            double sum = S[a * d + b];
            if (elastic->law != LAW_LINEAR)
                for (int c = 0; c < d; c++)
                    sum += H[a * d + c] * S[c * d + b];
            P[a * d + b] = sum;
        }
}

double elastic_energy(const struct elastic *elastic, const double *H)
{
    const int d = elastic->dimension;
    double E[9];
    if (elastic->law == LAW_NEO_HOOKEAN) {
        const double log_planar = log(invert(d, H, E));
        const double x = across(elastic, log_planar);
        const double log_J = log_planar + (3 - d) * x;
        /* tr C - 3 = 2 tr H + H:H + (3 - d)(exp(2 x) - 1) */
        double invariant = 2 * trace(d, H) + (3 - d) * expm1(2 * x);
        for (int k = 0; k < d * d; k++)
            invariant += H[k] * H[k];
        return 0.5 * elastic->mu * invariant - elastic->mu * log_J + 0.5 * elastic->lambda * log_J * log_J;
    }
    strain_of(elastic, H, E);
    double sum = 0;
    for (int k = 0; k < d * d; k++)
        sum += E[k] * E[k];
    const double dilatation = trace(d, E);
    return 0.5 * elastic->plane_lambda * dilatation * dilatation + elastic->mu * sum;
}

static void to_six(int d, const double *A, double six[6])
{
    static const int row[6] = {0, 1, 2, 0, 1, 2};
    static const int column[6] = {0, 1, 2, 1, 2, 0};
    for (int k = 0; k < 6; k++)
        six[k] =
            row[k] < d && column[k] < d ? 0.5 * (A[row[k] * d + column[k]] + A[column[k] * d + row[k]]) : 0;
}

void elastic_observe(const struct elastic *elastic, const double *H, double stress[6], double strain[6])
{
    const int d = elastic->dimension;
    double E[9];
    double P[9];
    double inverse[9];
    strain_of(elastic, H, E);
    to_six(d, E, strain);
    const double dilatation = trace(d, E);
    elastic_stress(elastic, H, P);
    const double J = elastic->law == LAW_LINEAR ? 1 : invert(d, H, inverse);
    double sigma[9] = {0};
    for (int a = 0; a < d; a++)
        for (int b = 0; b < d; b++) {
            double sum = P[a * d + b];
            if (elastic->law != LAW_LINEAR)
                for (int c = 0; c < d; c++)
                    sum += P[a * d + c] * H[b * d + c];
            sigma[a * d + b] = sum / J;
        }
    to_six(d, sigma, stress);
    /* across: a thin body strains (and its section shrinks), a thick one is stressed */
    const bool neo = elastic->law == LAW_NEO_HOOKEAN;
    for (int c = d; c < 3 && !elastic->thin; c++)
        stress[c] = elastic->lambda * (neo ? log(J) : dilatation) / J;
    if (!elastic->thin) return;
    const double contraction = -elastic->lambda / (elastic->lambda * (3 - d) + 2 * elastic->mu) * dilatation;
    const double across_strain = neo ? 0.5 * expm1(2 * across(elastic, log(J))) : contraction;
    for (int c = d; c < 3; c++)
        strain[c] = across_strain;
    const double section = elastic->law == LAW_LINEAR ? 1 : pow(1 + 2 * across_strain, 0.5 * (3 - d));
    for (int k = 0; k < 6; k++)
        stress[k] /= section;
}
