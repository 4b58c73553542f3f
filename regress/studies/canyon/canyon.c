/* Exact histories of a canyon in two dimensions (P-SV): a line force in a half-space whose surface lies at z = H exp(-x^2 / (2 W^2)),
 * z downwards, by the indirect boundary element method of F. J. Sanchez-Sesma and M. Campillo (Bull. Seism. Soc. Am. 81
 * (1991) 2234). Shares nothing with selas (doc/theory/topography.md, section 5). At the distance r from a line force,
 * in the direction e, time as exp(i omega t), with b_n = H_n(omega r / c_p) / c_p^2, s_n = H_n(omega r / c_s) / c_s^2,
 * Hankel's functions of the second kind,
 *
 *   G_ij = f delta_ij + g e_i e_j,   f = (b_0 + s_0 + b_2 - s_2) / (8 i rho),   g = -(b_2 - s_2) / (4 i rho),       (1)
 *
 * on a surface with the normal n, a = e.n,
 *
 *   T_ij = lambda n_i e_j (f' + g' + g/r)
 *        + mu [(f' + g/r) (a delta_ij + e_i n_j) + 2 g/r n_i e_j + 2 (g' - 2 g/r) a e_i e_j].                       (2)
 *
 * Forces phi along the surface S free it of the tractions of the force F at x_0, n outwards:
 *
 *   phi_i / 2 + PV int over S of T_ij phi_j dS = -T_ij(x, x_0) F_j,   u_i = G_ij F_j + int over S of G_ij phi_j dS. (3)
 *
 * Nodes x_k = k d along x, J dx = dS. The principal value takes the nodes at odd distances with the weight 2 d J (A.
 * Sidi and M. Israeli, J. Sci. Comput. 3 (1988) 201). The logarithm of G in u at a node: its own node at the distance
 * r = d J / (2 pi) along S, from
 *
 *   int log|t| q(t) dt = d sum over k != 0 of log|t_k| q_k + d q_0 log(d / (2 pi)) + O(d^3).                        (4)
 *
 * Errors of d^3 are taken away by d and 2 d: velocities at d = .05 and .025 differ by .0006 at most. omega = 2 pi k /
 * 20 - .6 i leaves exp(-12) of what comes later than 20; what S lacks beyond |x| = 7.2 cannot reach a receiver before
 * t = 8.
 *
 *   canyon FOLDER HEIGHT WIDTH SPACING [air]     writes FOLDER/NAME.dat for each receiver: t ux uz 0 vx vz 0
 *
 * With `air` the tractions of a force in the air above the canyon act on the surface in place of the force in the ground: its
 * field is then that of the full space, and the largest error, relative to each receiver's largest value, is printed. */
#include <complex.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double density = 1, lambda = 1, mu = 1;
static const double pulse = .35, delay = 1.75; /* standard deviation and peak of the force's Gaussian */
static const double force[2] = {.6, .8};
static const double period = 20, damping = .6; /* frequencies are 2 pi k / period - i damping */
static const double reach = 7.2;               /* the surface ends at x = -reach and reach */
static const double last = 8, every = .1;      /* of the histories */

struct receiver {
    const char *name;
    double x;
    double depth; /* below the surface */
};
static const struct receiver receivers[] = {{"near", -1, 0},    {"flank", -.6, 0}, {"bottom", 0, 0},
                                            {"beneath", 0, .6}, {"across", .6, 0}, {"rim", 1, 0},
                                            {"beyond", 2, 0}};
enum { RECEIVERS = sizeof receivers / sizeof *receivers };

struct surface {
    double height, width, spacing;
    size_t count;
};

struct node {
    double place[2], normal[2], length;
};

static struct node node_at(const struct surface *surface, double x)
{
    const double bell = surface->height * exp(-x * x / (2 * surface->width * surface->width));
    const double slope = -x / (surface->width * surface->width) * bell, length = hypot(1, slope);
    return (struct node){{x, bell}, {slope / length, -1 / length}, surface->spacing * length};
}

static struct node node_of(const struct surface *surface, size_t i)
{
    return node_at(surface, surface->spacing * (double)i - reach);
}

/* H_0 and H_1 of the second kind: power series up to |z| = 12, the asymptotic one beyond (either to 1e-10). */
static void hankel(double complex z, double complex h[2])
{
    if (cabs(z) < 12) {
        const double complex quarter = -z * z / 4, logarithm = clog(z / 2) + .57721566490153286;
        double complex term = 1, j0 = 0, j1 = 0, y0 = 0, y1 = 0;
        double sum = 0; /* 1 + 1/2 + ... + 1/k */
        for (int k = 0; k < 60; k++) {
            j0 += term;
            y0 -= term * sum;
            j1 += term / (k + 1);
            y1 -= term / (k + 1) * (sum + .5 / (k + 1));
            sum += 1. / (k + 1);
            term *= quarter / ((k + 1) * (double)(k + 1));
        }
        h[0] = j0 - I * 2 / M_PI * (logarithm * j0 + y0);
        h[1] = z / 2 * j1 - I * 2 / M_PI * (-1 / z + z / 2 * (logarithm * j1 + y1));
        return;
    }
    for (int n = 0; n < 2; n++) {
        double complex sum = 0, term = 1;
        double least = INFINITY;
        for (int k = 0; k < 60 && cabs(term) < least; k++) {
            sum += term;
            least = cabs(term);
            term *= -I * (4. * n * n - (2. * k + 1) * (2 * k + 1)) / ((k + 1) * 8. * z);
        }
        h[n] = csqrt(2 / (M_PI * z)) * cexp(-I * (z - (2 * n + 1) * M_PI / 4)) * sum;
    }
}

/* G_ij = f delta_ij + g e_i e_j at the distance r from a line force, with f' and g' (1). */
struct green {
    double complex f, g, df, dg;
};

static struct green green_at(double complex omega, double r)
{
    struct green green = {0};
    const double speed[2] = {sqrt((lambda + 2 * mu) / density), sqrt(mu / density)};
    const double complex scale = 1 / (8 * I * density);
    for (int wave = 0; wave < 2; wave++) {
        const double complex k = omega / speed[wave], z = k * r;
        double complex h[2];
        hankel(z, h);
        const double complex h2 = 2 * h[1] / z - h[0], dh2 = k * (h[1] - 2 * h2 / z);
        const double complex part = scale / (speed[wave] * speed[wave]), sign = wave == 0 ? part : -part;
        green.f += part * h[0] + sign * h2;
        green.df += -part * k * h[1] + sign * dh2;
        green.g -= 2 * sign * h2;
        green.dg -= 2 * sign * dh2;
    }
    return green;
}

/* Displacement i (1), and traction i on the normal if there is one (2), at `to` under a force along j at `from`. */
static void field(double complex omega, const double from[2], const double to[2], const double *normal,
                  double complex out[2][2])
{
    const double away[2] = {to[0] - from[0], to[1] - from[1]}, r = hypot(away[0], away[1]);
    const double e[2] = {away[0] / r, away[1] / r};
    const struct green w = green_at(omega, r);
    const double along = normal == NULL ? 0 : e[0] * normal[0] + e[1] * normal[1];
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            const double same = i == j;
            if (normal == NULL) {
                out[i][j] = w.f * same + w.g * e[i] * e[j];
                continue;
            }
            const double complex spread = e[j] * (w.df + w.dg + w.g / r), twist = w.df + w.g / r;
            out[i][j] = lambda * normal[i] * spread +
                        mu * (twist * (same * along + e[i] * normal[j]) + 2 * w.g / r * e[j] * normal[i] +
                              2 * (w.dg - 2 * w.g / r) * e[i] * e[j] * along);
        }
    }
}

static void from_force(double complex omega, const double at[2], const struct node *to, bool traction,
                       double complex u[2])
{
    double complex g[2][2];
    field(omega, at, to->place, traction ? to->normal : NULL, g);
    for (int i = 0; i < 2; i++)
        u[i] = g[i][0] * force[0] + g[i][1] * force[1];
}

/* Forces along the surface that free it of the tractions `from_force` leaves: phi / 2 + PV int T phi = -t (3). */
static void densities(const struct surface *surface, double complex omega, const double at[2], double sign,
                      gsl_vector_complex *phi)
{
    const size_t n = surface->count;
    gsl_matrix_complex *matrix = gsl_matrix_complex_calloc(2 * n, 2 * n);
    gsl_vector_complex *right = gsl_vector_complex_alloc(2 * n);
    for (size_t row = 0; row < n; row++) {
        const struct node to = node_of(surface, row);
        double complex t[2], g[2][2];
        from_force(omega, at, &to, true, t);
        for (size_t i = 0; i < 2; i++) {
            gsl_vector_complex_set(right, 2 * row + i,
                                   gsl_complex_rect(sign * creal(t[i]), sign * cimag(t[i])));
            gsl_matrix_complex_set(matrix, 2 * row + i, 2 * row + i, gsl_complex_rect(.5, 0));
        }
        for (size_t column = 1 - row % 2; column < n; column += 2) { /* the others have no weight */
            const struct node from = node_of(surface, column);
            field(omega, from.place, to.place, to.normal, g);
            for (size_t i = 0; i < 2; i++)
                for (size_t j = 0; j < 2; j++) {
                    const double complex value = 2 * from.length * g[i][j];
                    gsl_matrix_complex_set(matrix, 2 * row + i, 2 * column + j,
                                           gsl_complex_rect(creal(value), cimag(value)));
                }
        }
    }
    gsl_permutation *order = gsl_permutation_alloc(2 * n);
    int parity;
    gsl_linalg_complex_LU_decomp(matrix, order, &parity);
    gsl_linalg_complex_LU_solve(matrix, order, right, phi);
    gsl_permutation_free(order);
    gsl_vector_complex_free(right);
    gsl_matrix_complex_free(matrix);
}

static void add_surface(const struct surface *surface, double complex omega, const gsl_vector_complex *phi,
                        const struct node *to, double complex u[2])
{
    for (size_t column = 0; column < surface->count; column++) {
        const struct node from = node_of(surface, column);
        double place[2] = {from.place[0], from.place[1]};
        if (hypot(place[0] - to->place[0], place[1] - to->place[1]) < 1e-9) { /* (4) */
            place[0] -= to->normal[1] * from.length / (2 * M_PI);
            place[1] += to->normal[0] * from.length / (2 * M_PI);
        }
        double complex g[2][2];
        field(omega, place, to->place, NULL, g);
        for (size_t i = 0; i < 2; i++)
            for (size_t j = 0; j < 2; j++) {
                const gsl_complex value = gsl_vector_complex_get(phi, 2 * column + j);
                u[i] += from.length * g[i][j] * (GSL_REAL(value) + I * GSL_IMAG(value));
            }
    }
}

/* Adds one frequency's part of u and v at all times. */
static void add_times(double complex omega, const double complex u[2], double weight, double (*history)[4])
{
    const double complex spectrum = pulse * sqrt(2 * M_PI) *
                                    cexp(-omega * omega * pulse * pulse / 2 - I * omega * delay) * weight /
                                    period;
    for (int row = 0; every * row <= last + 1e-9; row++)
        for (int i = 0; i < 2; i++) {
            const double complex part = spectrum * u[i] * cexp(I * omega * every * row);
            history[row][i] += creal(part);
            history[row][2 + i] += creal(I * omega * part);
        }
}

static struct node place_of(const struct surface *surface, const struct receiver *receiver)
{
    struct node node = node_at(surface, receiver->x);
    node.place[1] += receiver->depth;
    return node;
}

enum { ROWS = 100 };
static double wanted[RECEIVERS][ROWS][4], direct[RECEIVERS][ROWS][4];

/* Adds `share` of the histories. */
static void solve(const struct surface *surface, bool air, double share)
{
    const double ground[2] = {-1.5, 1}, above[2] = {.1, -.2}, *at = air ? above : ground;
    gsl_vector_complex *phi = gsl_vector_complex_alloc(2 * surface->count);
    for (int k = 0; 2 * M_PI * k / period < 6.2 / pulse; k++) { /* exp(-6.2^2 / 2) = 4e-9 */
        const double complex omega = 2 * M_PI * k / period - I * damping;
        const double weight = k == 0 ? 1 : 2;
        densities(surface, omega, at, air ? 1 : -1, phi);
        for (int r = 0; r < RECEIVERS; r++) {
            const struct node to = place_of(surface, &receivers[r]);
            double complex own[2], u[2] = {0};
            from_force(omega, at, &to, false, own);
            add_surface(surface, omega, phi, &to, u);
            for (int i = 0; i < 2 && !air; i++)
                u[i] += own[i];
            add_times(omega, u, share * weight, wanted[r]);
            add_times(omega, own, share * weight, direct[r]);
        }
    }
    gsl_vector_complex_free(phi);
}

static void compare(void)
{
    for (int r = 0; r < RECEIVERS; r++)
        for (int part = 0; part < 4; part += 2) {
            double off = 0, most = 0;
            for (int row = 0; every * row <= last + 1e-9; row++)
                for (int i = part; i < part + 2; i++) {
                    off = fmax(off, fabs(wanted[r][row][i] - direct[r][row][i]));
                    most = fmax(most, fabs(direct[r][row][i]));
                }
            printf("%s %s: %.1e\n", receivers[r].name, part == 0 ? "displacement" : "velocity", off / most);
        }
}

static bool write_histories(const char *folder, const char *words)
{
    for (int r = 0; r < RECEIVERS; r++) {
        char path[400];
        (void)snprintf(path, sizeof path, "%s/%s.dat", folder, receivers[r].name);
        FILE *file = fopen(path, "w");
        if (file == NULL) return false;
        (void)fprintf(file, "# %s: build/test/canyon FOLDER %s\n# t ux uz 0 vx vz 0\n", receivers[r].name,
                      words);
        for (int row = 0; every * row <= last + 1e-9; row++) {
            const double *h = wanted[r][row];
            (void)fprintf(file, "%.1f %.6e %.6e 0 %.6e %.6e 0\n", every * row, h[0], h[1], h[2], h[3]);
        }
        if (fclose(file) != 0) return false;
    }
    return true;
}

int main(int count, char **words)
{
    if (count < 5) {
        (void)fprintf(stderr, "usage: canyon FOLDER HEIGHT WIDTH SPACING [air]\n");
        return 2;
    }
    const bool air = count > 5 && strcmp(words[5], "air") == 0;
    for (int coarse = 0; coarse < 2;
         coarse++) { /* errors fall as the third power: 8/7 and -1/7 take the first away */
        struct surface surface = {atof(words[2]), atof(words[3]), atof(words[4]) * (1 + coarse), 0};
        surface.count = 2 * (size_t)lround(reach / surface.spacing) + 1;
        solve(&surface, air, coarse == 0 ? 8 / 7. : -1 / 7.);
    }
    if (air) compare();
    char made_by[100];
    (void)snprintf(made_by, sizeof made_by, "%s %s %s%s", words[2], words[3], words[4], air ? " air" : "");
    if (!write_histories(words[1], made_by)) {
        perror(words[1]);
        return 1;
    }
    return 0;
}
