/* The whole step of a scene with absorbing layers, memory variables and all, is a linear map of the state.
 * All of its eigenvalues: none is outside the unit circle (doc/theory/absorbing-faces.md, section 5). */
#include "consistent_run.h"
#include "few.h"
#include "step_map.h"

#include "method/consistent/absorbing/pml.h"
#include "scene/absorbing_layers.h"
#include "stepping/stepping.h"

static bool held(struct model *model, size_t i)
{
    const struct consistent *c = consistent_of(model);
    if (i >= 2 * c->model.unknowns) return false;
    const size_t component = i % c->model.unknowns / c->volume, place = i % c->volume;
    const size_t at[3] = {place % c->n[0], place / c->n[0] % c->n[1], place / c->plane};
    for (int face = 0; face < 2 * c->dimension; face++) {
        const int slot = c->slot[face / 2];
        if (c->held[component][face] && at[slot] == (face % 2 == 0 ? 0 : c->n[slot] - 1)) return true;
    }
    return false;
}

static const struct consistent_options standard = {.degree = 2, .sweeps = 3, .depth_exact = true};

/* Layers behind the faces of the mask in a rectangle of so many cells, the other faces free but for a
 * symmetry plane x-. */
static void judge(const char *name, unsigned layered, const size_t cells[2], long points,
                  struct consistent_options options, double nu)
{
    struct plain_scene plain;
    plain_box(&plain, 2, (double[]){.25 * (double)cells[0], .25 * (double)cells[1], 0}, .25);
    plain_material(&plain.material[0], 1, 2 * nu / (1 - 2 * nu), 1);
    plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
    for (int face = 0; face < 4; face++) {
        struct boundary *boundary = &plain.scene.boundary[face];
        if ((layered & 1u << face) == 0) continue;
        boundary->kind = BOUNDARY_TRANSMITTING;
        boundary->absorber = ABSORBER_PML;
        boundary->layer_points = points;
    }
    struct model *model = make(&plain, options);
    double omega, error;
    struct messages messages = {0};
    assert_int_equal(largest_frequency(model, &omega, &error, &messages), SELAS_OK);
    for (int corrected = 0; corrected < 2; corrected++) {
        const struct spectrum spectrum = {.omega = omega * (1 + error), .layers = true};
        const double dt = corrected ? .9999 * scheme_limit(scheme_find("modified-equation"), &spectrum, 0)
                                    : 1.8 / spectrum.omega;
        size_t count;
        const double largest =
            map_largest_of(corrected ? map_corrected_step : map_step, model, dt, held, &count);
        print_message(
            "# %s, nu %g, degree %d, %s, depth mass %s, %s: %zu eigenvalues, largest modulus 1 %+.2e\n", name,
            nu, options.degree, options.sweeps > 0 ? "sweeps" : "exact mass",
            options.depth_exact ? "exact" : "same", corrected ? "modified equation" : "leapfrog", count,
            largest - 1);
        assert_true(largest < 1);
    }
    model_free(&model);
}

/* The free surface y- runs into the layer behind x+, which meets that behind y+. (With memory terms that do
 * not know the exact mass over depth: 1.19 to 1.37.) */
static void test_corner(void **state)
{
    (void)state;
    static const double poisson[2] = {.25, .49};
    for (int material = few_of(0, 1); material < 2; material++) {
        for (int exact = 0; exact < 2; exact++)
            judge("corner", 1u << FACE_X_HIGH | 1u << FACE_Y_HIGH, (size_t[]){2, 2}, LEAST_POINTS,
                  (struct consistent_options){.degree = 2, .sweeps = 3, .depth_exact = exact == 1},
                  poisson[material]);
        for (int degree = 2; degree <= few_of(4, 3); degree++)
            judge("corner", 1u << FACE_X_HIGH | 1u << FACE_Y_HIGH, (size_t[]){2, 2}, LEAST_POINTS,
                  (struct consistent_options){.degree = degree}, poisson[material]);
    }
}

/* A thin body: layers on both sides under a free surface, and all around. */
static void test_thin(void **state)
{
    (void)state;
    const unsigned half_space = 15 - (1u << FACE_Y_LOW);
    if (few_of(1, 0))
        judge("both sides", half_space, (size_t[]){4, 1}, LEAST_POINTS,
              (struct consistent_options){.degree = 3}, .49);
    if (few_of(1, 0))
        judge("both sides", half_space, (size_t[]){4, 1}, LEAST_POINTS,
              (struct consistent_options){.degree = 4}, .49);
    if (few_of(1, 0)) judge("both sides", half_space, (size_t[]){4, 1}, LEAST_POINTS, standard, .25);
    if (few_of(1, 0)) judge("both sides", half_space, (size_t[]){4, 1}, LEAST_POINTS, standard, .49);
    judge("three sides and a symmetry plane", 14, (size_t[]){1, 1}, LEAST_POINTS, standard, .49);
}

/* A plate, free above and below: waves with phase and group velocity of opposite sign, which grew by up to 1
 * + 1.7e-3 a step before velocities in the layer were damped for them. Thicknesses of 1, 2 and 4 cells. */
static void test_plate(void **state)
{
    (void)state;
    for (size_t cells = 1; cells <= (size_t)few_of(4, 1); cells *= 2) {
        judge("plate", 1u << FACE_X_HIGH, (size_t[]){4, cells}, LAYER_POINTS, standard, .25);
        judge("plate", 1u << FACE_X_HIGH, (size_t[]){4, cells}, LAYER_POINTS, standard, .45);
    }
}

static double norm(size_t n, const double *y)
{
    return sqrt(dot(n, y, y));
}

/* Three dimensions: the map is too large for all its eigenvalues (5754 and more), so its powers are applied to noise, a
 * third of them twice after each other: the modulus per step that is left is that of the largest eigenvalues. (A plate
 * with velocities damped behind what moves by them grows in runs: regress/checks/absorbing.sh.) */
static void judge_powers(const char *name, const enum boundary_kind kind[6], double nu)
{
    enum { THIRD = 800 };
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){.5, .25, .25}, .25);
    plain_material(&plain.material[0], 1, 2 * nu / (1 - 2 * nu), 1);
    for (int face = 0; face < 6; face++)
        plain.scene.boundary[face] =
            (struct boundary){.kind = kind[face], .absorber = ABSORBER_PML, .layer_points = LEAST_POINTS};
    struct model *model =
        make(&plain, (struct consistent_options){.degree = 2, .sweeps = 3, .depth_exact = true});
    double omega, error, size[4];
    struct messages messages = {0};
    assert_int_equal(largest_frequency(model, &omega, &error, &messages), SELAS_OK);
    double *y = calloc(model->state_size, sizeof *y), *a = calloc(model->unknowns, sizeof *a);
    noise(model->state_size, y);
    for (size_t i = 0; i < model->state_size; i++)
        if (held(model, i)) y[i] = 0;
    for (int third = 0; third < 4; third++) {
        size[third] = norm(model->state_size, y);
        for (int i = 0; third < 3 && i < THIRD; i++)
            map_step(model, 1.8 / (omega * (1 + error)), y, a);
    }
    const double before = log(size[2] / size[1]) / THIRD, largest = log(size[3] / size[2]) / THIRD;
    print_message("# 3-D, %s, nu %g, %zu numbers: modulus left after %d steps 1 %+.2e, before 1 %+.2e\n",
                  name, nu, model->state_size, 3 * THIRD, largest, before);
    assert_true(largest < 0 && before < 0 && size[3] < size[0]);
    free(y);
    free(a);
    model_free(&model);
}

/* A corner of layers under a free surface, layers all around a thin body under one, and a corner of a plate. */
static void test_three_dimensions(void **state)
{
    (void)state;
    const enum boundary_kind mirror = BOUNDARY_SYMMETRY, open = BOUNDARY_TRANSMITTING, none = BOUNDARY_FREE;
    const enum boundary_kind corner[6] = {mirror, open, mirror, open, none, open},
                             thin[6] = {open, open, mirror, open, none, open},
                             plate[6] = {mirror, open, mirror, open, mirror, none};
    if (few_of(1, 0)) judge_powers("corner", corner, .25);
    if (few_of(1, 0)) judge_powers("corner", corner, .49);
    judge_powers("thin body", thin, .45);
    judge_powers("plate", plate, .25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corner),
        cmocka_unit_test(test_thin),
        cmocka_unit_test(test_plate),
        cmocka_unit_test(test_three_dimensions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
