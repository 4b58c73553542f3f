/* Ghost particles of updated-Lagrangian SPH (He & Seaid 2016, section 2.1 and Fig 3; stresses after Bui et
 * al. 2008) and the packing of particles and ghosts for the sums.
 *
 * Every particle closer to a wall than the kernel reaches has a mirror image behind it: three layers for
 * h = 1.5 spacings. With u, v, s of the particle and n the normal, the ghost has
 *
 *   no slip         u_g = 2 u_wall - u,  v_g = 2 v_wall - v,  s_g = s
 *   slip            the same along n only;  shear with n reversed
 *   given traction  u_g = u,  v_g = v,  s_g . n = 2 t - s . n,  the rest of s copied
 *
 * so that the mean over the wall is what the wall prescribes. For a bar pressed with s0 the last line is
 * s_g = -2 s0 - s. A transmitting face is a traction t = -rho (c_p v_n + c_s v_t). Images are made face by
 * face, so that corners have images of images.
 *
 * The ghosts of a traction carry stress but do not deform: they count in the momentum equation (with its own
 * L) and not in the velocity gradient, nor in the viscosity. A copied velocity there is an even continuation, which
 * leaves the first particles of the bar with stresses of 3.2, 1.1, .7, 1.3 ... times the applied one (without it
 * they are right to 1e-3), and brakes a body that turns. Their artificial stress is that of the particle: it acts
 * between particles and is no traction. That of s_g, tension where the particle is pressed, would push in both cases
 * the same way, and displacements that alternate along the face grow. */
#include "base/memory.h"
#include "base/vectors.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

#include <math.h>
#include <string.h>

/* Its rim too, but for rounding. */
static bool on_patch(const struct load *load, enum face face, const double *place)
{
    const int normal = face_axis(face);
    const double rim = 1 + 1e-9;
    double square = 0;
    for (int a = 0, edge = 0; a < 3; a++) {
        if (a == normal) continue;
        const double offset = place[a] - load->centre[a];
        if (load->shape == LOAD_SQUARE && fabs(offset) > rim * load->size[edge] / 2) return false;
        square += offset * offset;
        edge++;
    }
    return load->shape != LOAD_DISC || square <= rim * load->size[0] * load->size[0] / 4;
}

/* Loads that press on `face` at the place of a particle (body frame). */
static uint64_t loads_at(const struct scene *scene, enum face face, const double *place)
{
    uint64_t mask = 0;
    for (size_t k = 0; k < scene->loads; k++) {
        struct load load = scene->load[k];
        if (load.kind != LOAD_TRACTION || load.face != face) continue;
        body_from_deck(&scene->body, scene->load[k].centre, load.centre);
        if (load.shape == LOAD_FACE || on_patch(&load, face, place)) mask |= (uint64_t)1 << k;
    }
    return mask;
}

/* Number of images that a face makes of all particles and ghosts so far. */
static size_t count_images(const struct updated *updated, int axis, double wall)
{
    size_t count = 0;
    for (size_t i = 0; i < updated->points + updated->ghosts; i++)
        if (fabs(updated->reference[3 * i + (size_t)axis] - wall) < updated->longest * updated->reach)
            count++;
    return count;
}

/* Longer copies of the arrays of ghosts and places. */
static bool grow(struct updated *updated, size_t images)
{
    const size_t places = updated->points + updated->ghosts;
    struct updated_ghost *ghost = array_new(updated->ghosts + images, sizeof *ghost);
    double *reference = array_new(3 * (places + images), sizeof *reference);
    if (ghost == NULL || reference == NULL) {
        array_free(ghost);
        array_free(reference);
        return false;
    }
    if (updated->ghosts > 0) memcpy(ghost, updated->ghost, updated->ghosts * sizeof *ghost);
    memcpy(reference, updated->reference, 3 * places * sizeof *reference);
    array_free(updated->ghost);
    array_free(updated->reference);
    updated->ghost = ghost;
    updated->reference = reference;
    return true;
}

static bool mirror_at(struct updated *updated, enum face face)
{
    const struct scene *scene = updated->model.scene;
    const int axis = face_axis(face);
    const double wall = face_plane(&scene->body, face);
    const size_t points = updated->points, before = updated->ghosts;
    if (!grow(updated, count_images(updated, axis, wall))) return false;
    for (size_t i = 0; i < points + before; i++) {
        const double *place = updated->reference + 3 * i;
        if (!(fabs(place[axis] - wall) < updated->longest * updated->reach)) continue;
        struct updated_ghost ghost = {.source = (uint32_t)i};
        if (i >= points) ghost = updated->ghost[i - points];
        ghost.face[ghost.count++] = (unsigned char)face;
        ghost.loads |= loads_at(scene, face, place);
        updated->ghost[updated->ghosts] = ghost;
        double *image = updated->reference + 3 * (points + updated->ghosts++);
        memcpy(image, place, 3 * sizeof *image);
        image[axis] = 2 * wall - place[axis];
    }
    return true;
}

selas_status updated_ghosts_create(struct updated *updated, struct messages *messages)
{
    for (int face = 0; face < 2 * updated->dimension; face++)
        if (updated->wall[face] != WALL_NONE && !mirror_at(updated, (enum face)face))
            return fail(messages, SELAS_NO_MEMORY, "no memory for the ghosts of face '%s'",
                        face_name((enum face)face));
    return SELAS_OK;
}

/* State of a particle or ghost while it is mirrored; stress: xx yy zz xy yz zx or the components of the
 * plane. */
struct image {
    double u[3], v[3], stress[6], density;
    bool pressed; /* carries a traction */
};

static double wall_amplitude(const double *history, const struct updated *updated, size_t face)
{
    return history == NULL ? 0 : history[face] * updated->model.scene->boundary[face].amplitude;
}

/* Traction on a face with the outward normal sign * axis; transmitting faces absorb what comes. */
static void traction_at(const struct updated *updated, const struct updated_ghost *ghost, size_t face,
                        const struct drive *drive, const struct image *image, double traction[3])
{
    const struct scene *scene = updated->model.scene;
    const struct boundary *boundary = &scene->boundary[face];
    const int axis = face_axis((enum face)face);
    for (int a = 0; a < 3; a++)
        traction[a] = 0;
    if (boundary_damps(boundary) && !updated->velocities_displace)
        for (int a = 0; a < updated->dimension; a++)
            traction[a] -= updated->material->density * image->v[a] *
                           (a == axis ? boundary->normal_factor * updated->material->p_speed
                                      : boundary->shear_factor * updated->material->s_speed);
    if (drive->load == NULL) return;
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].face == face && (ghost->loads >> k & 1) != 0)
            for (int a = 0; a < 3; a++)
                traction[a] += drive->load[k] * updated->load_direction[3 * k + (size_t)a];
}

static void mirror(const struct updated *updated, const struct updated_ghost *ghost, size_t face,
                   const struct drive *drive, struct image *image)
{
    const int axis = face_axis((enum face)face), sign = face_sign((enum face)face);
    const enum updated_wall wall = updated->wall[face];
    const int(*component)[3] = updated_component[updated->dimension];
    if (wall == WALL_TRACTION) {
        image->pressed = true;
        double traction[3];
        traction_at(updated, ghost, face, drive, image, traction);
        for (int a = 0; a < updated->dimension; a++)
            image->stress[component[axis][a]] = 2 * sign * traction[a] - image->stress[component[axis][a]];
        return;
    }
    const double displacement = updated->amplitude[WALL_PLACE][face],
                 velocity = updated->amplitude[WALL_SPEED][face];
    for (int a = 0; a < updated->dimension; a++) {
        if (wall == WALL_SLIP && a != axis) {
            image->stress[component[axis][a]] *= -1;
            continue;
        }
        image->u[a] = 2 * displacement * updated->direction[face][a] - image->u[a];
        image->v[a] = 2 * velocity * updated->direction[face][a] - image->v[a];
    }
}

/* Packs one particle: place, velocity, volume, mass, s / rho^2. */
static void pack(const struct updated *updated, size_t place, size_t source, const struct image *image)
{
    const struct updated_layout layout = updated->layout;
    const size_t dimension = (size_t)updated->dimension, stresses = (size_t)updated->stresses;
    const size_t step = updated_step(updated);
    const double *reference = updated->reference + 3 * place;
    double *packed = updated_packed(updated, place);
    const double mass = updated->mass[source], volume = mass / image->density;
    for (size_t a = 0; a < dimension; a++) {
        packed[step * a] = reference[a] + image->u[a];
        packed[step * (layout.velocity + a)] = image->v[a];
    }
    packed[step * layout.volume] = volume;
    packed[step * layout.span] = image->pressed ? 0 : volume;
    packed[step * layout.mass] = mass;
    packed[step * layout.density] = image->density;
    packed[step * layout.length] = updated->length[source];
    const double inverse = 1 / image->density;
    for (size_t s = 0; s < stresses; s++)
        packed[step * (layout.tension + s)] = image->stress[s] * inverse;
}

/* Artificial stress of the UPDATED_TENSORS packed particles from `place` on, or those of them that there are. */
static void repel(const struct updated *updated, size_t place)
{
    const struct updated_layout layout = updated->layout;
    const double epsilon = updated->options.artificial_stress * updated->repulsion_scale;
    const size_t places = updated->points + updated->ghosts, stresses = (size_t)updated->stresses;
    double *packed = updated_packed(updated, place);
    if (updated->ordered) {
        taken_updated_stresses()->artificial(updated->dimension, epsilon, updated->stride,
                                             packed + updated->stride * layout.tension,
                                             packed + updated->stride * layout.repulsion);
        return;
    }
    double tension[6 * UPDATED_TENSORS] = {0}, repulsion[6 * UPDATED_TENSORS];
    for (size_t n = 0; n < UPDATED_TENSORS && place + n < places; n++)
        for (size_t s = 0; s < stresses; s++)
            tension[UPDATED_TENSORS * s + n] = packed[layout.size * n + layout.tension + s];
    taken_updated_stresses()->artificial(updated->dimension, epsilon, UPDATED_TENSORS, tension, repulsion);
    for (size_t n = 0; n < UPDATED_TENSORS && place + n < places; n++)
        for (size_t s = 0; s < stresses; s++)
            packed[layout.size * n + layout.repulsion + s] = repulsion[UPDATED_TENSORS * s + n];
}

/* A ghost's is that of its source, seen in the walls that slide. */
static void repel_ghost(const struct updated *updated, size_t g)
{
    const struct updated_ghost *ghost = &updated->ghost[g];
    const size_t step = updated_step(updated), repulsion = updated->layout.repulsion;
    const double *own = updated_packed(updated, ghost->source) + step * repulsion;
    double *image = updated_packed(updated, updated->points + g) + step * repulsion;
    for (size_t s = 0; s < (size_t)updated->stresses; s++)
        image[step * s] = own[step * s];
    for (int f = 0; f < ghost->count; f++) {
        const int axis = face_axis((enum face)ghost->face[f]);
        for (int a = 0; a < updated->dimension && updated->wall[ghost->face[f]] == WALL_SLIP; a++)
            if (a != axis) image[step * (size_t)updated_component[updated->dimension][axis][a]] *= -1;
    }
}

INLINED void load_particle(const struct updated *updated, const double *y, size_t i, struct image *image)
{
    const size_t dimension = (size_t)updated->dimension, stresses = (size_t)updated->stresses,
                 unknowns = updated->model.unknowns;
    const double *u, *v, *density, *stress;
    if (updated_owns(updated, i)) {
        const size_t row = updated_row(updated, i);
        u = y + dimension * row;
        v = u + unknowns;
        density = y + 2 * unknowns + row;
        stress = y + 2 * unknowns + updated->held + stresses * row;
    } else {
        const size_t others = i < updated->from ? i : i - updated->own;
        u = updated->part.arrived + (2 * dimension + 1 + stresses) * others;
        v = u + dimension;
        density = v + dimension;
        stress = density + 1;
    }
    for (size_t a = 0; a < dimension; a++) {
        image->u[a] = u[a];
        image->v[a] = v[a];
    }
    memcpy(image->stress, stress, stresses * sizeof *stress);
    image->density = *density;
}

static void fill_places(const struct updated *updated, const struct drive *drive, const double *y)
{
    const size_t points = updated->points;
#pragma omp parallel for schedule(static) if (points >= UPDATED_PARALLEL)
    for (size_t i = 0; i < points; i++) {
        struct image image = {.pressed = false};
        load_particle(updated, y, i, &image);
        pack(updated, i, i, &image);
    }
#pragma omp parallel for schedule(static) if (points >= UPDATED_PARALLEL)
    for (size_t g = 0; g < updated->ghosts; g++) {
        const struct updated_ghost *ghost = &updated->ghost[g];
        struct image image = {.pressed = false};
        load_particle(updated, y, ghost->source, &image);
        for (int f = 0; f < ghost->count; f++)
            mirror(updated, ghost, ghost->face[f], drive, &image);
        pack(updated, points + g, ghost->source, &image);
    }
    const size_t places = points + updated->ghosts, step = updated_step(updated);
#pragma omp parallel for schedule(static) if (points >= UPDATED_PARALLEL)
    for (size_t place = 0; place < places; place += UPDATED_TENSORS) {
        if (updated->repulsive && place < points) repel(updated, place);
        /* hourglass.c adds their force */
        for (size_t i = place; updated->options.adjoint && i < place + UPDATED_TENSORS && i < places; i++)
            for (size_t s = 0; s < (size_t)updated->stresses; s++)
                updated_packed(updated, i)[step * (updated->layout.tension + s)] = 0;
    }
    for (size_t g = 0; g < updated->ghosts && updated->repulsive; g++)
        repel_ghost(updated, g);
}

static void keep_places(const struct updated *updated)
{
    const size_t dimension = (size_t)updated->dimension, step = updated_step(updated);
    for (size_t i = 0; i < updated->points + updated->ghosts; i++)
        for (size_t a = 0; a < dimension; a++)
            updated->searched[3 * i + a] = updated_packed(updated, i)[step * a];
}

/* New lists where a particle has moved by half the skin since the last search. The lists hold more pairs than
 * the kernel reaches, sorted, and pairs out of reach are passed over: when they were made does not change a
 * bit. */
static void search(struct updated *updated, const struct drive *drive, const double *y)
{
    struct messages unheard = {0};
    keep_places(updated);
    updated->search_failed = !updated_meet(updated);
    if (updated->search_failed) return;
    if (updated->part.ranks != NULL) {
        updated_gather(updated, y);
        fill_places(updated, drive, y);
        keep_places(updated);
    }
    updated->search_failed =
        !updated_all_have(updated, updated_find_neighbours(updated, &unheard) == SELAS_OK);
    if (!updated->search_failed) updated_look_ahead(updated);
    messages_free(&unheard);
}

void updated_fill(struct updated *updated, const struct drive *drive, const double *y)
{
    for (size_t face = 0; face < FACES; face++) {
        updated->amplitude[WALL_PLACE][face] = wall_amplitude(drive->displacement, updated, face);
        updated->amplitude[WALL_SPEED][face] = wall_amplitude(drive->velocity, updated, face);
        updated->amplitude[WALL_ACCELERATION][face] = wall_amplitude(drive->motion, updated, face);
    }
    if (updated->part.lost) return;
    if (updated->part.ranks != NULL) updated_gather(updated, y);
    fill_places(updated, drive, y);
    if (updated_search_is_due(updated)) search(updated, drive, y);
}

double updated_power_of_faces(const struct updated *updated, const struct drive *drive, const double *y,
                              double *absorbed)
{
    double power = 0;
    *absorbed = 0;
    for (size_t g = 0; g < updated->ghosts; g++) {
        const struct updated_ghost *ghost = &updated->ghost[g];
        const size_t face = ghost->face[0], i = ghost->source;
        const size_t axis = (size_t)face_axis((enum face)face);
        if (!updated_owns(updated, i)) continue;
        const double depth =
            fabs(updated->reference[3 * (updated->points + g) + axis] - updated->reference[3 * i + axis]);
        const double volume = updated_volume(updated, i), spacing = pow(volume, 1.0 / updated->dimension);
        if (ghost->count > 1 || depth > 1.5 * spacing) continue; /* not the outermost */
        const double area = volume / spacing;
        struct image image = {.density = 1};
        load_particle(updated, y, i, &image);
        double traction[3] = {0}, sum = 0;
        if (updated->wall[face] == WALL_TRACTION) {
            traction_at(updated, ghost, face, drive, &image, traction);
            for (int a = 0; a < updated->dimension; a++)
                sum += traction[a] * image.v[a];
        } else {
            const double velocity = wall_amplitude(drive->velocity, updated, face);
            for (int a = 0; a < updated->dimension; a++)
                sum += face_sign((enum face)face) *
                       image.stress[updated_component[updated->dimension][axis][a]] *
                       updated->direction[face][a] * velocity;
        }
        if (boundary_damps(&updated->model.scene->boundary[face]))
            *absorbed -= area * sum;
        else
            power += area * sum;
    }
    return power;
}
