/* Initial states: the fields against the equations they come from. */
#include "from_deck.h"
#include "scene/initial.h"

#define SOLID "&material name='rock', density=2, lambda=3, mu=5 /\n"
#define BOX                                                                                                  \
    "&scene dimension=3, end_time=6 /\n" SOLID "&body material='rock', low=0,0,0, high=7,7,7, spacing=.5 "   \
    "/\n"

static void rest_and_uniform(void **unused)
{
    (void)unused;
    const double place[3] = {1, 2, 3};
    double u[3], v[3];
    struct from_deck d = right_scene(BOX);
    initial_at(d.scene, place, u, v);
    for (int c = 0; c < 3; c++) {
        assert_near(u[c], 0, 0);
        assert_near(v[c], 0, 0);
    }
    from_deck_free(&d);
    d = right_scene(BOX "&initial kind='uniform-velocity', velocity=1,-2,3 /\n");
    initial_at(d.scene, place, u, v);
    for (int c = 0; c < 3; c++)
        assert_near(u[c], 0, 0);
    assert_near(v[1], -2, 0);
    assert_near(v[2], 3, 0);
    from_deck_free(&d);
}

/* Acceleration of Navier's equation at t = 0 by central differences of u, second order in h:
 * rho a = (lambda + mu) grad div u + mu laplace u. */
static void navier(const struct scene *scene, const double x[3], double h, double acceleration[3])
{
    const struct material *m = scene->material;
    double u[3][3][3][3], unused[3];
    for (int i = -1; i <= 1; i++)
        for (int j = -1; j <= 1; j++)
            for (int k = -1; k <= 1; k++) {
                const double place[3] = {x[0] + i * h, x[1] + j * h, x[2] + k * h};
                initial_at(scene, place, u[i + 1][j + 1][k + 1], unused);
            }
    for (int c = 0; c < 3; c++) {
        double laplace = 0, grad_div = 0;
        for (int a = 0; a < 3; a++) {
            int step[3] = {0, 0, 0};
            step[a] = 1;
            const double *ahead = u[1 + step[0]][1 + step[1]][1 + step[2]];
            const double *behind = u[1 - step[0]][1 - step[1]][1 - step[2]];
            laplace += (ahead[c] - 2 * u[1][1][1][c] + behind[c]) / (h * h);
            if (a == c) {
                grad_div += (ahead[c] - 2 * u[1][1][1][c] + behind[c]) / (h * h);
                continue;
            }
            int across[3] = {0, 0, 0};
            across[c] = 1;
            double mixed = 0;
            for (int s = -1; s <= 1; s += 2)
                for (int t = -1; t <= 1; t += 2)
                    mixed += s * t *
                             u[1 + s * step[0] + t * across[0]][1 + s * step[1] + t * across[1]]
                              [1 + s * step[2] + t * across[2]][a];
            grad_div += mixed / (4 * h * h);
        }
        acceleration[c] = ((m->lambda + m->mu) * grad_div + m->mu * laplace) / m->density;
    }
}

/* A travelling wave u(x - c n t) has v = -c (n.grad) u and a = c^2 (n.grad)^2 u: so the pair (u, v) of a deck
 * is a wave of the solid if Navier's acceleration agrees with the latter, and v with the former. Checks c,
 * the direction of travel, and that P moves along n and S across it. */
static void check_travelling(const char *deck, double speed, const double n[3])
{
    const double x[3] = {1.3, 2.1, .7}, h = 1e-3;
    double a[3], u[3], v[3], ahead[3], behind[3], unused[3], plus[3], minus[3];
    struct from_deck d = right_scene(deck);
    for (int c = 0; c < 3; c++) {
        plus[c] = x[c] + h * n[c];
        minus[c] = x[c] - h * n[c];
    }
    initial_at(d.scene, x, u, v);
    initial_at(d.scene, plus, ahead, unused);
    initial_at(d.scene, minus, behind, unused);
    navier(d.scene, x, h, a);
    double motion = 0;
    for (int c = 0; c < 3; c++) {
        assert_near(v[c], -speed * (ahead[c] - behind[c]) / (2 * h), 1e-4);
        assert_near(a[c], speed * speed * (ahead[c] - 2 * u[c] + behind[c]) / (h * h), 1e-3);
        motion += v[c] * v[c];
    }
    assert_true(motion > .1); /* the place is not a node: the checks above see something */
    from_deck_free(&d);
}

static void travelling_waves(void **unused)
{
    (void)unused;
    const double n[3] = {2. / 7, 3. / 7, 6. / 7}, back[3] = {0, 0, -1};
    check_travelling(BOX "&initial kind='plane-wave', direction=2,3,6, wavelength=4, amplitude=.7 /\n",
                     sqrt(6.5), n);
    check_travelling(BOX "&initial kind='plane-wave', wave='s', direction=2,3,6, polarisation=3,-2,0, "
                         "wavelength=4, amplitude=.7 /\n",
                     sqrt(2.5), n);
    check_travelling(BOX
                     "&initial kind='plane-wave', direction=0,0,-3, width=1, centre=0,0,.2, amplitude=1 /\n",
                     sqrt(6.5), back);
    check_travelling(BOX
                     "&initial kind='plane-wave', wave='s', direction=0,0,-3, polarisation=1,1,0, width=1, "
                     "centre=0,0,.2, amplitude=1 /\n",
                     sqrt(2.5), back);
}

/* In 2D the polarisation of an S wave goes without saying: across the direction, in the plane. */
static void shear_in_a_plane(void **unused)
{
    (void)unused;
    struct from_deck d = right_scene("&scene dimension=2, end_time=6 /\n" SOLID
                                     "&body material='rock', low=0,0, high=7,7, spacing=.5 /\n"
                                     "&initial kind='plane-wave', wave='s', direction=3,4, wavelength=4, "
                                     "amplitude=1 /\n");
    assert_near(d.scene->initial.polarisation[0], -.8, 1e-15);
    assert_near(d.scene->initial.polarisation[1], .6, 1e-15);
    from_deck_free(&d);
}

static void amplitudes(void **unused)
{
    (void)unused;
    double u[3], v[3];
    const double quarter[3] = {1, 0, 0}, side[3] = {2, 4, 3};
    struct from_deck d =
        right_scene(BOX "&initial kind='plane-wave', direction=1,0,0, wavelength=4, amplitude=.7 /\n");
    initial_at(d.scene, quarter, u, v);
    assert_near(u[0], .7, 1e-15);
    assert_near(v[0], 0, 1e-14);
    from_deck_free(&d);
    d = right_scene(BOX "&initial kind='gaussian', centre=2,3,3, width=.5, amplitude=3, direction=0,0,2 /\n");
    initial_at(d.scene, side, u, v);
    assert_near(u[2], 3 * exp(-2), 1e-15); /* one length away: two widths */
    assert_near(u[0] + u[1] + v[0] + v[1] + v[2], 0, 0);
    from_deck_free(&d);
}

/* He & Seaid Eq 30 is the first mode of a clamped-free beam: w'''' = (k / L)^4 w with w(0) = w'(0) = 0 and
 * w''(L) = w'''(L) = 0; scaled to 1 at the tip. Differences of high order check all that. */
static void beam_shape(void **unused)
{
    (void)unused;
    const double length = .5, h = .01, k = beam_mode_root(BEAM_CLAMPED_FREE) / length;
    assert_near(cos(beam_mode_root(BEAM_CLAMPED_FREE)) * cosh(beam_mode_root(BEAM_CLAMPED_FREE)), -1, 1e-14);
    assert_near(beam_mode_root(BEAM_CLAMPED_FREE), 1.875, 2e-4); /* as printed */
    assert_near(beam_mode(BEAM_CLAMPED_FREE, 0, length, 0), 0, 1e-15);
    assert_near(beam_mode(BEAM_CLAMPED_FREE, length, length, 0), 1, 1e-14);
    assert_near((beam_mode(BEAM_CLAMPED_FREE, h, length, 0) - beam_mode(BEAM_CLAMPED_FREE, -h, length, 0)) /
                    (2 * h),
                0, 1e-3);
    for (double x = .1; x < .5; x += .1) {
        const double fourth = (beam_mode(BEAM_CLAMPED_FREE, x + 2 * h, length, 0) -
                               4 * beam_mode(BEAM_CLAMPED_FREE, x + h, length, 0) +
                               6 * beam_mode(BEAM_CLAMPED_FREE, x, length, 0) -
                               4 * beam_mode(BEAM_CLAMPED_FREE, x - h, length, 0) +
                               beam_mode(BEAM_CLAMPED_FREE, x - 2 * h, length, 0)) /
                              (h * h * h * h);
        assert_near(fourth / (k * k * k * k), beam_mode(BEAM_CLAMPED_FREE, x, length, 0), 5e-4);
    }
    const double bending = (beam_mode(BEAM_CLAMPED_FREE, length + h, length, 0) - 2 +
                            beam_mode(BEAM_CLAMPED_FREE, length - h, length, 0)) /
                           (h * h);
    assert_near(bending / (k * k), 0, 2e-4);
    const double shear = (beam_mode(BEAM_CLAMPED_FREE, length + 2 * h, length, 0) -
                          2 * beam_mode(BEAM_CLAMPED_FREE, length + h, length, 0) +
                          2 * beam_mode(BEAM_CLAMPED_FREE, length - h, length, 0) -
                          beam_mode(BEAM_CLAMPED_FREE, length - 2 * h, length, 0)) /
                         (2 * h * h * h);
    assert_near(shear / (k * k * k), 0, 2e-3);
}

/* The other ends: the root, w'''' = (k / L)^4 w, what is 0 at both ends, the slope, the scale. */
static void other_beam_shapes(void **unused)
{
    (void)unused;
    const double length = 2, h = .02;
    assert_near(cos(beam_mode_root(BEAM_FREE_FREE)) * cosh(beam_mode_root(BEAM_FREE_FREE)), 1, 1e-12);
    for (enum beam_ends ends = BEAM_CLAMPED_FREE; ends < BEAM_ENDS; ends++) {
        const double k = beam_mode_root(ends) / length;
        double most = 0;
        for (int i = 0; i <= 10; i++) {
            const double x = .1 * i * length;
            double w[5];
            for (int j = 0; j < 5; j++)
                w[j] = beam_mode(ends, x + (j - 2) * h, length, 0);
            const double fourth = (w[0] - 4 * w[1] + 6 * w[2] - 4 * w[3] + w[4]) / pow(k * h, 4);
            assert_near(fourth, w[2], 1e-3);
            assert_near((w[3] - w[1]) / (2 * h), beam_mode(ends, x, length, 1), 1e-3 * k);
            most = fmax(most, fabs(w[2]));
            if (i > 0 && i < 10) continue;
            const double slope = beam_mode(ends, x, length, 1) / k;
            const double bending = (w[1] - 2 * w[2] + w[3]) / pow(k * h, 2);
            const double shear = (w[4] - 2 * w[3] + 2 * w[1] - w[0]) / (2 * pow(k * h, 3));
            const bool clamped = ends == BEAM_CLAMPED_CLAMPED || (ends == BEAM_CLAMPED_FREE && i == 0);
            const bool held = ends == BEAM_SIMPLY_SUPPORTED;
            assert_near(clamped || held ? w[2] : shear, 0, 2e-3);
            assert_near(clamped ? slope : bending, 0, 2e-3);
        }
        assert_near(most, 1, 1e-12);
    }
}

/* The tip of the beam moves with V_f c0 across it, also when the beam is turned. */
static void beam_velocity(void **unused)
{
    (void)unused;
    struct from_deck d =
        right_scene("&scene dimension=2, end_time=6, plane='stress' /\n" SOLID
                    "&body material='rock', low=0,0, high=8,1, spacing=.5, rotation=0,0,90 /\n"
                    "&boundary face='x-', kind='fixed' /\n"
                    "&initial kind='beam-mode', amplitude=.01 /\n");
    const double tip[3] = {8, .5, 0}, c0 = sqrt(11.875 / 2);
    double place[3], u[3], v[3];
    body_to_deck(&d.scene->body, tip, place);
    initial_at(d.scene, place, u, v);
    assert_near(v[0], -.01 * c0, 1e-15); /* y of the body is -x of the deck */
    assert_near(v[1], 0, 1e-16);
    from_deck_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_and_uniform), cmocka_unit_test(travelling_waves),
        cmocka_unit_test(shear_in_a_plane), cmocka_unit_test(amplitudes),
        cmocka_unit_test(beam_shape),       cmocka_unit_test(other_beam_shapes),
        cmocka_unit_test(beam_velocity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
