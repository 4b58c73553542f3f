/* Sections of snapshots as images: values at true places under a hill, nothing above it. */
#include "base/memory.h"
#include "record/plots/section.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { ALONG = 17, ACROSS = 9, POINTS = ALONG * ACROSS };

static double top_of(double x)
{
    return -.5 * exp(-x * x);
}

static double field(double x, double z)
{
    return sin(1.1 * x + .7 * z);
}

/* Columns from the surface to z = 2, x from -2 to 2; `height` of the hill. */
static struct section cut_of(double height, double value[POINTS])
{
    struct section section = {
        .along = ALONG, .across = ACROSS, .points = POINTS, .low = {-2, 0}, .high = {2, 2}};
    section.coordinate = array_new(2 * POINTS, sizeof *section.coordinate);
    assert_non_null(section.coordinate);
    for (size_t k = 0; k < POINTS; k++) {
        const double x = -2 + 4. * (double)(k % ALONG) / (ALONG - 1), top = height * top_of(x);
        const double z = top + (2 - top) * (double)(k / ALONG) / (ACROSS - 1);
        section.coordinate[2 * k] = (float)x;
        section.coordinate[2 * k + 1] = (float)z;
        section.low[1] = fmin(section.low[1], z);
        value[k] = field(x, z);
    }
    image_prepare(&section);
    return section;
}

static void test_pixels(void **state)
{
    (void)state;
    for (int hill = 0; hill < 2; hill++) {
        double value[POINTS], error = 0;
        struct section section = cut_of(hill, value);
        assert_true(section.regular);
        assert_int_equal(section.row != NULL, hill);
        FILE *data = tmpfile();
        assert_non_null(data);
        assert_true(image_write(&section, value, 1, data));
        rewind(data);
        const double step[2] = {4. / (double)(section.fine[0] - 1),
                                (2 - section.low[1]) / (double)(section.fine[1] - 1)};
        size_t seen = 0, above = 0;
        for (size_t j = 0; j < section.fine[1]; j++)
            for (size_t i = 0; i < section.fine[0]; i++) {
                const double x = -2 + step[0] * (double)i, z = section.low[1] + step[1] * (double)j;
                float pixel;
                assert_int_equal(fread(&pixel, sizeof pixel, 1, data), 1);
                if (isnan(pixel))
                    above++;
                else
                    error = fmax(error, fabs((double)pixel - field(x, z)));
                if (isnan(pixel)) assert_true(z < hill * top_of(x) + step[1]);
                if (z < hill * top_of(x) - 1.5 * step[1]) assert_true(isnan(pixel));
                seen++;
            }
        fclose(data);
        print_message("# %zu pixels, %zu above the surface, error %.1e\n", seen, above, error);
        /* half a cell inside the edges, whose points are repeated: a sixteenth of the change over a cell */
        assert_true(error < 1.1 * (.25 * 1.1 + .3125 * .7) / 16);
        assert_true((above > 0) == (hill == 1));
        array_free(section.coordinate);
        array_free(section.row);
    }
}

/* Points that do not ascend are drawn as they are. */
static void test_folded(void **state)
{
    (void)state;
    double value[POINTS];
    struct section section = cut_of(0, value);
    section.regular = false;
    section.coordinate[2 * (3 * ALONG + 4) + 1] = 1.9F;
    image_prepare(&section);
    assert_false(section.regular);
    array_free(section.coordinate);
    array_free(section.row);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pixels), cmocka_unit_test(test_folded)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
