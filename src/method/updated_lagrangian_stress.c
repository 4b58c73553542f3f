/* Artificial stress against the tensile instability (Gray, Monaghan & Swift 2001; He & Seaid 2016, Eqs
 * 20-23): in the principal axes R = -epsilon s / rho^2 where s > 0 (tension), 0 where s <= 0. In other words
 * R is -epsilon times the positive part of the tensor s / rho^2, which needs no angle. */
#include "method/updated_lagrangian.h"

#include <math.h>

static double positive(double x)
{
    return x > 0 ? x : 0;
}

/* Eigenvalues mean +- radius with the eigentensors (I +- D / radius) / 2, D the deviator. */
static void in_the_plane(double epsilon, const double *t, double *r)
{
    const double mean = (t[0] + t[1]) / 2, half = (t[0] - t[1]) / 2, radius = sqrt(half * half + t[2] * t[2]);
    const double first = positive(mean + radius), second = positive(mean - radius);
    const double sum = -epsilon * (first + second) / 2;
    const double difference = radius > 0 ? -epsilon * (first - second) / (2 * radius) : 0;
    r[0] = sum + difference * half;
    r[1] = sum - difference * half;
    r[2] = difference * t[2];
}

/* One Jacobi rotation of a in the plane (p, q), gathered in v. */
static void rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (a[p][q] == 0) return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(1 + theta * theta));
    const double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (int k = 0; k < 3; k++) {
        const double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
        const double kp = v[k][p], kq = v[k][q];
        v[k][p] = c * kp - s * kq;
        v[k][q] = s * kp + c * kq;
    }
}

static void in_space(double epsilon, const double *t, double *r)
{
    enum { SWEEPS = 6 }; /* convergence is quadratic: 4 reach rounding */
    double a[3][3] = {{t[0], t[3], t[5]}, {t[3], t[1], t[4]}, {t[5], t[4], t[2]}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    for (int s = 0; s < 6; s++) {
        r[s] = 0;
        for (int k = 0; k < 3; k++)
            r[s] -= epsilon * positive(a[k][k]) * v[row[s]][k] * v[column[s]][k];
    }
}

void updated_artificial_stress(int dimension, double epsilon, const double *tension, double *repulsion)
{
    if (dimension == 1)
        repulsion[0] = -epsilon * positive(tension[0]);
    else if (dimension == 2)
        in_the_plane(epsilon, tension, repulsion);
    else
        in_space(epsilon, tension, repulsion);
}
