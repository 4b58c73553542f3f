/* The largest step on grounds drawn by chance against the largest eigenvalue of the run's own operator, which a power
 * iteration of its own finds (doc/theory/general-ground.md, section 6): blocks, layers, tilted or graded, moduli and masses
 * that differ from point to point, hills, ridges and canyons, absorbing layers, in two and three dimensions. */
#include "from_deck.h"
#include "general_run.h"

#include "few.h"
#include "method/methods.h"

#include <math.h>

enum { GROUNDS = 50, POWERS = 800, DECK = 4000 };

static double even(double low, double high)
{
    return low + (high - low) * log2(chance(1, 2));
}

__attribute__((format(printf, 2, 3))) static void add(char *deck, const char *format, ...)
{
    const size_t length = strlen(deck);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(deck + length, DECK - length, format, arguments);
    va_end(arguments);
}

/* A vector of a deck: the first two or all three. */
static void add_place(char *deck, const char *name, int dimension, double x, double y, double z)
{
    if (dimension == 2)
        add(deck, ", %s = %.6f, %.6f", name, x, z);
    else
        add(deck, ", %s = %.6f, %.6f, %.6f", name, x, y, z);
}

static const char *rock(void)
{
    static const char *const name[] = {"a", "b", "c"};
    return name[(int)even(0, 3)];
}

/* Speeds 1 : 6, densities 1 : 2, Poisson's ratio 0 to .45. */
static void add_materials(char *deck)
{
    for (int i = 0; i < 3; i++) {
        const double poisson = even(0, .45), s = chance(.5, 3);
        add(deck, "&material name = '%c', density = %.6f, p_speed = %.6f, s_speed = %.6f /\n", 'a' + i,
            chance(1, 2), s * sqrt((2 - 2 * poisson) / (1 - 2 * poisson)), s);
    }
}

static void draw_deck(int ground, char *deck)
{
    const int dimension = 2 + ground % 2;
    const bool layered = dimension == 3 && chance(1, 2) > 1.4;
    const char *const down = dimension == 3 ? "z-" : "y-";
    snprintf(deck, DECK, "&scene dimension = %d, end_time = 1 /\n&method operator = 'general' /\n",
             dimension);
    add_materials(deck);
    add(deck, "&body spacing = .25%s", layered ? "" : ", material = 'a'");
    add_place(deck, "low", dimension, 0, 0, 0);
    add_place(deck, "high", dimension, 1.75, 1.25, 1.5);
    add(deck, " /\n");
    if (layered) {
        const bool graded = chance(1, 2) > 1.6;
        add(deck, "&layer material = '%s', top = 0%s%s%s /\n", rock(), graded ? ", bottom = '" : "",
            graded ? rock() : "", graded ? "'" : "");
        add(deck, "&layer material = '%s', top = %.6f, dip = %.3f, strike = %.3f /\n", rock(), even(.5, .9),
            even(0, 12), even(0, 360));
    }
    for (int block = 0; block < 3; block++) {
        add(deck, "&block material = '%c', shape = '%s'", 'a' + block,
            chance(1, 2) > 1.4 ? "box" : "ellipsoid");
        add_place(deck, "centre", dimension, even(0, 1.75), even(0, 1.25), even(0, 1.5));
        add_place(deck, "size", dimension, chance(.1, 1.5), chance(.1, 1.5), chance(.1, 1.5));
        add(deck, " /\n");
    }
    if (chance(1, 2) > 1.3) {
        const double width = chance(.3, 1.2), slope = even(.1, .95);
        static const char *const shape[] = {"gaussian", "ridge", "canyon"};
        add(deck, "&topography shape = '%s', height = %.6f, width = %.6f, centre = %.6f",
            shape[(int)even(0, 3)], fmin(.3, slope * width * exp(.5)), width, even(.4, 1.3));
        if (dimension == 3) add(deck, ", %.6f", even(.4, .9));
        add(deck, " /\n");
    }
    if (chance(1, 2) > 1.5)
        add(deck,
            "&boundary face = '%s', kind = 'transmitting', layer = 'pml', layer_points = 4, always = T /\n",
            ground % 3 == 0  ? "x+"
            : dimension == 3 ? "z+"
                             : "y+");
    add(deck, "&load face = '%s', shape = 'square'", down);
    add(deck, dimension == 3 ? ", centre = .9, .6, depth = 0, size = .5, .5, direction = 0, 0, 1"
                             : ", centre = .9, depth = 0, size = .5, direction = 0, 1");
    add(deck, ", history = 'triangle', duration = 1 /\n");
}

/* From |A^n x| / |A^(n-1) x|, A = M^-1 K, by which every part of a chance x but the greatest falls behind: too small by
 * log(unknowns) / 4n of itself, .3 %, at most. */
static double greatest_frequency(struct model *model)
{
    const size_t n = model->unknowns;
    double *y = calloc(model->state_size, sizeof *y), *a = calloc(n, sizeof *a), found = 0;
    for (size_t i = 0; i < n; i++)
        y[i] = chance(1, 3) - 2;
    for (int power = 0; power < POWERS; power++) {
        model->spatial->accelerate(model, &(struct drive){0}, 0, y, NULL, a);
        const double norm = sqrt(dot(n, a, a));
        found = norm;
        for (size_t i = 0; i < n; i++)
            y[i] = a[i] / norm;
    }
    free(y);
    free(a);
    return sqrt(found);
}

static void test_largest_step(void **state)
{
    (void)state;
    double least = INFINITY, most = 0;
    for (int ground = 0; ground < few_of(GROUNDS, 2); ground++) {
        char deck[DECK];
        draw_deck(ground, deck);
        struct from_deck made = right_scene(deck);
        struct messages messages = {0};
        struct model *model = NULL;
        struct stepper *stepper = NULL;
        assert_int_equal(model_create(made.scene, &model, &messages), SELAS_OK);
        if (ground % 4 > 1) make_random_within(consistent_of(model), 1 / sqrt(6), sqrt(6));
        assert_int_equal(stepper_create(model, &stepper, &messages), SELAS_OK);
        const double ratio = stepper->limit * greatest_frequency(model) / 2;
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        stepper_free(&stepper);
        model_free(&model);
        messages_free(&messages);
        from_deck_free(&made);
    }
    print_message("limit over that of the greatest eigenvalue: %.5f to %.5f\n", least, most);
    assert_true(least > .99 && most < 1.003);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_largest_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
