/* Seismograms against histories that other programs made (regress/reference): patches on a half-space, with
 * and without damping by constant Q and by given mechanisms, and the benchmarks LOH.1 and LOH.3. */
#include "seismic.h"

enum { ROOM = 400 };

/* Largest of the relative L2 errors of velocity components `line[i]` against columns 1.. of the file. */
static double error_of(const struct seismogram *seismogram, const char *path, size_t columns,
                       const size_t *line, const double *factor)
{
    static double value[ROOM * 4];
    const size_t rows = seismic_rows(path, columns, ROOM, value);
    double missed[3] = {0}, size = 0;
    for (size_t c = 1; c < columns; c++) {
        double sum = 0;
        for (size_t i = 0; i < rows; i++) {
            double at[SEISMOGRAM_LINES];
            const double t = value[i * columns], wanted = value[i * columns + c];
            if (t > seismogram->end_time) continue;
            seismogram_at(seismogram, t, at);
            const double off = factor[c - 1] * at[line[c - 1]] - wanted;
            missed[c - 1] += off * off;
            sum += wanted * wanted;
        }
        size = fmax(size, sum);
    }
    return sqrt(fmax(missed[0], fmax(missed[1], missed[2])) / size);
}

/* Vertical traction on a square of edge 1, rho = 1; receivers x = 0, 1, 2 on the surface. */
static void patch(const struct seismogram_rock *rock, const struct history *history,
                  struct seismogram *seismogram)
{
    struct seismogram_source source = seismic_source(0, 0, 0, history);
    source.patch = (struct patch){.shape = PATCH_RECTANGLE, .half = {.5, .5}};
    source.force[2] = 1;
    const struct seismogram_problem problem = {
        .rocks = 1, .rock = rock, .sources = 1, .source = &source, .end_time = 10, .tolerance = 1e-6};
    for (int i = 0; i < 3; i++)
        seismogram[i] = (struct seismogram){.position = {i, 0, 0}};
    seismic_compute(&problem, 3, seismogram);
}

static void patch_files(const char *format, const struct seismogram_rock *rock, const struct history *history,
                        size_t columns, const size_t *line, double most)
{
    static const double factor[3] = {1, 1, 1};
    struct seismogram seismogram[3];
    patch(rock, history, seismogram);
    for (int i = 0; i < 3; i++) {
        char path[128];
        (void)snprintf(path, sizeof path, "regress/reference/%s_x%d%s.csv", format, i,
                       columns == 4 ? "_y0_z0" : "");
        const double error = error_of(&seismogram[i], path, columns, line, factor);
        print_message("%s: %.1e\n", path, error);
        assert_true(error < most);
        seismogram_free(&seismogram[i]);
    }
}

static void patch_on_half_space(void **state)
{
    (void)state;
    static const size_t line[3] = {5, 3, 4};
    const struct history smooth = {.kind = HISTORY_TRIANGLE, .duration = 2, .smoothing = 1};
    const struct seismogram_rock rock = seismic_rock(0, 1, sqrt(3), 1, 0, 0, 0);
    patch_files("lamb/nu0.25_smooth1", &rock, &smooth, 4, line, 2e-6);
}

static const struct history bell = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 2};
static const size_t x_and_z[2] = {3, 5};

static void patch_on_constant_q(void **state)
{
    (void)state;
    const struct seismogram_rock equal = seismic_rock(0, 1, sqrt(3), 1, 20, 20, M_PI);
    const struct seismogram_rock other = seismic_rock(0, 1, sqrt(3), 1, 100, 50, M_PI);
    patch_files("damped/const_20_20", &equal, &bell, 3, x_and_z, 1e-6);
    patch_files("damped/const_100_50", &other, &bell, 3, x_and_z, 1e-6);
}

static struct modulus mechanisms(double unrelaxed, const double weight[3])
{
    static const double rate[3] = {0.32918311541068257, 2.247213709180817, 14.034822837455103};
    struct modulus modulus = {.size = unrelaxed, .mechanisms = 3};
    memcpy(modulus.rate, rate, sizeof rate);
    memcpy(modulus.weight, weight, sizeof rate);
    return modulus;
}

static void patch_on_mechanisms(void **state)
{
    (void)state;
    static const double p[3] = {0.015981634400679835, 0.010182049707781046, 0.015658920377061243};
    static const double s[3] = {0.030892573227401653, 0.019933132266575556, 0.03108218060973822};
    static const double both[3] = {0.06973451372622277, 0.04671164936012833, 0.07595962509068271};
    const struct seismogram_rock equal = {.density = 1,
                                          .axial = mechanisms(3.2865845243380725, both),
                                          .shear = mechanisms(1.0955281747793577, both)};
    const struct seismogram_rock other = {
        .density = 1, .axial = mechanisms(3.056415815164731, p), .shear = mechanisms(1.0377672348445557, s)};
    patch_files("damped/gmb3_20_20", &equal, &bell, 3, x_and_z, 1e-6);
    patch_files("damped/gmb3_100_50", &other, &bell, 3, x_and_z, 1e-6);
}

/* Receiver 5: radial, transverse and vertical velocity are the displacement of a moment that is a Gaussian.
 */
static void loh(bool damped, const char *path)
{
    static const size_t line[3] = {0, 1, 2};
    static const double factor[3] = {1, 1, 1};
    const double width = damped ? .05 : .06, omega = 2 * M_PI * 2.5;
    const struct history history = {.kind = HISTORY_GAUSSIAN, .width = width, .delay = 6 * width};
    const struct seismogram_rock rock[2] = {
        seismic_rock(0, 2600, 4000, 2000, damped ? 120 : 0, damped ? 40 : 0, omega),
        seismic_rock(1000, 2700, 6000, 3464, damped ? 155.9 : 0, damped ? 69.3 : 0, omega)};
    /* turned about z so that the receiver lies on the x axis: M_xy = 1e18 becomes these */
    const double c = .6, s = .8, size = 1e18 / (width * sqrt(2 * M_PI));
    struct seismogram_source source = seismic_source(0, 0, 2000, &history);
    source.moment[0] = 2 * c * s * size;
    source.moment[1] = -2 * c * s * size;
    source.moment[3] = (c * c - s * s) * size;
    const struct seismogram_problem problem = {
        .rocks = 2, .rock = rock, .sources = 1, .source = &source, .end_time = 9, .tolerance = 1e-5};
    struct seismogram seismogram = {.position = {5000, 0, 0}};
    seismic_compute(&problem, 1, &seismogram);
    const double error = error_of(&seismogram, path, 4, line, factor);
    print_message("%s: %.1e\n", path, error);
    assert_true(error < 1e-5);
    seismogram_free(&seismogram);
}

static void benchmark_without_damping(void **state)
{
    (void)state;
    loh(false, "regress/reference/loh/loh1_sta05.csv");
}

static void benchmark_with_damping(void **state)
{
    (void)state;
    loh(true, "regress/reference/loh/loh3_sta05.csv");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patch_on_half_space),    cmocka_unit_test(patch_on_constant_q),
        cmocka_unit_test(patch_on_mechanisms),    cmocka_unit_test(benchmark_without_damping),
        cmocka_unit_test(benchmark_with_damping),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
