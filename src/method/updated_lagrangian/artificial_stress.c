/* Artificial stress against the tensile instability (Gray, Monaghan & Swift 2001; He & Seaid 2016, Eqs
 * 20-23): in the principal axes R = -epsilon s / rho^2 where s > 0 (tension), 0 where s <= 0. In other words
 * R is -epsilon times the positive part of the tensor s / rho^2, which needs no angle. One tensor in each
 * lane of a vector, UPDATED_TENSORS at a time: a rotation is a long chain of operations that wait for each other. Each
 * tensor stops turning when it is diagonal, whichever others go with it. */
#include "base/machine.h"
#include "base/vectors.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

#include <float.h>

enum { GROUPS = UPDATED_TENSORS / LANES };

INLINED void positive(const lanes *x, lanes *result)
{
    *result = WHERE(*x > 0, *x);
}

/* Eigenvalues mean +- radius with the eigentensors (I +- D / radius) / 2, D the deviator. */
INLINED void in_the_plane(double epsilon, const lanes *t, lanes *r)
{
    const lanes mean = (t[0] + t[1]) / 2, half = (t[0] - t[1]) / 2, square = half * half + t[2] * t[2];
    lanes radius, first, second;
    lanes_root(&square, &radius);
    const lanes high = mean + radius, low = mean - radius;
    positive(&high, &first);
    positive(&low, &second);
    const lanes sum = -epsilon * (first + second) / 2;
    /* without a radius half and t[2] are 0 as well */
    const lanes difference = -epsilon * (first - second) / (2 * radius + DBL_MIN);
    r[0] = sum + difference * half;
    r[1] = sum - difference * half;
    r[2] = difference * t[2];
}

/* One Jacobi rotation of a in the plane (p, q), in the lanes that turn, gathered in v: t = tan of the angle is the
 * smaller root of t^2 + 2 theta t = 1, theta = (a_qq - a_pp) / (2 a_pq), here without dividing by a_pq. */
INLINED void rotate(lanes a[3][3], lanes v[3][3], const lanes_mask *turns, const int p, const int q)
{
    const int k = 3 - p - q; /* the third axis */
    const lanes none = {0}, across = 2 * a[p][q], apart = a[q][q] - a[p][p];
    const lanes square = across * across + apart * apart;
    lanes root, size;
    lanes_root(&square, &root);
    const lanes magnitude = apart - 2 * WHERE(apart < 0, apart);
    const lanes angle = (across - 2 * WHERE(apart < 0, across)) / (magnitude + root + DBL_MIN);
    const lanes t = WHERE(*turns, angle);
    const lanes secant = 1 + t * t;
    lanes_root(&secant, &size);
    const lanes c = 1 / size, s = t * c, moved = t * a[p][q];
    a[p][p] -= moved;
    a[q][q] += moved;
    a[p][q] = a[q][p] = none;
    const lanes kp = a[k][p], kq = a[k][q];
    a[k][p] = a[p][k] = c * kp - s * kq;
    a[k][q] = a[q][k] = s * kp + c * kq;
    for (int m = 0; m < 3; m++) {
        const lanes mp = v[m][p], mq = v[m][q];
        v[m][p] = c * mp - s * mq;
        v[m][q] = s * mp + c * mq;
    }
}

/* In which lanes what stands beside the diagonal still counts; none: true. */
INLINED bool are_diagonal(lanes a[GROUPS][3][3], lanes_mask turns[GROUPS])
{
    lanes_mask more = {0};
    for (int g = 0; g < GROUPS; g++) {
        lanes(*m)[3] = a[g];
        const lanes beside = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        const lanes along = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
        turns[g] = (lanes_mask)(beside > 1e-36 * along);
        more |= turns[g];
    }
    long long any = 0;
    for (int n = 0; n < LANES; n++)
        any |= more[n];
    return any == 0;
}

INLINED void in_space(double epsilon, lanes t[GROUPS][6], lanes r[GROUPS][6])
{
    enum { SWEEPS = 6 }; /* convergence is quadratic: 4 reach rounding */
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    const lanes none = {0}, one = none + 1;
    lanes a[GROUPS][3][3], v[GROUPS][3][3];
    lanes_mask turns[GROUPS];
    for (int g = 0; g < GROUPS; g++)
        for (int s = 0; s < 6; s++) {
            a[g][row[s]][column[s]] = a[g][column[s]][row[s]] = t[g][s];
            v[g][row[s]][column[s]] = v[g][column[s]][row[s]] = s < 3 ? one : none;
        }
    for (int sweep = 0; sweep < SWEEPS && !are_diagonal(a, turns); sweep++) {
        for (int g = 0; g < GROUPS; g++)
            rotate(a[g], v[g], &turns[g], 0, 1);
        for (int g = 0; g < GROUPS; g++)
            rotate(a[g], v[g], &turns[g], 0, 2);
        for (int g = 0; g < GROUPS; g++)
            rotate(a[g], v[g], &turns[g], 1, 2);
    }
    for (int g = 0; g < GROUPS; g++) {
        lanes value[3];
        for (int k = 0; k < 3; k++) {
            positive(&a[g][k][k], &value[k]);
            value[k] *= -epsilon;
        }
        for (int s = 0; s < 6; s++)
            r[g][s] = value[0] * v[g][row[s]][0] * v[g][column[s]][0] +
                      value[1] * v[g][row[s]][1] * v[g][column[s]][1] +
                      value[2] * v[g][row[s]][2] * v[g][column[s]][2];
    }
}

static void artificial_stress(int dimension, double epsilon, size_t stride, const double *tension,
                              double *repulsion)
{
    const size_t stresses = (size_t)(dimension * (dimension + 1) / 2);
    lanes t[GROUPS][6], r[GROUPS][6];
    for (size_t g = 0; g < GROUPS; g++)
        for (size_t s = 0; s < stresses; s++)
            t[g][s] = AT(tension + stride * s + LANES * g);
    for (int g = 0; g < GROUPS && dimension < 3; g++)
        if (dimension == 1) {
            positive(&t[g][0], &r[g][0]);
            r[g][0] *= -epsilon;
        } else {
            in_the_plane(epsilon, t[g], r[g]);
        }
    if (dimension == 3) in_space(epsilon, t, r);
    for (size_t g = 0; g < GROUPS; g++)
        for (size_t s = 0; s < stresses; s++)
            memcpy(repulsion + stride * s + LANES * g, &r[g][s], sizeof r[g][s]);
}

const struct updated_stresses OF_PROCESSOR(updated_stresses) = {artificial_stress};
