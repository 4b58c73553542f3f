/* Seismograms against independent routes at single frequencies (closed forms of a damped whole space,
 * Mindlin's static half-space, reciprocity, cut layers, one-dimensional echoes) and in time (contours,
 * causality). */
#include "exact/seismogram_work.h"
#include "seismic.h"

static const struct history none = {.kind = HISTORY_STEP};

/* Displacements and stresses of `receivers` at one frequency per unit of the histories, to about
 * exp(-digits). */
static void at_frequency(const struct seismogram_problem *problem, size_t receivers, const double (*place)[3],
                         double complex s, double digits, double complex *value)
{
    struct seismogram seismogram[8] = {0};
    struct messages messages = {0};
    struct sums sums;
    struct band band;
    for (size_t r = 0; r < receivers; r++)
        memcpy(seismogram[r].position, place[r], sizeof seismogram[r].position);
    assert_int_equal(sums_set(&sums, problem, receivers, seismogram, &messages), SELAS_OK);
    band_set(&band, problem, s, s);
    assert_true(sums_at(&sums, &band, (struct finesse){digits, 1}, 1, &s, true, value));
    sums_free(&sums);
}

static double size_of(size_t n, const double complex *value)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += creal(value[i] * conj(value[i]));
    return sqrt(sum);
}

static double difference_of(size_t n, const double complex *a, const double complex *b)
{
    double complex off[16];
    for (size_t i = 0; i < n; i++)
        off[i] = a[i] - b[i];
    return size_of(n, off) / size_of(n, b);
}

/* --- Whole space ---------------------------------------------------------------------------------------- */

/* d_i d_j of exp(-kappa r)/r, and the value itself. */
static void wave(double complex kappa, const double g[3], double r, double complex *value,
                 double complex second[3][3])
{
    const double complex x = kappa * r, e = cexp(-x);
    const double complex slope = -(x + 1) * e / (r * r), curve = (x * x + 2 * x + 2) * e / (r * r * r);
    *value = e / r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            second[i][j] = (curve - slope / r) * g[i] * g[j] + (i == j ? slope / r : 0);
}

/* Aki & Richards (2002), Eq 4.12 and after, over s: displacement at `away` from a force. */
static void stokes(const struct seismogram_rock *rock, double complex s, const double away[3],
                   const double force[3], double complex u[3])
{
    const double complex mu = modulus_at(&rock->shear, s), pi = modulus_at(&rock->axial, s);
    const double r = sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    const double g[3] = {away[0] / r, away[1] / r, away[2] / r};
    double complex slow, fast, slow2[3][3], fast2[3][3];
    wave(s * csqrt(rock->density / mu), g, r, &slow, slow2);
    wave(s * csqrt(rock->density / pi), g, r, &fast, fast2);
    for (int i = 0; i < 3; i++) {
        u[i] = 0;
        for (int j = 0; j < 3; j++)
            u[i] += force[j] / (4 * M_PI) *
                    ((i == j ? slow : 0) / mu - (slow2[i][j] - fast2[i][j]) / (rock->density * s * s));
    }
}

/* Minus M_jl d/dx_l of that, by central differences of sixth order. */
static void stokes_moment(const struct seismogram_rock *rock, double complex s, const double away[3],
                          const double moment[6], double complex u[3])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    static const double weight[3] = {.75, -.15, 1. / 60}, step = .01;
    u[0] = u[1] = u[2] = 0;
    for (int l = 0; l < 3; l++) {
        const double force[3] = {moment[place[l][0]], moment[place[l][1]], moment[place[l][2]]};
        for (int n = -3; n <= 3; n++) {
            double complex part[3];
            double at[3] = {away[0], away[1], away[2]};
            if (n == 0) continue;
            at[l] += step * n;
            stokes(rock, s, at, force, part);
            for (int i = 0; i < 3; i++)
                u[i] -= (n > 0 ? 1 : -1) * weight[abs(n) - 1] * part[i] / step;
        }
    }
}

static void whole_space_is_stokes(void **state)
{
    (void)state;
    static const double away[6][3] = {{.7, -.4, .9},   {1.1, .6, 0}, {0, 0, 1.3},
                                      {-.8, .3, -1.2}, {0, 0, -.9},  {2, 1, .02}};
    static const double complex s[3] = {.5, .7 + 1.5 * I, .6 + 9 * I};
    const double deep = 120;
    double worst[2] = {0, 0};
    const struct seismogram_rock rock = seismic_rock(0, 1.3, 1.9, 1.1, 60, 30, 3);
    for (int kind = 0; kind < 9; kind++)
        for (int f = 0; f < 3; f++) {
            struct seismogram_source source = seismic_source(.2, -.1, deep, &none);
            if (kind < 3)
                source.force[kind] = 1;
            else
                source.moment[kind - 3] = 1;
            const struct seismogram_problem problem = {
                .rocks = 1, .rock = &rock, .sources = 1, .source = &source};
            double place[6][3];
            double complex value[6 * COMPONENTS];
            for (int r = 0; r < 6; r++)
                for (int c = 0; c < 3; c++)
                    place[r][c] = source.position[c] + away[r][c];
            at_frequency(&problem, 6, (const double(*)[3])place, s[f], 28, value);
            for (int r = 0; r < 6; r++) {
                double complex wanted[3];
                if (kind < 3)
                    stokes(&rock, s[f], away[r], source.force, wanted);
                else
                    stokes_moment(&rock, s[f], away[r], source.moment, wanted);
                if (size_of(3, wanted) < 1e-12) continue;
                const double error = difference_of(3, value + r * COMPONENTS, wanted);
                worst[kind >= 3] = fmax(worst[kind >= 3], error);
            }
        }
    print_message("damped whole space: forces %.1e, moments %.1e\n", worst[0], worst[1]);
    assert_true(worst[0] < 1e-9);
    assert_true(worst[1] < 2e-8); /* the differences' own */
}

/* --- At rest -------------------------------------------------------------------------------------------- */

/* Mindlin, Physics 7 (1936) 195-202: vertical force at depth c, place (r, z). */
static void mindlin(double mu, double nu, double c, double r, double z, double u[2])
{
    const double r1 = hypot(r, z - c), r2 = hypot(r, z + c), k = 3 - 4 * nu, p = z + c, m = z - c;
    const double factor = 1 / (16 * M_PI * mu * (1 - nu));
    u[0] = factor * r *
           (m / pow(r1, 3) + k * m / pow(r2, 3) - 4 * (1 - nu) * (1 - 2 * nu) / (r2 * (r2 + p)) +
            6 * c * z * p / pow(r2, 5));
    u[1] = factor * (k / r1 + (8 * (1 - nu) * (1 - nu) - k) / r2 + m * m / pow(r1, 3) +
                     (k * p * p - 2 * c * z) / pow(r2, 3) + 6 * c * z * p * p / pow(r2, 5));
}

static void rest_is_mindlins(void **state)
{
    (void)state;
    const struct seismogram_rock rock = seismic_rock(0, 1, sqrt(3), 1, 0, 0, 0);
    static const double place[5][3] = {{1, 0, 0}, {1.5, 0, .7}, {.4, 0, 2}, {3, 0, .7}, {0, 0, 1.9}};
    double worst = 0;
    for (int depth = 0; depth < 2; depth++) {
        struct seismogram_source source = seismic_source(0, 0, .7 * depth, &none);
        source.force[2] = 1;
        const struct seismogram_problem problem = {
            .rocks = 1, .rock = &rock, .sources = 1, .source = &source};
        double complex value[5 * COMPONENTS];
        at_frequency(&problem, 5, place, 1e-9, 28, value);
        for (int r = 0; r < 5; r++) {
            double wanted[2];
            mindlin(1, .25, .7 * depth, place[r][0], place[r][2], wanted);
            const double complex *u = value + r * COMPONENTS;
            worst = fmax(worst,
                         hypot(cabs(u[0] - wanted[0]), cabs(u[2] - wanted[1])) / hypot(wanted[0], wanted[1]));
        }
    }
    print_message("half-space at rest against Mindlin: %.1e\n", worst);
    assert_true(worst < 2e-8); /* the frequency times the time of a wave is 4e-9 */
}

/* --- Layers --------------------------------------------------------------------------------------------- */

/* Soft over hard over middling, damped. */
static size_t layers(struct seismogram_rock rock[3])
{
    rock[0] = seismic_rock(0, 1.1, 1.3, .6, 30, 20, 4);
    rock[1] = seismic_rock(.8, 1.9, 3.1, 1.7, 90, 50, 4);
    rock[2] = seismic_rock(1.5, 1.5, 2.2, 1.2, 60, 30, 4);
    return 3;
}

static const double complex frequencies[3] = {.4, .5 + 2 * I, .45 + 11 * I};

static void sources_and_receivers_can_be_exchanged(void **state)
{
    (void)state;
    static const double place[4][3] = {{0, 0, 0}, {1.2, .4, .5}, {-.3, 1.6, 1.1}, {.9, -1.3, 2.4}};
    struct seismogram_rock rock[3];
    double worst = 0;
    const size_t rocks = layers(rock);
    for (int f = 0; f < 3; f++)
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++) {
                double complex there[3][3], back[3][3], value[COMPONENTS];
                for (int way = 0; way < 2; way++)
                    for (int i = 0; i < 3; i++) {
                        const double *from = place[way == 0 ? a : b], *to = place[way == 0 ? b : a];
                        struct seismogram_source source = seismic_source(from[0], from[1], from[2], &none);
                        source.force[i] = 1;
                        const struct seismogram_problem problem = {
                            .rocks = rocks, .rock = rock, .sources = 1, .source = &source};
                        at_frequency(&problem, 1, (const double(*)[3])to, frequencies[f], 28, value);
                        for (int j = 0; j < 3; j++)
                            *(way == 0 ? &there[j][i] : &back[i][j]) = value[j];
                    }
                worst = fmax(worst, difference_of(9, there[0], back[0]));
            }
    print_message("reciprocity of forces: %.1e\n", worst);
    assert_true(worst < 1e-9);
}

/* A moment tensor's displacement along d is the tensor times the strain that a force along d makes in its
 * place. */
static void moments_are_reciprocal_to_strains(void **state)
{
    (void)state;
    static const double place[4][3] = {{.2, 0, 0}, {1.2, .4, .5}, {-.3, 1.6, 1.1}, {.9, -1.3, 2.4}};
    struct seismogram_rock rock[3];
    double worst = 0;
    const size_t rocks = layers(rock);
    for (int f = 0; f < 3; f++)
        for (int a = 1; a < 4; a++)
            for (int b = 0; b < 4; b++) {
                if (a == b) continue;
                const size_t here = a == 1 ? 0 : a == 2 ? 1 : 2;
                const double complex s = frequencies[f], mu = modulus_at(&rock[here].shear, s);
                const double complex lambda = modulus_at(&rock[here].axial, s) - 2 * mu;
                double complex direct[18], strain[18], value[COMPONENTS];
                for (int m = 0; m < 6; m++) {
                    struct seismogram_source source =
                        seismic_source(place[a][0], place[a][1], place[a][2], &none);
                    source.moment[m] = 1;
                    const struct seismogram_problem problem = {
                        .rocks = rocks, .rock = rock, .sources = 1, .source = &source};
                    at_frequency(&problem, 1, &place[b], s, 28, value);
                    for (int i = 0; i < 3; i++)
                        direct[3 * m + i] = value[i];
                }
                for (int i = 0; i < 3; i++) {
                    struct seismogram_source source =
                        seismic_source(place[b][0], place[b][1], place[b][2], &none);
                    source.force[i] = 1;
                    const struct seismogram_problem problem = {
                        .rocks = rocks, .rock = rock, .sources = 1, .source = &source, .stress = true};
                    at_frequency(&problem, 1, &place[a], s, 28, value);
                    const double complex *t = value + 3, trace = t[0] + t[1] + t[2];
                    for (int m = 0; m < 6; m++) /* a component off the diagonal stands for two */
                        strain[3 * m + i] = m < 3 ? (t[m] - lambda / (3 * lambda + 2 * mu) * trace) / (2 * mu)
                                                  : 2 * t[m] / (2 * mu);
                }
                for (int m = 0; m < 6; m++)
                    if (size_of(3, strain + 3 * m) > 1e-6 * size_of(18, strain))
                        worst = fmax(worst, difference_of(3, direct + 3 * m, strain + 3 * m));
            }
    print_message("moments against strains: %.1e\n", worst);
    assert_true(worst < 1e-7);
}

static void cut_layers_are_one(void **state)
{
    (void)state;
    static const double place[3][3] = {{1.2, .4, 0}, {.3, .9, .55}, {.9, -1.3, 2.4}};
    struct seismogram_rock rock[3], cut[13];
    double worst = 0;
    const size_t rocks = layers(rock);
    for (int i = 0; i < 10; i++) {
        cut[i] = rock[0];
        cut[i].top = .08 * i;
    }
    cut[10] = rock[1];
    cut[11] = rock[1];
    cut[11].top = 1.05;
    cut[12] = rock[2];
    for (int f = 0; f < 3; f++)
        for (int m = 0; m < 9; m++) {
            struct seismogram_source source = seismic_source(0, 0, .36, &none);
            if (m < 3)
                source.force[m] = 1;
            else
                source.moment[m - 3] = 1;
            struct seismogram_problem problem = {
                .rocks = rocks, .rock = rock, .sources = 1, .source = &source};
            double complex whole[3 * COMPONENTS], parts[3 * COMPONENTS];
            at_frequency(&problem, 3, place, frequencies[f], 28, whole);
            problem.rocks = 13;
            problem.rock = cut;
            at_frequency(&problem, 3, place, frequencies[f], 28, parts);
            for (int r = 0; r < 3; r++)
                worst = fmax(worst, difference_of(3, parts + r * COMPONENTS, whole + r * COMPONENTS));
        }
    print_message("a layer cut into ten: %.1e\n", worst);
    assert_true(worst < 1e-9);
}

/* A force far below a layer of thickness 1 against a plane wave: largest relative difference on the surface
 * above. */
static double off_one_dimension(double deep)
{
    static const double place[1][3] = {{0, 0, 0}};
    const struct seismogram_rock rock[2] = {seismic_rock(0, 1.1, 1.3, .6, 0, 0, 1),
                                            seismic_rock(1, 1.9, 3.1, 1.7, 0, 0, 1)};
    double worst = 0;
    for (int axis = 0; axis < 3; axis += 2)
        for (int f = 0; f < 4; f++) {
            struct seismogram_source source = seismic_source(0, 0, deep, &none);
            source.force[axis] = 1;
            const struct seismogram_problem problem = {
                .rocks = 2, .rock = rock, .sources = 1, .source = &source};
            const double complex s = 1 / deep + (1 + .55 * f) * I;
            double complex value[COMPONENTS], below[3]; /* in the lower rock alone, where the layer begins */
            at_frequency(&problem, 1, place, s, 20, value);
            stokes(&rock[1], s, (const double[3]){0, 0, 1 - deep}, source.force, below);
            const double upper = axis == 2 ? 1.3 : .6, lower = axis == 2 ? 3.1 : 1.7;
            const double z1 = 1.1 * upper, z2 = 1.9 * lower, t = 2 * z2 / (z1 + z2);
            const double complex x = s / upper;
            const double complex wanted =
                below[axis] * 2 * t * cexp(-x) / (1 - (z1 - z2) / (z1 + z2) * cexp(-2 * x));
            worst = fmax(worst, cabs(value[axis] - wanted) / cabs(wanted));
        }
    return worst;
}

/* Waves that come from far below are plane and vertical: what differs falls like 1/depth. */
static void far_field_is_one_dimensional(void **state)
{
    (void)state;
    const double near = off_one_dimension(200), far = off_one_dimension(1000);
    print_message("layer over a far source against one dimension: %.1e, five times as far %.1e\n", near, far);
    assert_true(far < 1e-2);
    assert_true(far < .25 * near);
}

/* --- In time -------------------------------------------------------------------------------------------- */

static void contours_agree(void **state)
{
    (void)state;
    const struct history history = {.kind = HISTORY_GAUSSIAN, .width = .25, .delay = 1.8};
    struct seismogram_rock rock[3];
    const size_t rocks = layers(rock);
    struct seismogram_source source[2] = {seismic_source(0, 0, 1.1, &history),
                                          seismic_source(.5, .3, .2, &history)};
    source[0].moment[3] = 1;
    source[0].moment[5] = -.6;
    source[1].force[2] = .4;
    struct seismogram_problem problem = {.rocks = rocks,
                                         .rock = rock,
                                         .sources = 2,
                                         .source = source,
                                         .end_time = 5,
                                         .tolerance = 3e-8,
                                         .stress = true};
    struct seismogram one[2] = {{.position = {1.4, .9, 0}}, {.position = {-.8, 1.1, 1.1}}};
    struct seismogram other[2] = {one[0], one[1]};
    seismic_compute(&problem, 2, one);
    problem.stretch = 2.3;
    problem.tolerance = 1e-8;
    seismic_compute(&problem, 2, other);
    double worst = 0, largest[2][4] = {{0}};
    for (int r = 0; r < 2; r++)
        for (int pass = 0; pass < 2; pass++)
            for (size_t line = 0; line < SEISMOGRAM_LINES; line++) {
                double difference, size;
                seismic_norms(&one[r], line, &other[r], line, 1, &difference, &size);
                if (pass == 0) largest[r][line / 3] = fmax(largest[r][line / 3], size);
                if (pass == 1)
                    worst =
                        fmax(worst, difference / fmax(largest[r][line / 3], line < 6 ? 0 : largest[r][2]));
            }
    print_message("two contours: %.1e; said to be reached: %.1e\n", worst, one[0].effort.reached);
    assert_true(worst < 1e-7);
    assert_true(one[0].effort.reached < 1e-7);
    for (int r = 0; r < 2; r++) {
        seismogram_free(&one[r]);
        seismogram_free(&other[r]);
    }
}

static void little_damping_is_none(void **state)
{
    (void)state;
    const struct history history = {.kind = HISTORY_GAUSSIAN, .width = .25, .delay = 1.8};
    struct seismogram_source source = seismic_source(0, 0, 1.1, &history);
    source.moment[4] = 1;
    struct seismogram seismogram[2] = {{.position = {1.4, .9, 0}}, {.position = {1.4, .9, 0}}};
    for (int i = 0; i < 2; i++) {
        const double q = i == 0 ? 0 : 1e6;
        const struct seismogram_rock rock[2] = {seismic_rock(0, 1.1, 1.3, .6, q, q, 4),
                                                seismic_rock(.8, 1.9, 3.1, 1.7, q, q, 4)};
        const struct seismogram_problem problem = {
            .rocks = 2, .rock = rock, .sources = 1, .source = &source, .end_time = 6, .tolerance = 1e-7};
        seismic_compute(&problem, 1, &seismogram[i]);
    }
    double difference, size, worst = 0, largest = 0;
    for (size_t line = 3; line < 6; line++) {
        seismic_norms(&seismogram[0], line, &seismogram[1], line, 1, &difference, &size);
        worst = fmax(worst, difference);
        largest = fmax(largest, size);
    }
    print_message("Q = 1e6 against none: %.1e\n", worst / largest);
    assert_true(worst < 1e-4 * largest && worst > 1e-7 * largest);
    seismogram_free(&seismogram[0]);
    seismogram_free(&seismogram[1]);
}

/* Nothing before the first P wave, and little work where nothing has come yet. */
static void nothing_comes_early(void **state)
{
    (void)state;
    const struct history history = {.kind = HISTORY_GAUSSIAN, .width = .1, .delay = .8};
    struct seismogram_rock rock[3];
    layers(rock);
    for (int i = 0; i < 3; i++) { /* elastic: damped waves have no sharp front */
        const double speed = i == 0 ? 1.3 : i == 1 ? 3.1 : 2.2, slow = i == 0 ? .6 : i == 1 ? 1.7 : 1.2;
        rock[i] = seismic_rock(rock[i].top, rock[i].density, speed, slow, 0, 0, 1);
    }
    struct seismogram_source source = seismic_source(0, 0, .4, &history);
    source.moment[0] = 1;
    struct seismogram_problem problem = {
        .rocks = 3, .rock = rock, .sources = 1, .source = &source, .end_time = 9, .tolerance = 1e-6};
    struct seismogram seismogram = {.position = {12, 0, 0}};
    seismic_compute(&problem, 1, &seismogram);
    double early = 0, largest = 0;
    for (int i = 0; i < 900; i++) {
        double value[SEISMOGRAM_LINES];
        const double t = .01 * i;
        seismogram_at(&seismogram, t, value);
        for (int c = 3; c < 6; c++) {
            if (t < 12 / 3.1) early = fmax(early, fabs(value[c]));
            largest = fmax(largest, fabs(value[c]));
        }
    }
    print_message("before the first wave: %.1e of the largest\n", early / largest);
    assert_true(early < 3e-6 * largest);
    const double whole = seismogram.effort.evaluations;
    seismogram_free(&seismogram);
    problem.end_time = 1.5; /* nothing is there yet */
    seismic_compute(&problem, 1, &seismogram);
    assert_true(seismogram.effort.evaluations < whole);
    seismogram_free(&seismogram);
}

static void impossible_places_are_refused(void **state)
{
    (void)state;
    const struct seismogram_rock rock = seismic_rock(0, 1, 2, 1, 0, 0, 1);
    struct seismogram_source source = seismic_source(0, 0, 1, &none);
    source.force[2] = 1;
    const struct seismogram_problem problem = {
        .rocks = 1, .rock = &rock, .sources = 1, .source = &source, .end_time = 1};
    static const double place[2][3] = {{0, 0, 1}, {1, 0, -.1}};
    static const char *const words[2] = {"lies at a point source", "above the ground"};
    for (int i = 0; i < 2; i++) {
        struct seismogram seismogram = {.position = {place[i][0], place[i][1], place[i][2]}};
        struct messages messages = {0};
        assert_int_equal(seismograms(&problem, 1, &seismogram, &messages), SELAS_BAD_SCENE);
        assert_non_null(strstr(messages.text, words[i]));
        assert_null(seismogram.value);
        messages_free(&messages);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_space_is_stokes),
        cmocka_unit_test(rest_is_mindlins),
        cmocka_unit_test(sources_and_receivers_can_be_exchanged),
        cmocka_unit_test(moments_are_reciprocal_to_strains),
        cmocka_unit_test(cut_layers_are_one),
        cmocka_unit_test(far_field_is_one_dimensional),
        cmocka_unit_test(contours_agree),
        cmocka_unit_test(little_damping_is_none),
        cmocka_unit_test(nothing_comes_early),
        cmocka_unit_test(impossible_places_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
