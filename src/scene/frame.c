/* The frame of the body: rotation about the centre of its box, faces, what lies inside, material at a depth.
 *
 * R = Rz Ry Rx turns about x, then y, then z, about fixed axes; positions x = p + R (b - p), p the centre of
 * the box, b in the body's own frame. R is orthonormal, so its inverse is its transpose. */
#include "scene/build.h"
#include "scene/grading.h"
#include "scene/topography.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void multiply(double left[3][3], double right[3][3], double product[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            product[i][j] = left[i][0] * right[0][j] + left[i][1] * right[1][j] + left[i][2] * right[2][j];
}

void sine_of(double degrees, double *sine, double *cosine)
{
    const double quarters = degrees / 90;
    if (quarters == round(quarters)) {
        static const double sines[] = {0, 1, 0, -1};
        const int quarter = (int)(fmod(fmod(quarters, 4) + 4, 4));
        *sine = sines[quarter];
        *cosine = sines[(quarter + 1) % 4];
        return;
    }
    *sine = sin(degrees * M_PI / 180);
    *cosine = cos(degrees * M_PI / 180);
}

void body_set_frame(struct body *body)
{
    double sine[3], cosine[3];
    body->rotated = false;
    for (int c = 0; c < 3; c++) {
        sine_of(body->rotation[c], &sine[c], &cosine[c]);
        body->pivot[c] = (body->low[c] + body->high[c]) / 2;
        if (body->rotation[c] != 0) body->rotated = true;
    }
    double about_x[3][3] = {{1, 0, 0}, {0, cosine[0], -sine[0]}, {0, sine[0], cosine[0]}};
    double about_y[3][3] = {{cosine[1], 0, sine[1]}, {0, 1, 0}, {-sine[1], 0, cosine[1]}};
    double about_z[3][3] = {{cosine[2], -sine[2], 0}, {sine[2], cosine[2], 0}, {0, 0, 1}};
    double about_y_x[3][3];
    multiply(about_y, about_x, about_y_x);
    multiply(about_z, about_y_x, body->frame);
}

void body_direction_from_deck(const struct body *body, const double direction[3], double body_direction[3])
{
    double result[3];
    for (int i = 0; i < 3; i++)
        result[i] = body->frame[0][i] * direction[0] + body->frame[1][i] * direction[1] +
                    body->frame[2][i] * direction[2];
    memcpy(body_direction, result, sizeof result);
}

void body_direction_to_deck(const struct body *body, const double body_direction[3], double direction[3])
{
    double result[3];
    for (int i = 0; i < 3; i++)
        result[i] = body->frame[i][0] * body_direction[0] + body->frame[i][1] * body_direction[1] +
                    body->frame[i][2] * body_direction[2];
    memcpy(direction, result, sizeof result);
}

/* Places of a body that is not turned pass unchanged, to the last bit. */
void ground_from_deck(const struct body *body, const double position[3], double place[3])
{
    double offset[3];
    if (!body->rotated) {
        memmove(place, position, sizeof offset);
        return;
    }
    for (int c = 0; c < 3; c++)
        offset[c] = position[c] - body->pivot[c];
    body_direction_from_deck(body, offset, offset);
    for (int c = 0; c < 3; c++)
        place[c] = body->pivot[c] + offset[c];
}

/* A surface that is not level never is that of a turned body. */
void body_from_deck(const struct body *body, const double position[3], double body_position[3])
{
    ground_from_deck(body, position, body_position);
    if (body->topography != NULL) topography_to_lattice(body->topography, body_position);
}

void body_to_deck(const struct body *body, const double body_position[3], double position[3])
{
    double offset[3];
    if (!body->rotated) {
        memmove(position, body_position, sizeof offset);
        if (body->topography != NULL) topography_to_deck(body->topography, position);
        return;
    }
    for (int c = 0; c < 3; c++)
        offset[c] = body_position[c] - body->pivot[c];
    body_direction_to_deck(body, offset, offset);
    for (int c = 0; c < 3; c++)
        position[c] = body->pivot[c] + offset[c];
}

void lattice_from_deck(const struct body *body, const double position[3], double place[3])
{
    body_from_deck(body, position, place);
    if (body->grading == NULL) return;
    double *down = &place[body->grading->axis];
    *down = grading_lattice(body->grading, *down);
}

void lattice_to_deck(const struct body *body, const double place[3], double position[3])
{
    double own[3] = {place[0], place[1], place[2]};
    if (body->grading != NULL) {
        double *down = &own[body->grading->axis];
        *down = grading_real(body->grading, *down);
    }
    body_to_deck(body, own, position);
}

const char *face_name(enum face face)
{
    static const char *const names[FACES] = {FACE_NAMES(CHOICE_NAME)};
    return names[face];
}

double body_cells(const struct body *body, int axis)
{
    if (body->grading != NULL && body->grading->axis == axis) return (double)body->grading->cells;
    return (body->high[axis] - body->low[axis]) / body->spacing;
}

double body_spacing_at(const struct body *body, const double place[3])
{
    const struct grading *grading = body->grading;
    if (grading == NULL) return body->spacing;
    const double lattice = grading_lattice(grading, place[grading->axis]);
    return fmax(body->spacing, grading->step * grading_stretch(grading, lattice));
}

double body_tolerance(const struct body *body)
{
    double extent = 0;
    for (int c = 0; c < 3; c++)
        extent = fmax(extent, fmax(fabs(body->low[c]), fabs(body->high[c])));
    return 1e-6 * body->spacing + 1e-13 * extent;
}

bool body_holds(const struct body *body, int dimension, const double position[3], double nearest[3])
{
    const double tolerance = body_tolerance(body);
    double place[3];
    bool inside = true;
    body_from_deck(body, position, place);
    for (int c = 0; c < 3 && c < dimension; c++) {
        if (place[c] < body->low[c] - tolerance || place[c] > body->high[c] + tolerance) inside = false;
        place[c] = fmin(fmax(place[c], body->low[c]), body->high[c]);
    }
    if (nearest != NULL) body_to_deck(body, place, nearest);
    if (body->shape == BODY_PLATE_WITH_HOLE &&
        hypot(place[0] - body->hole_centre[0], place[1] - body->hole_centre[1]) <
            body->hole_radius - tolerance)
        inside = false;
    return inside;
}

double body_rounding(const struct scene *scene)
{
    const int axis = scene->dimension - 1;
    return 1e-14 * (fabs(scene->body.low[axis]) + fabs(scene->body.high[axis]));
}

const struct material *scene_material_at(const struct scene *scene, double depth)
{
    const struct body *body = &scene->body;
    const double at = depth + body_rounding(scene);
    size_t material = body->material;
    for (size_t i = 0; i < body->layers && body->layer[i].top <= at; i++)
        material = body->layer[i].material;
    return &scene->material[material];
}

const char *vector_text(char text[VECTOR_TEXT_SIZE], const double *vector, int count)
{
    int length = 0;
    text[0] = '\0';
    for (int c = 0; c < count && length < VECTOR_TEXT_SIZE; c++)
        length += snprintf(text + length, (size_t)(VECTOR_TEXT_SIZE - length), "%s%.10g", c == 0 ? "" : ", ",
                           vector[c]);
    return text;
}

const struct material *scene_point_material(const struct scene *scene, size_t index, double depth)
{
    const struct given_points *given = scene->body.given;
    if (given != NULL && given->material != NULL) return &scene->material[given->material[index]];
    return scene_material_at(scene, depth);
}
