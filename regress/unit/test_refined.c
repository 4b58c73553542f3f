/* scene%accuracy on general ground with trials that are made up: velocities whose errors are known. */
#include "accuracy/accuracy.h"
#include "accuracy/grade.h"
#include "base/memory.h"
#include "damping/ground.h"
#include "from_deck.h"

#include <math.h>
#include <stdlib.h>

#define SCENE(accuracy, soil, rock)                                                                          \
    "&scene dimension = 2, end_time = 12, accuracy = " accuracy " /\n"                                       \
    "&material name = 'soil', density = 1, p_speed = 1, s_speed = .5" soil " /\n"                            \
    "&material name = 'rock', density = 1.3, p_speed = 2.6, s_speed = 1.5" rock " /\n"                       \
    "&body shape = 'half-space', material = 'rock' /\n"                                                      \
    "&block material = 'soil', shape = 'ellipsoid', centre = 0, 0, size = 4, 1.6 /\n"                        \
    "&load kind = 'body-force', shape = 'point', centre = 1.5, 3, direction = .3, 1, history = "             \
    "'gaussian',\n"                                                                                          \
    " width = .5, delay = 2.5 /\n"                                                                           \
    "&receiver name = 'm', position = 0, 0 /\n"
#define DAMPED(accuracy) SCENE(accuracy, ", q_p = 40, q_s = 20", ", q_p = 100, q_s = 60")

/* Of vx: what a spacing errs, with the power that is taken; of the fit: what mechanisms are off constant Q. */
static const double power = 3.2;
static double coarse = 10, of_fit;

/* Of the one damped scene, whatever its spacing. */
static double fit_of(const struct scene *scene, size_t mechanisms)
{
    static double known[MOST_MECHANISMS + 1];
    if (known[mechanisms] > 0) return known[mechanisms];
    struct scene tried = *scene;
    struct ground_damping *damping = NULL;
    struct messages messages = {0};
    tried.method.mechanisms = mechanisms;
    assert_int_equal(ground_damping_new(&tried, true, &damping, &messages), SELAS_OK);
    known[mechanisms] = ground_damping_off(damping);
    ground_damping_free(damping);
    return known[mechanisms];
}

static selas_status made_up(struct scene *scene, struct exact *exact, double *error,
                            struct history_file *kept, struct messages *messages)
{
    enum { ROWS = 400 };
    (void)exact, (void)error, (void)messages;
    kept->rows = ROWS;
    kept->time = array_new(ROWS, sizeof *kept->time);
    kept->value = array_new((size_t)DIFF_CHANNELS * ROWS, sizeof *kept->value);
    assert_non_null(kept->time);
    assert_non_null(kept->value);
    const double off = of_fit > 0 ? of_fit * fit_of(scene, scene->method.mechanisms) : 0;
    for (int k = 0; k < ROWS; k++) {
        double *value = kept->value + (size_t)DIFF_CHANNELS * (size_t)k;
        const double phase = 2 * M_PI * k / (double)ROWS;
        kept->time[k] = scene->end_time * k / (ROWS - 1);
        value[3] = sin(phase);
        value[4] = coarse * pow(scene->body.spacing, power) * sin(2 * phase);
        value[5] = off * sin(3 * phase);
    }
    return SELAS_OK;
}

static struct from_deck chosen(const char *text)
{
    struct from_deck d = {0};
    d.status = deck_read_text("t.nml", text, strlen(text), 0, NULL, &d.deck, &d.messages);
    assert_int_equal(d.status, SELAS_OK);
    d.status = accuracy_build(d.deck, made_up, &d.scene, &d.messages);
    return d;
}

/* The spacing errs .45 of what is wanted, whatever the damping; the work is four times as much with it. */
static void spacing(void **unused)
{
    (void)unused;
    of_fit = 0;
    struct from_deck damped = chosen(DAMPED(".03")), plain = chosen(SCENE(".03", "", ""));
    assert_non_null(damped.scene);
    assert_non_null(plain.scene);
    assert_near(coarse * pow(damped.scene->body.spacing, power), .45 * .03, .02 * .03);
    assert_near(plain.scene->body.spacing, damped.scene->body.spacing, 1e-3 * plain.scene->body.spacing);
    assert_near(accuracy_work(damped.scene) / accuracy_work(plain.scene), 4, .05);
    assert_null(strstr(plain.scene->body.accuracy, "mechanisms"));
    from_deck_free(&damped);
    from_deck_free(&plain);
}

/* The fewest that are off by .3 of what is wanted at most; the plan says by how much. */
static void mechanisms(void **unused)
{
    (void)unused;
    struct from_deck any = chosen(DAMPED(".03"));
    assert_non_null(any.scene);
    for (size_t n = 1; n < MOST_MECHANISMS; n++) {
        of_fit = .95 * .3 * .03 / fit_of(any.scene, n);
        struct from_deck d = chosen(DAMPED(".03"));
        assert_non_null(d.scene);
        assert_int_equal(d.scene->method.mechanisms, n);
        const char *said = strstr(d.scene->body.accuracy, "mechanisms, ");
        assert_non_null(said);
        assert_near(strtod(said + strlen("mechanisms, "), NULL), .95 * .3 * .03, .05 * .3 * .03);
        from_deck_free(&d);
    }
    from_deck_free(&any);
}

static void too_few(void **unused)
{
    (void)unused;
    of_fit = 0;
    struct from_deck any = chosen(DAMPED(".03"));
    assert_non_null(any.scene);
    of_fit = 1.1 * .3 * .03 / fit_of(any.scene, MOST_MECHANISMS - 1);
    struct from_deck d = chosen(DAMPED(".03"));
    assert_null(d.scene);
    assert_int_equal(d.status, SELAS_BAD_SCENE);
    assert_non_null(strstr(d.messages.text, "is out of reach here: 7 relaxation mechanisms are 0.009"));
    from_deck_free(&d);
    from_deck_free(&any);
}

/* All speeds of a model: the first guess needs none. */
static void model_alone(void **unused)
{
    (void)unused;
    FILE *file = fopen("build/test/guess.xyz", "w");
    assert_non_null(file);
    fputs("0 0 -2000 2000 2000 0\n2000 2000 2000\n2 2 2\n1800 1800 1000 1000 2000 2000\n", file);
    for (int i = 0; i < 8; i++)
        fprintf(file, "%d %d %d 1800 1000 2000 60 30\n", 2000 * (i % 2), 2000 * (i / 2 % 2),
                2000 * (i / 4) - 2000);
    assert_int_equal(fclose(file), 0);
    of_fit = 0;
    coarse = .45 * .08 / pow(250, power);
    struct from_deck d =
        chosen("&scene dimension = 3, end_time = 3.5, accuracy = .08 /\n"
               "&body low = 0, 0, 0, high = 1600, 1600, 1200 /\n"
               "&model file = 'build/test/guess.xyz', origin = 0, 0 /\n"
               "&load kind = 'body-force', shape = 'point', centre = 800, 800, 600, direction = 0, 0, 1,\n"
               " history = 'gaussian', width = .5, delay = 2 /\n"
               "&receiver name = 'a', position = 300, 500, 0 /\n");
    assert_non_null(d.scene);
    assert_int_equal(d.scene->method.mechanisms, 1);
    coarse = 10;
    from_deck_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spacing),
        cmocka_unit_test(mechanisms),
        cmocka_unit_test(too_few),
        cmocka_unit_test(model_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
