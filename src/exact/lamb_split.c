/* What is split off the half-space's response before the FFT because it converges badly there, and added in
 * closed form (doc/theory/lamb.md, Eqs 9, 10):
 *  - the static response (Boussinesq, Cerruti; Love 1929), f(t) times a constant: the slow end of the
 *    wavenumber integral;
 *  - the Rayleigh pole, for pulses with kinks: the slow end of the frequency integral. A step load gives
 *    Re of the same potentials at the complex depth decay z - i c_R t;
 *  - what begins at once, v = const f(t - z/c): the plane wave right under the patch, f(t - z/c)/(rho c), and
 *    what half a plane's load does at its own edge, a quarter's in its corner. */
#include "exact/gauss12.h"
#include "exact/lamb_fft.h"

#include <math.h>

enum { MOST_KINKS = 64 }; /* rows of a table that are worth closed forms */

bool lamb_split_rayleigh(const struct lamb_load *load)
{
    const struct history *history = load->history;
    if (load->traction[0] != 0 || load->traction[1] != 0 || load->patch.shape == PATCH_DISC) return false;
    if (history->smoothing > 0) return false;
    return history->kind == HISTORY_TRIANGLE || history->kind == HISTORY_STEP ||
           (history->kind == HISTORY_TABLE && history->rows <= MOST_KINKS);
}

/* Kink i of a piecewise linear history: changes of f' and f there; false if there is no kink i. */
static bool kink(const struct history *history, size_t i, double *time, double *slope, double *jump)
{
    *jump = 0;
    if (history->kind == HISTORY_TRIANGLE) {
        const double half = .5 * history->duration;
        *time = history->start + (double)i * half;
        *slope = (i == 1 ? -2 : 1) / half;
        return i < 3;
    }
    if (history->kind == HISTORY_STEP) {
        *time = history->start;
        *slope = 0;
        *jump = 1;
        return i < 1;
    }
    if (i >= history->rows) return false;
    const double *times = history->table_time, *values = history->table_value;
    *time = history->start + times[i];
    if (i == 0) *jump = values[0];
    *slope = 0;
    if (i + 1 < history->rows) *slope += (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
    if (i > 0) *slope -= (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
    return true;
}

/* Static displacement times 2 pi mu. */
static void static_response(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                            double z, double u[3])
{
    struct potentials p;
    patch_potentials(&load->patch, x, y, z, &p);
    const double nu = ground->poisson, half = .5 * z;
    const double fx = load->traction[0], fy = load->traction[1], fz = load->traction[2];
    u[0] = fz * creal(-(.5 - nu) * p.once_x - half * p.plain_x) +
           fx * creal(p.plain + nu * p.twice_xx - half * p.once_xx) +
           fy * creal(nu * p.twice_xy - half * p.once_xy);
    u[1] = fz * creal(-(.5 - nu) * p.once_y - half * p.plain_y) +
           fx * creal(nu * p.twice_xy - half * p.once_xy) +
           fy * creal(p.plain + nu * p.twice_yy - half * p.once_yy);
    u[2] = fz * creal((1 - nu) * p.plain + half * p.angle) +
           fx * creal((.5 - nu) * p.once_x - half * p.plain_x) +
           fy * creal((.5 - nu) * p.once_y - half * p.plain_y);
}

/* What a unit step load leaves in the Rayleigh pole after a long time, times 2 pi mu / fz. */
static void static_rayleigh(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                            double z, double u[3])
{
    const double decays[2] = {ground->p_decay, ground->s_decay};
    u[0] = u[1] = u[2] = 0;
    for (int wave = 0; wave < 2; wave++) {
        struct potentials p;
        patch_potentials(&load->patch, x, y, decays[wave] * z, &p);
        u[0] -= ground->horizontal_residue[wave] / ground->rayleigh * creal(p.once_x);
        u[1] -= ground->horizontal_residue[wave] / ground->rayleigh * creal(p.once_y);
        u[2] += ground->vertical_residue[wave] / ground->rayleigh * creal(p.plain);
    }
}

/* Response of the Rayleigh pole to a unit step (`step`), its rate and its integral over time, times
 * 2 pi mu / fz. With d = decay z and D = d - i c_R t: uz ~ plain(d) - Re plain(D), u_x ~ Re once_x(D) -
 * once_x(d). */
struct rayleigh {
    double rate[3], step[3], integral[3];
};

static void rayleigh_response(const struct half_space *ground, const struct lamb_load *load, double x,
                              double y, double z, double t, struct rayleigh *response)
{
    const double c = ground->rayleigh_speed, decays[2] = {ground->p_decay, ground->s_decay};
    *response = (struct rayleigh){0};
    for (int wave = 0; wave < 2; wave++) {
        const double d = decays[wave] * z;
        const double vertical = ground->vertical_residue[wave] / ground->rayleigh;
        const double horizontal = ground->horizontal_residue[wave] / ground->rayleigh;
        struct potentials rest, now;
        patch_potentials(&load->patch, x, y, d, &rest);
        patch_potentials(&load->patch, x, y, d - I * c * t, &now);
        response->rate[0] += horizontal * c * cimag(now.plain_x);
        response->rate[1] += horizontal * c * cimag(now.plain_y);
        response->rate[2] += vertical * c * cimag(now.angle);
        response->step[0] += horizontal * creal(now.once_x - rest.once_x);
        response->step[1] += horizontal * creal(now.once_y - rest.once_y);
        response->step[2] += vertical * creal(rest.plain - now.plain);
        response->integral[0] += horizontal * creal(I / c * (now.twice_x - rest.twice_x) - t * rest.once_x);
        response->integral[1] += horizontal * creal(I / c * (now.twice_y - rest.twice_y) - t * rest.once_y);
        response->integral[2] += vertical * creal(t * rest.plain - I / c * (now.once - rest.once));
    }
}

void lamb_split_static(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                       double z, double displacement[3])
{
    static_response(ground, load, x, y, z, displacement);
    if (lamb_split_rayleigh(load)) {
        double rayleigh[3];
        static_rayleigh(ground, load, x, y, z, rayleigh);
        for (int i = 0; i < 3; i++)
            displacement[i] -= load->traction[2] * rayleigh[i];
    }
    for (int i = 0; i < 3; i++)
        displacement[i] /= 2 * M_PI * ground->mu;
}

static void add_rayleigh(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                         double z, double t, double value[6])
{
    const double factor = load->traction[2] / (2 * M_PI * ground->mu);
    double time = 0, slope = 0, jump = 0;
    for (size_t k = 0; kink(load->history, k, &time, &slope, &jump) && time < t; k++) {
        struct rayleigh response;
        rayleigh_response(ground, load, x, y, z, t - time, &response);
        for (int i = 0; i < 3; i++) {
            value[i] += factor * (slope * response.integral[i] + jump * response.step[i]);
            value[3 + i] += factor * (slope * response.step[i] + jump * response.rate[i]);
        }
    }
}

/* -1, 0 or 1: at the left edge of a side of half length `half`, elsewhere, at the right edge. */
static int edge_of(double distance, double half)
{
    if (fabs(fabs(distance) - half) > 1e-9 * half) return 0;
    return distance < 0 ? -1 : 1;
}

/* Half a plane x < 0 under a step is self-similar, so that velocity at x = 0 is constant (derived, from Eq 7 of
 * doc/theory/lamb.md with X = i/kx), at s = cs:
 *
 *   v_x = -cs/(pi mu) T_z int_0^inf horizontal dk/k,   v_z = -cs/(pi mu) T_x int_0^inf coupled dk/k,
 *   v_y = -cs/(2 pi mu) T_x int_0^inf (radial - shear) dk/k in a corner, where the others count half.
 *
 * The three integrals, over kappa = k/|s| at the surface: 12-point panels in u = kappa/(1 + kappa), so that the static
 * tail, like kappa^-2, is smooth at u = 1. */
static void front_integrals(const struct half_space *ground, bool without_rayleigh, double integral[3])
{
    enum { PANELS = 8 };
    integral[0] = integral[1] = integral[2] = 0;
    for (int panel = 0; panel < PANELS; panel++)
        for (int i = 0; i < 12; i++) {
            const double u = (panel + .5 + .5 * gauss12_node[i]) / PANELS, k = u / (1 - u);
            const double weight = .5 * gauss12_weight[i] / PANELS / ((1 - u) * (1 - u)) / k;
            struct compliance at;
            half_space_compliance(ground, ground->s_speed, 0, 1, &k, true, without_rayleigh, &at);
            integral[0] += weight * at.horizontal[0][0];
            integral[1] += weight * at.coupled[0][0];
            integral[2] += weight * (at.radial[0][0] - at.shear[0][0]);
        }
}

void lamb_split_front(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                      double z, double velocity[3])
{
    const struct patch *patch = &load->patch;
    const double share = patch_share(patch, x, y), *f = load->traction;
    for (int i = 0; i < 3; i++)
        velocity[i] = share * f[i] / (ground->density * (i == 2 ? ground->p_speed : ground->s_speed));
    if (z > 0 || patch->shape == PATCH_POINT) return;
    const bool disc = patch->shape == PATCH_DISC;
    double edge[2] = {edge_of(x, patch->half[0]), edge_of(y, patch->half[1])};
    const double corner = disc ? 0 : edge[0] * edge[1];
    if (disc) {
        const double r = hypot(x, y), rim = edge_of(r, patch->half[0]);
        edge[0] = rim != 0 ? rim * x / r : 0; /* at the centre r = 0 */
        edge[1] = rim != 0 ? rim * y / r : 0;
    } else {
        edge[0] *= patch_side_share(y, patch->half[1]);
        edge[1] *= patch_side_share(x, patch->half[0]);
    }
    if (edge[0] == 0 && edge[1] == 0) return;
    double integral[3];
    front_integrals(ground, lamb_split_rayleigh(load), integral);
    const double factor = -ground->s_speed / (M_PI * ground->mu);
    velocity[0] += factor * (edge[0] * integral[0] * f[2] + .5 * corner * integral[2] * f[1]);
    velocity[1] += factor * (edge[1] * integral[0] * f[2] + .5 * corner * integral[2] * f[0]);
    velocity[2] += factor * integral[1] * (edge[0] * f[0] + edge[1] * f[1]);
}

void lamb_split_front_laplace(const struct half_space *ground, const double velocity[3], double complex s,
                              double z, double complex displacement[3])
{
    for (int i = 0; i < 3; i++)
        displacement[i] =
            velocity[i] / s * (z == 0 ? 1 : cexp(-s * z / (i == 2 ? ground->p_speed : ground->s_speed)));
}

void lamb_split_value(const struct half_space *ground, const struct lamb_load *load, double x, double y,
                      double z, double t, const double front[3], double value[6])
{
    for (int i = 0; i < 3; i++) {
        if (front[i] == 0) continue;
        const double late = t - z / (i == 2 ? ground->p_speed : ground->s_speed);
        value[i] += front[i] * history_value(load->history, late, -1);
        value[3 + i] += front[i] * history_value(load->history, late, 0);
    }
    if (lamb_split_rayleigh(load)) add_rayleigh(ground, load, x, y, z, t, value);
}
