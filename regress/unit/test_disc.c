/* What a rectangle has of a disc (points/disc.h). */
#include "points/disc.h"

#include "chance.h"
#include "near.h"

static void test_whole_and_half(void **state)
{
    (void)state;
    double moment[3];
    disc_and_rectangle((double[]){-3, -4}, (double[]){5, 6}, 2, moment);
    assert_near(moment[0], 4 * M_PI, 1e-14);
    assert_near(moment[1], 0, 1e-14);
    assert_near(moment[2], 0, 1e-14);
    disc_and_rectangle((double[]){-3, 0}, (double[]){5, 6}, 2,
                       moment); /* centre of half a disc: 4 r / (3 pi) */
    assert_near(moment[0], 2 * M_PI, 1e-14);
    assert_near(moment[1], 0, 1e-14);
    assert_near(moment[2], 2. / 3 * 8, 1e-14);
    disc_and_rectangle((double[]){1.5, 1.5}, (double[]){2, 3}, 2, moment); /* beside it, within its box */
    for (int k = 0; k < 3; k++)
        assert_near(moment[k], 0, 1e-15);
    disc_and_rectangle((double[]){-.5, .1}, (double[]){.3, .4}, 2, moment); /* within it */
    assert_near(moment[0], .24, 1e-15);
    assert_near(moment[1], -.024, 1e-15);
    assert_near(moment[2], .06, 1e-15);
}

/* Integrals over x by the midpoint rule between the places where the chord changes its kind. */
static void by_chords(const double low[2], const double high[2], double radius, double moment[3])
{
    enum { STRIPS = 4000 };
    double cut[8] = {low[0], high[0]};
    size_t cuts = 2;
    for (int side = 0; side < 2; side++) {
        const double y = (side == 0 ? low : high)[1];
        if (fabs(y) < radius)
            for (int sign = -1; sign <= 1; sign += 2)
                cut[cuts++] = sign * sqrt(radius * radius - y * y);
    }
    cut[cuts++] = -radius;
    cut[cuts++] = radius;
    for (size_t i = 0; i < cuts; i++)
        for (size_t j = i + 1; j < cuts; j++)
            if (cut[j] < cut[i]) {
                const double swap = cut[i];
                cut[i] = cut[j];
                cut[j] = swap;
            }
    moment[0] = moment[1] = moment[2] = 0;
    for (size_t i = 0; i + 1 < cuts; i++)
        for (int k = 0; k < STRIPS; k++) { /* x = middle - half cos(angle) */
            const double angle = M_PI * (k + .5) / STRIPS, half = (cut[i + 1] - cut[i]) / 2;
            const double x = cut[i] + half * (1 - cos(angle)), width = half * sin(angle) * M_PI / STRIPS;
            if (x < low[0] || x > high[0] || fabs(x) > radius) continue;
            const double chord = sqrt(radius * radius - x * x);
            const double from = fmax(low[1], -chord), to = fmin(high[1], chord);
            if (!(to > from)) continue;
            moment[0] += width * (to - from);
            moment[1] += width * (to - from) * x;
            moment[2] += width * (to * to - from * from) / 2;
        }
}

static double between(double low, double high)
{
    return low + (high - low) * (double)chance(1u << 20) / (double)(1u << 20);
}

static void test_any(void **state)
{
    (void)state;
    seed_begin(11);
    for (int k = 0; k < 300; k++) {
        const double radius = between(.2, 2);
        const double low[2] = {between(-2, 1), between(-2, 1)};
        const double high[2] = {low[0] + between(.1, 2), low[1] + between(.1, 2)};
        double moment[3], other[3], turned[3];
        disc_and_rectangle(low, high, radius, moment);
        by_chords(low, high, radius, other);
        for (int i = 0; i < 3; i++)
            assert_near(moment[i], other[i], 3e-7);
        disc_and_rectangle((double[]){low[1], low[0]}, (double[]){high[1], high[0]}, radius, turned);
        assert_near(turned[0], moment[0], 1e-14);
        assert_near(turned[1], moment[2], 1e-14);
        assert_near(turned[2], moment[1], 1e-14);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_and_half),
        cmocka_unit_test(test_any),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
