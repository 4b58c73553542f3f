/* Neighbours against brute force: random clouds, lattices, degenerate sets; reproducible for any number of
 * threads. */
#include "base/memory.h"
#include "near.h"
#include "points/neighbours.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Cloud of numbers in [0, 1) times size, from a small congruential generator of the test's own. */
static void fill_cloud(size_t points, double size_x, double size_y, double size_z, double *position)
{
    uint64_t state = 12345;
    for (size_t k = 0; k < 3 * points; k++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double size[3] = {size_x, size_y, size_z};
        position[k] = (double)(state >> 11) * 0x1p-53 * size[k % 3];
    }
}

static bool close_by(int dimension, const double *a, const double *b, double radius)
{
    double sum = 0;
    for (int c = 0; c < dimension; c++)
        sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum < radius * radius;
}

static void check_against_brute_force(int dimension, size_t points, const double *position, double radius,
                                      bool with_self)
{
    struct messages messages = {0};
    struct neighbours neighbours = {0};
    assert_int_equal(neighbours_find(&neighbours, dimension, points, position, radius, with_self, &messages),
                     SELAS_OK);
    assert_int_equal(neighbours.points, points);
    for (size_t i = 0; i < points; i++) {
        size_t k = neighbours.start[i];
        for (size_t j = 0; j < points; j++) {
            if (j == i && !with_self) continue;
            if (!close_by(dimension, position + 3 * i, position + 3 * j, radius)) continue;
            assert_true(k < neighbours.start[i + 1]);
            assert_int_equal(neighbours.index[k], j);
            k++;
        }
        assert_int_equal(k, neighbours.start[i + 1]);
    }
    neighbours_free(&neighbours);
    messages_free(&messages);
}

static void test_clouds(void **state)
{
    (void)state;
    enum { POINTS = 400 };
    static double position[3 * POINTS];
    for (int dimension = 1; dimension <= 3; dimension++) {
        fill_cloud(POINTS, 1, 1, 1, position);
        const double radii[] = {.01, .08, .21, .5, 3};
        for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++) {
            check_against_brute_force(dimension, POINTS, position, radii[k], false);
            check_against_brute_force(dimension, POINTS, position, radii[k], true);
        }
        fill_cloud(POINTS, 1000, 1, .001, position); /* a needle: far more cells along it than across */
        check_against_brute_force(dimension, POINTS, position, .5, false);
        check_against_brute_force(dimension, POINTS, position, 1e-4, false);
    }
}

static void test_small_and_degenerate(void **state)
{
    (void)state;
    const double same[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3};
    check_against_brute_force(3, 0, same, 1, true);
    check_against_brute_force(3, 1, same, 1, true);
    check_against_brute_force(3, 3, same, .1, false); /* all in one place */
    const double bad[6] = {0, 0, 0, NAN, 0, 0};
    struct neighbours neighbours = {0};
    struct messages messages = {0};
    assert_int_equal(neighbours_find(&neighbours, 3, 2, bad, 1, false, &messages), SELAS_BAD_ARGUMENT);
    assert_int_equal(neighbours_find(&neighbours, 3, 1, bad, 0, false, &messages), SELAS_BAD_ARGUMENT);
    assert_int_equal(messages.errors, 2);
    neighbours_free(&neighbours);
    messages_free(&messages);
}

/* 27 points within 2 spacings in the inside of a cubic lattice: the stencil of the cubic spline at h = dx
 * (those at exactly 2 spacings, where W = 0, do not count). */
static void test_lattice_stencil(void **state)
{
    (void)state;
    enum { N = 6 };
    static double position[3 * N * N * N];
    for (size_t i = 0; i < N * N * N; i++) {
        const size_t row = i / N, layer = row / N;
        position[3 * i] = .5 * (double)(i % N);
        position[3 * i + 1] = .5 * (double)(row % N);
        position[3 * i + 2] = .5 * (double)layer;
    }
    struct neighbours neighbours = {0};
    struct messages messages = {0};
    assert_int_equal(neighbours_find(&neighbours, 3, N * N * N, position, 1, true, &messages), SELAS_OK);
    const size_t inside = 2 + N * (2 + N * 3), corner = 0;
    assert_int_equal(neighbours.start[inside + 1] - neighbours.start[inside], 27);
    assert_int_equal(neighbours.start[corner + 1] - neighbours.start[corner], 8);
    uint32_t index[40];
    const double place[3] = {.25, .25, .25};
    assert_int_equal(neighbours_at(&neighbours, place, 40, index), 20); /* 8 at .433, 12 of 24 at .829 ... */
    neighbours_free(&neighbours);
    messages_free(&messages);
}

static void test_places(void **state)
{
    (void)state;
    enum { POINTS = 300, PLACES = 60 };
    static double position[3 * POINTS], place[3 * PLACES];
    fill_cloud(POINTS, 1, 1, 1, position);
    fill_cloud(PLACES, 1.4, 1.4, 1.4, place); /* some outside the cloud */
    struct neighbours neighbours = {0};
    struct messages messages = {0};
    const double radius = .2;
    assert_int_equal(neighbours_find(&neighbours, 3, POINTS, position, radius, false, &messages), SELAS_OK);
    for (size_t p = 0; p < PLACES; p++) {
        uint32_t index[POINTS];
        const size_t count = neighbours_at(&neighbours, place + 3 * p, POINTS, index);
        size_t expected = 0, nearest = POINTS;
        double least = radius * radius;
        for (size_t j = 0; j < POINTS; j++) {
            double sum = 0;
            for (size_t c = 0; c < 3; c++)
                sum += pow(place[3 * p + c] - position[3 * j + c], 2);
            if (sum < radius * radius) assert_int_equal(index[expected++], j);
            if (sum < least) {
                least = sum;
                nearest = j;
            }
        }
        assert_int_equal(count, expected);
        assert_int_equal(neighbours_nearest(&neighbours, place + 3 * p), nearest);
        uint32_t two[2] = {7777,
                           7777}; /* too little room: the count is still right, nothing beyond written */
        assert_int_equal(neighbours_at(&neighbours, place + 3 * p, 1, two), expected);
        assert_int_equal(two[1], 7777);
    }
    neighbours_free(&neighbours);
    messages_free(&messages);
}

static void test_reproducible_and_reused(void **state)
{
    (void)state;
    enum { POINTS = 5000 };
    double *position = array_new(3 * POINTS, sizeof *position);
    fill_cloud(POINTS, 1, 1, 1, position);
    struct messages messages = {0};
    struct neighbours one = {0}, many = {0};
    omp_set_num_threads(1);
    assert_int_equal(neighbours_find(&one, 3, POINTS, position, .12, false, &messages), SELAS_OK);
    omp_set_num_threads(7);
    assert_int_equal(neighbours_find(&many, 3, POINTS, position, .12, false, &messages), SELAS_OK);
    assert_memory_equal(one.start, many.start, (POINTS + 1) * sizeof *one.start);
    assert_memory_equal(one.index, many.index, one.start[POINTS] * sizeof *one.index);
    const uint32_t *kept = many.index;
    assert_int_equal(neighbours_find(&many, 3, POINTS, position, .11, false, &messages), SELAS_OK);
    assert_ptr_equal(kept, many.index); /* fewer pairs: the memory is kept */
    assert_true(neighbours_bytes(&many) > one.start[POINTS] * sizeof *one.index);
    neighbours_free(&one);
    neighbours_free(&many);
    messages_free(&messages);
    array_free(position);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clouds),
        cmocka_unit_test(test_small_and_degenerate),
        cmocka_unit_test(test_lattice_stencil),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_reproducible_and_reused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
