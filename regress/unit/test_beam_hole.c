/* References 'beam' and 'hole' and the frequency fit, against what they must satisfy. */
#include "box_scene.h"
#include "exact/beam.h"
#include "exact/frequency.h"
#include "exact/hole.h"

#include <string.h>

/* The smallest positive root of cos cosh = -1 is that of Eq 30, and slender beams follow Euler and Bernoulli.
 */
/* Kirsch's stresses xx yy xy (as exact/hole.h). */
static void hole_stress(double far, double radius, double x, double y, double stress[3])
{
    const double angle = atan2(y, x);
    const double q = radius * radius / (x * x + y * y);
    stress[0] = far * (1 - q * (1.5 * cos(2 * angle) + cos(4 * angle)) + 1.5 * q * q * cos(4 * angle));
    stress[1] = far * (-q * (0.5 * cos(2 * angle) - cos(4 * angle)) - 1.5 * q * q * cos(4 * angle));
    stress[2] = far * (-q * (0.5 * sin(2 * angle) + sin(4 * angle)) + 1.5 * q * q * sin(4 * angle));
}

static void beam_theories_agree_when_slender(void **state)
{
    (void)state;
    const struct beam stout = {.5, .1, 45e9, 45e9 / 2.7, 1738, .35, BEAM_CLAMPED_FREE};
    assert_near(beam_euler_bernoulli(&stout), 2066, .5); /* He & Seaid 2016, Table 2 */
    struct beam thin = stout;
    thin.width = .05;
    assert_near(beam_euler_bernoulli(&thin), 1033, .5);
    double before = 1;
    for (double width = .1; width > .001; width /= 4) {
        struct beam beam = stout;
        beam.width = width;
        const double defect = 1 - beam_timoshenko(&beam) / beam_euler_bernoulli(&beam);
        assert_true(defect > 0 && defect < before);
        if (before < 1) assert_near(defect / before, 1. / 16, .004); /* shear and rotation count as width^2 */
        before = defect;
    }
    /* stout: near the two-dimensional values of two finite-element programs */
    assert_near(beam_timoshenko(&stout), 2008.3, .004 * 2008.3);
    assert_near(beam_timoshenko(&thin), 1026.2, .002 * 1026.2);
}

/* Slender beams with other ends follow Euler and Bernoulli, kappa L = 4.7300 and pi (Blevins 1979, Table 8-1). Simply
 * supported Timoshenko's have a closed form: with q = (pi r / L)^2, r^2 = W^2 / 12 and a = E / (k G), x = (w / w0)^2
 * solves 1 - x (1 + q (1 + a)) + x^2 q^2 a = 0. */
static void beams_have_ends(void **state)
{
    (void)state;
    const double root[BEAM_ENDS] = {1.87510, 4.73004, M_PI, 4.73004};
    for (enum beam_ends ends = BEAM_CLAMPED_FREE; ends < BEAM_ENDS; ends++) {
        const struct beam beam = {.5, .001, 45e9, 45e9 / 2.7, 1738, .35, ends};
        const double wanted = pow(root[ends] / .5, 2) * sqrt(45e9 * 1e-6 / 12 / 1738);
        assert_near(beam_euler_bernoulli(&beam), wanted, 1e-5 * wanted);
        assert_near(beam_timoshenko(&beam), wanted, 2e-4 * wanted);
    }
    const struct beam stout = {.5, .1, 45e9, 45e9 / 2.7, 1738, .35, BEAM_SIMPLY_SUPPORTED};
    const double q = pow(M_PI / .5, 2) * .01 / 12, a = 2.7 / (10 * 1.35 / (12 + 11 * .35));
    const double b = 1 + q * (1 + a), x = (b - sqrt(b * b - 4 * q * q * a)) / (2 * q * q * a);
    assert_near(beam_timoshenko(&stout) / beam_euler_bernoulli(&stout), sqrt(x), 1e-9);
}

static void frequencies_are_fitted(void **state)
{
    (void)state;
    enum { ROWS = 2000 };
    double time[ROWS];
    double value[2 * ROWS];
    struct messages messages = {0};
    double frequency = 0;
    for (int k = 0; k < ROWS; k++) {
        time[k] = .01 * k;
        value[2 * k + 1] = .3 + sin(2.345 * time[k] + .7) + .05 * cos(6.2 * 2.345 * time[k]);
    }
    assert_int_equal(fit_frequency(ROWS, time, value + 1, 2, 2.2, &frequency, &messages), SELAS_OK);
    assert_near(frequency, 2.345, 2e-4);
    assert_int_equal(fit_frequency(ROWS, time, value + 1, 2, .1, &frequency, &messages), SELAS_BAD_ARGUMENT);
    /* none where there is none: far from the guess, or no motion at all */
    assert_int_equal(fit_frequency(ROWS, time, value + 1, 2, 5, &frequency, &messages), SELAS_NOT_CONVERGED);
    memset(value, 0, sizeof value);
    assert_int_equal(fit_frequency(ROWS, time, value + 1, 2, 2.2, &frequency, &messages),
                     SELAS_NOT_CONVERGED);
    messages_free(&messages);
}

/* Kirsch's displacements have his stresses by Hooke's law; the hole is free and the far field uniaxial. */
static void kirsch_is_consistent(void **state)
{
    (void)state;
    const double mu = .8;
    const double nu = .3;
    for (int stress_plane = 0; stress_plane < 2; stress_plane++) {
        const double kappa = stress_plane ? (3 - nu) / (1 + nu) : 3 - 4 * nu;
        const double lambda = mu * (3 - kappa) / (kappa - 1); /* of the plane problem */
        for (int k = 0; k < 20; k++) {
            const double angle = .3 * k;
            const double r = .5 + .1 * k;
            const double x[2] = {r * cos(angle), r * sin(angle)};
            double gradient[2][2];
            for (int b = 0; b < 2; b++) {
                const double step = 1e-4;
                double u[4][2];
                for (int s = 0; s < 4; s++) {
                    double p[2] = {x[0], x[1]};
                    p[b] += step * (s < 2 ? s - 2 : s - 1);
                    hole_displacement(2, .5, mu, kappa, p[0], p[1], u[s]);
                }
                for (int a = 0; a < 2; a++)
                    gradient[a][b] = (u[0][a] - 8 * u[1][a] + 8 * u[2][a] - u[3][a]) / (12 * step);
            }
            double stress[3];
            hole_stress(2, .5, x[0], x[1], stress);
            const double trace = gradient[0][0] + gradient[1][1];
            assert_near(stress[0], lambda * trace + 2 * mu * gradient[0][0], 1e-8);
            assert_near(stress[1], lambda * trace + 2 * mu * gradient[1][1], 1e-8);
            assert_near(stress[2], mu * (gradient[0][1] + gradient[1][0]), 1e-8);
            hole_stress(2, .5, .5 * cos(angle), .5 * sin(angle), stress);
            assert_near(stress[0] * cos(angle) + stress[2] * sin(angle), 0, 1e-14);
            assert_near(stress[2] * cos(angle) + stress[1] * sin(angle), 0, 1e-14);
        }
    }
    double stress[3];
    hole_stress(2, .5, 0, .5, stress);
    assert_near(stress[0], 6, 1e-14); /* three times the far stress */
    hole_stress(2, .5, 700, 300, stress);
    assert_near(stress[0], 2, 1e-5);
    assert_near(stress[1], 0, 1e-5);
    /* across the ligament: the formula of He & Seaid, section 4.3 */
    hole_stress(1, .3, 0, .7, stress);
    assert_near(stress[0], 1 + .5 * pow(.3 / .7, 2) + 1.5 * pow(.3 / .7, 4), 1e-14);
}

static void scenes_choose_their_reference(void **state)
{
    (void)state;
    struct box_scene box;
    struct messages messages = {0};
    struct exact *exact = NULL;
    make_box(&box, 2, .5, .01);
    box.scene.body.high[1] = .1;
    box.material.young = 45e9;
    box.material.density = 1738;
    box.material.poisson = .35;
    box.scene.plane = PLANE_STRESS;
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
    assert_near(beam_plane(&box.scene), 2008.3, 1e-9 * 2008);
    box.scene.body.low[0] += 5e5; /* easting and northing: edges are rounded */
    box.scene.body.high[0] += 5e5;
    box.scene.body.low[1] += 4e6;
    box.scene.body.high[1] += 4e6;
    assert_near(beam_plane(&box.scene), 2008.3, 1e-8 * 2008);
    box.scene.body.low[1] -= 4e6;
    box.scene.body.high[1] -= 4e6;
    box.scene.body.low[0] -= 5e5;
    box.scene.body.high[0] -= 5e5;
    box.scene.body.high[1] = .09;
    assert_near(beam_plane(&box.scene), 0, 0);
    assert_int_equal(exact_beam.create(&box.scene, &exact, &messages), SELAS_BAD_SCENE);
    box.scene.initial.kind = INITIAL_BEAM_MODE;
    box.scene.initial.amplitude = .01;
    assert_int_equal(exact_beam.create(&box.scene, &exact, &messages), SELAS_OK);
    const double tip[3] = {.5, .045, 0};
    const double time[2] = {0, 1e-4};
    double value[12];
    assert_int_equal(exact->class->history(exact, tip, 2, time, value, &messages), SELAS_OK);
    assert_near(fabs(value[4]), .01 * sqrt(45e9 / 1738), 1e-3 * 50); /* starts at V_f c0 at the tip */
    assert_near(value[1], 0, 0);
    assert_near(value[7], value[4] * 1e-4, .01 * fabs(value[7]));
    exact->class->destroy(exact);
    /* clamped at both ends; a roller below the beam or at its end makes it another one */
    box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_FIXED;
    assert_int_equal(exact_beam.create(&box.scene, &exact, &messages), SELAS_OK);
    const double middle[3] = {.25, .045, 0};
    assert_int_equal(exact->class->history(exact, middle, 2, time, value, &messages), SELAS_OK);
    assert_near(fabs(value[4]), .01 * sqrt(45e9 / 1738), 1e-9 * 50);
    exact->class->destroy(exact);
    box.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_ROLLER;
    assert_int_equal(exact_beam.create(&box.scene, &exact, &messages), SELAS_BAD_SCENE);
    box.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_FREE;
    box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_ROLLER;
    assert_int_equal(exact_beam.create(&box.scene, &exact, &messages), SELAS_BAD_SCENE);
    assert_int_equal(exact_hole.create(&box.scene, &exact, &messages), SELAS_BAD_SCENE);
    messages_free(&messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beam_theories_agree_when_slender), cmocka_unit_test(beams_have_ends),
        cmocka_unit_test(frequencies_are_fitted),           cmocka_unit_test(kirsch_is_consistent),
        cmocka_unit_test(scenes_choose_their_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
