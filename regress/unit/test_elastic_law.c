/* Elastic laws: stress is the derivative of the energy, small strains obey Hooke's law, rotations cost
 * nothing, thin bodies have no stress across. */
#include "box_scene.h"
#include "method/total_lagrangian/elastic_law.h"

#include <string.h>

static struct elastic make(enum elastic_law law, int dimension, enum plane plane)
{
    struct material material;
    set_material(&material, 1.5, .8, 1.3);
    if (dimension < 3 && plane == PLANE_STRESS)
        material.plane_lambda = dimension == 2 ? 2 * 1.5 * .8 / (1.5 + 1.6) : material.young - 1.6;
    return elastic_of(&material, law, dimension, plane);
}

static const double sample[9] = {.1, -.23, .31, .17, -.08, .05, -.12, .26, .14};

static void stress_is_the_energys_derivative(void **state)
{
    (void)state;
    for (int law = 0; law < 3; law++)
        for (int d = 1; d <= 3; d++)
            for (int plane = 0; plane < 2; plane++) {
                const struct elastic elastic = make((enum elastic_law)law, d, (enum plane)plane);
                double H[9];
                double P[9];
                memcpy(H, sample, sizeof H);
                elastic_stress(&elastic, H, P);
                for (int k = 0; k < d * d; k++) {
                    const double step = 1e-4;
                    double e[4];
                    for (int s = 0; s < 4; s++) {
                        H[k] = sample[k] + step * (s < 2 ? s - 2 : s - 1);
                        e[s] = elastic_energy(&elastic, H);
                    }
                    H[k] = sample[k];
                    assert_near(P[k], (e[0] - 8 * e[1] + 8 * e[2] - e[3]) / (12 * step), 1e-9);
                }
            }
}

static void small_strains_obey_hooke(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++)
        for (int plane = 0; plane < 2; plane++) {
            const struct elastic hooke = make(LAW_LINEAR, d, (enum plane)plane);
            double H[9];
            double P[9];
            double Q[9];
            for (int k = 0; k < 9; k++)
                H[k] = 1e-7 * sample[k];
            elastic_stress(&hooke, H, P);
            for (int law = 1; law < 3; law++) {
                const struct elastic elastic = make((enum elastic_law)law, d, (enum plane)plane);
                elastic_stress(&elastic, H, Q);
                for (int k = 0; k < d * d; k++)
                    assert_near(Q[k], P[k], 1e-13);
            }
        }
    /* the modulus of a thin bar is Young's */
    const struct elastic bar = make(LAW_LINEAR, 1, PLANE_STRESS);
    const double H = .01;
    double P;
    elastic_stress(&bar, &H, &P);
    assert_near(P, .01 * .8 * (4.5 + 1.6) / 2.3, 1e-15);
}

static void rotations_cost_nothing(void **state)
{
    (void)state;
    const double angle = 2;
    const double H[9] = {cos(angle) - 1, -sin(angle), 0, sin(angle), cos(angle) - 1, 0, 0, 0, 0};
    for (int law = 1; law < 3; law++) {
        const struct elastic elastic = make((enum elastic_law)law, 3, PLANE_STRAIN);
        double P[9];
        elastic_stress(&elastic, H, P);
        assert_near(elastic_energy(&elastic, H), 0, 1e-15);
        for (int k = 0; k < 9; k++)
            assert_near(P[k], 0, 1e-14);
    }
}

/* A thin plate: the solid's law with the stretch across that makes the energy least. */
static void thin_plates_find_their_thickness(void **state)
{
    (void)state;
    for (int law = 1; law < 3; law++) {
        const struct elastic thin = make((enum elastic_law)law, 2, PLANE_STRESS);
        const struct elastic solid = make((enum elastic_law)law, 3, PLANE_STRAIN);
        double least = INFINITY;
        double stretch = 0;
        for (int k = 0; k <= 40000; k++) {
            const double f = .5 + k / 40000.;
            const double H[9] = {sample[0], sample[1], 0, sample[3], sample[4], 0, 0, 0, f - 1};
            const double energy = elastic_energy(&solid, H);
            if (energy < least) stretch = f;
            least = fmin(least, energy);
        }
        const double H[4] = {sample[0], sample[1], sample[3], sample[4]};
        double stress[6];
        double strain[6];
        assert_near(elastic_energy(&thin, H), least, 1e-9);
        elastic_observe(&thin, H, stress, strain);
        assert_near(stress[2], 0, 0);
        assert_near(strain[2], .5 * (stretch * stretch - 1), 5e-5);
        /* Cauchy stress in the plane is that of the solid at this stretch */
        const double whole[9] = {H[0], H[1], 0, H[2], H[3], 0, 0, 0, stretch - 1};
        double solid_stress[6];
        elastic_observe(&solid, whole, solid_stress, strain);
        assert_near(stress[0], solid_stress[0], 1e-4);
        assert_near(stress[3], solid_stress[3], 1e-4);
        assert_near(solid_stress[2], 0, 1e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stress_is_the_energys_derivative),
        cmocka_unit_test(small_strains_obey_hooke),
        cmocka_unit_test(rotations_cost_nothing),
        cmocka_unit_test(thin_plates_find_their_thickness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
