/* Elements of the surface of boxes and of plates with a hole: pieces about one spacing wide whose areas add
 * up to the face's. */
#include "points/cloud.h"

#include <math.h>
#include <stdlib.h>

selas_status cloud_add_element(struct cloud *cloud, const struct face_element *element,
                               struct messages *messages)
{
    enum { CHUNK = 64 };
    const double place = element->position[cloud->axis];
    if (place < cloud->low || place > cloud->high) return SELAS_OK;
    if (cloud->elements % CHUNK == 0) {
        struct face_element *larger =
            realloc(cloud->element, (cloud->elements + CHUNK) * sizeof *cloud->element);
        if (larger == NULL)
            return fail(messages, SELAS_NO_MEMORY, "no memory for %zu surface elements", cloud->elements);
        cloud->element = larger;
    }
    cloud->element[cloud->elements++] = *element;
    return SELAS_OK;
}

/* On which side of the box the hole's centre lies along an axis: -1 low face, +1 high face, 0 inside. */
static int centre_side(const struct body *body, int axis)
{
    const double tolerance = 1e-9 * (body->high[axis] - body->low[axis]);
    if (fabs(body->hole_centre[axis] - body->low[axis]) <= tolerance) return -1;
    if (fabs(body->hole_centre[axis] - body->high[axis]) <= tolerance) return 1;
    return 0;
}

void hole_angles(const struct body *body, double *first, double *last)
{
    const double quarter = 0.5 * acos(-1.0);
    const int x = centre_side(body, 0);
    const int y = centre_side(body, 1);
    *first = 0;
    *last = 4 * quarter;
    if (x == 0 && y == 0) return;
    if (x == 0 || y == 0) {
        *last = 2 * quarter;
        if (y > 0) *first = 2 * quarter;
        if (x < 0) *first = -quarter;
        if (x > 0) *first = quarter;
        *last += *first;
        return;
    }
    if (x < 0 && y > 0) *first = -quarter;
    if (x > 0) *first = y < 0 ? quarter : 2 * quarter;
    *last = *first + quarter;
}

/* The part [from, to] of a 2D face along its axis, cut into pieces. */
static selas_status face_part(struct cloud *cloud, const struct body *body, enum face face, double from,
                              double to, struct messages *messages)
{
    const int axis = face_axis(face);
    const int along = 1 - axis;
    const double length = to - from;
    if (length <= 1e-9 * body->spacing) return SELAS_OK;
    const size_t pieces = (size_t)fmax(1, round(length / body->spacing));
    for (size_t k = 0; k < pieces; k++) {
        struct face_element element = {.area = length / (double)pieces, .face = (int)face};
        element.position[axis] = face_plane(body, face);
        element.position[along] = from + ((double)k + 0.5) * element.area;
        element.normal[axis] = face_sign(face);
        element.width[along] = element.area;
        const selas_status status = cloud_add_element(cloud, &element, messages);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

static selas_status face_2d(struct cloud *cloud, const struct body *body, enum face face,
                            struct messages *messages)
{
    const int axis = face_axis(face);
    const int along = 1 - axis;
    if (body->shape != BODY_PLATE_WITH_HOLE || centre_side(body, axis) != face_sign(face))
        return face_part(cloud, body, face, body->low[along], body->high[along], messages);
    const double before = body->hole_centre[along] - body->hole_radius;
    const double after = body->hole_centre[along] + body->hole_radius;
    const selas_status status = face_part(cloud, body, face, body->low[along], before, messages);
    if (status != SELAS_OK) return status;
    return face_part(cloud, body, face, after, body->high[along], messages);
}

static selas_status hole(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    double first = 0;
    double last = 0;
    hole_angles(body, &first, &last);
    const double length = (last - first) * body->hole_radius;
    const size_t pieces = (size_t)fmax(2, round(length / body->spacing));
    for (size_t k = 0; k < pieces; k++) {
        const double angle = first + (last - first) * ((double)k + 0.5) / (double)pieces;
        const struct face_element element = {
            .position = {body->hole_centre[0] + body->hole_radius * cos(angle),
                         body->hole_centre[1] + body->hole_radius * sin(angle), 0},
            .normal = {-cos(angle), -sin(angle), 0},
            .area = length / (double)pieces,
            .face = FACE_HOLE};
        const selas_status status = cloud_add_element(cloud, &element, messages);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

static selas_status face_3d(struct cloud *cloud, const struct body *body, enum face face,
                            struct messages *messages)
{
    const int axis = face_axis(face);
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    size_t count[3] = {1, 1, 1};
    struct face_element element = {.area = 1, .face = (int)face};
    for (int c = 0; c < 3; c++) {
        if (c == axis) continue;
        const double length = body->high[c] - body->low[c];
        count[c] = (size_t)fmax(1, round(length / body->spacing));
        element.width[c] = length / (double)count[c];
        element.area *= element.width[c];
    }
    element.position[axis] = face_plane(body, face);
    element.normal[axis] = face_sign(face);
    for (size_t j = 0; j < count[second]; j++)
        for (size_t i = 0; i < count[first]; i++) {
            element.position[first] = body->low[first] + ((double)i + 0.5) * element.width[first];
            element.position[second] = body->low[second] + ((double)j + 0.5) * element.width[second];
            const selas_status status = cloud_add_element(cloud, &element, messages);
            if (status != SELAS_OK) return status;
        }
    return SELAS_OK;
}

static selas_status face_1d(struct cloud *cloud, const struct body *body, enum face face,
                            struct messages *messages)
{
    struct face_element element = {.area = 1, .face = (int)face};
    element.position[0] = face_plane(body, face);
    element.normal[0] = face_sign(face);
    return cloud_add_element(cloud, &element, messages);
}

selas_status cloud_surface(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (int face = 0; face < 2 * cloud->dimension && status == SELAS_OK; face++)
        switch (cloud->dimension) {
        case 1:
            status = face_1d(cloud, body, (enum face)face, messages);
            break;
        case 2:
            status = face_2d(cloud, body, (enum face)face, messages);
            break;
        default:
            status = face_3d(cloud, body, (enum face)face, messages);
        }
    if (status == SELAS_OK && body->shape == BODY_PLATE_WITH_HOLE) status = hole(cloud, body, messages);
    return status;
}
