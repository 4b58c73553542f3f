/* What a plot of the ground shows beside the ground (see the header). */
#include "record/plots/marks.h"

#include <math.h>
#include <string.h>

enum { SHOWN = 3000 /* sources, at most, that are drawn */ };

static void own_place(const struct scene *scene, const double place[3], double own[3])
{
    if (scene->body.rotated)
        body_from_deck(&scene->body, place, own);
    else
        memcpy(own, place, 3 * sizeof *own);
}

void marks_line(const struct scene *scene, double from[3], double to[3])
{
    const struct body *body = &scene->body;
    size_t k = 0;
    while (k < scene->loads && scene->load[k].shape == LOAD_FACE)
        k++;
    for (int axis = 0; axis < 3; axis++)
        from[axis] = (body->low[axis] + body->high[axis]) / 2;
    if (k < scene->loads)
        own_place(scene, scene->load[k].centre, from);
    else if (scene->receivers > 0)
        own_place(scene, scene->receiver[0].position, from);
    memcpy(to, from, 3 * sizeof *to);
    double farthest = 0;
    for (size_t r = 0; r < scene->receivers; r++) {
        double place[3];
        own_place(scene, scene->receiver[r].position, place);
        const double away = hypot(place[0] - from[0], place[1] - from[1]);
        if (away > farthest * (1 + 1e-9)) memcpy(to, place, sizeof place);
        farthest = fmax(farthest, away);
    }
    if (farthest == 0) to[0] += body->high[0] - body->low[0];
}

/* A name and its middle, in pixels of the panel. */
struct label {
    double at[2], half[2];
};

static bool overlaps(const struct label *one, const struct label *other)
{
    return fabs(one->at[0] - other->at[0]) < one->half[0] + other->half[0] &&
           fabs(one->at[1] - other->at[1]) < one->half[1] + other->half[1];
}

/* Above, right, left or below, a line farther off as long as it lies on a name or a receiver. */
static struct label place_label(const struct page *page, size_t c, const struct label *place, size_t r,
                                const struct label *label)
{
    static const double line = 15, half_letter = 4;
    const int *size = page->size[c];
    struct label found = {{0}, {half_letter * (double)strlen(page->scene->receiver[r].name), line / 2}};
    bool free = false;
    for (int attempt = 0; attempt < 4 * NAMED && !free; attempt++) {
        const int where = attempt % 4, ring = attempt / 4;
        const double away = line * (where == 0 || where == 3 ? 1.1 + ring : ring);
        const double aside = where == 1   ? 1
                             : where == 2 ? -1
                                          : 0,
                     x = place[r].at[0] + aside * (found.half[0] + line);
        found.at[0] = fmax(fmin(x, size[0] - found.half[0]), found.half[0]);
        found.at[1] = place[r].at[1] + (where < 2 ? away : -away);
        free = found.at[1] > 0 && found.at[1] < size[1] + 2 * line;
        for (size_t other = 0; other < page->scene->receivers; other++)
            free =
                free && !overlaps(&found, &place[other]) && (other >= r || !overlaps(&found, &label[other]));
    }
    return found;
}

void marks_names(const struct page *page, size_t c)
{
    const struct scene *scene = page->scene;
    const struct cut *cut = &page->cut[c];
    struct label place[NAMED], label[NAMED];
    double zero[2], pixel[2]; /* where the panel begins at the left and below; a pixel in units of the deck */
    if (scene->receivers > NAMED) return;
    for (int side = 0; side < 2; side++) {
        const bool down = side == 1 && cut->downwards;
        zero[side] = down ? cut->high[side] : cut->low[side];
        pixel[side] = (down ? -1 : 1) * (cut->high[side] - cut->low[side]) / page->size[c][side];
    }
    for (size_t r = 0; r < scene->receivers; r++) {
        double own[3];
        own_place(scene, scene->receiver[r].position, own);
        cut_project(cut, own, place[r].at);
        for (int side = 0; side < 2; side++) {
            place[r].at[side] = (place[r].at[side] - zero[side]) / pixel[side];
            place[r].half[side] = 6;
        }
    }
    for (size_t r = 0; r < scene->receivers; r++) {
        label[r] = place_label(page, c, place, r, label);
        fprintf(page->script,
                "set label %zu '%s' at %.9g,%.9g center front noenhanced font 'DejaVu Sans,11'\n",
                NAME_TAGS + r, scene->receiver[r].name, zero[0] + label[r].at[0] * pixel[0],
                zero[1] + label[r].at[1] * pixel[1]);
    }
}

static void write_places(struct page *page, size_t c)
{
    const struct scene *scene = page->scene;
    const size_t stride = 1 + scene->loads / SHOWN;
    double own[3], at[2];
    fprintf(page->script, "$sources%zu << END\n", c);
    for (size_t k = 0; k < scene->loads; k += stride) {
        if (scene->load[k].shape == LOAD_FACE) continue;
        own_place(scene, scene->load[k].centre, own);
        cut_project(&page->cut[c], own, at);
        fprintf(page->script, "%.9g %.9g\n", at[0], at[1]);
    }
    fprintf(page->script, "END\n$receivers%zu << END\n", c);
    for (size_t r = 0; r < scene->receivers; r++) {
        own_place(scene, scene->receiver[r].position, own);
        cut_project(&page->cut[c], own, at);
        fprintf(page->script, "%.9g %.9g\n", at[0], at[1]);
    }
    fprintf(page->script, "END\n$jumps%zu << END\n", c);
    page->jumps = cut_write_jumps(scene, &page->cut[c], page->script) || page->jumps;
    fprintf(page->script, "END\n$surface%zu << END\n", c);
    cut_write_surface(scene, &page->cut[c], page->script);
    fprintf(page->script, "END\n$layers%zu << END\n", c);
    page->layers = cut_write_layers(scene, &page->cut[c], page->script) || page->layers;
    fprintf(page->script, "END\n$body%zu << END\n", c);
    cut_write_part(scene, &page->cut[c], page->cut[c].body_low, page->cut[c].body_high, page->script);
    fprintf(page->script, "END\n");
}

/* Rim of a patch on a face that a cut shows whole (map) or from the side (section). */
static void write_patch(const struct page *page, size_t c, const struct load *load)
{
    enum { CORNERS = 48 };
    const int axis = face_axis(load->face);
    double own[3], at[2];
    own_place(page->scene, load->centre, own);
    for (int k = 0; k <= CORNERS; k++) {
        const double angle = 2 * M_PI * k / CORNERS, round[2] = {cos(angle), sin(angle)};
        const double most = fmax(fabs(round[0]), fabs(round[1]));
        double place[3];
        memcpy(place, own, sizeof place);
        for (int a = 0, side = 0; a < page->scene->dimension && side < 2; a++)
            if (a != axis) {
                const bool disc = load->shape == LOAD_DISC;
                place[a] += load->size[disc ? 0 : side] / 2 * round[side] / (disc ? 1 : most);
                side++;
            }
        cut_project(&page->cut[c], place, at);
        fprintf(page->script, "%.9g %.9g\n", at[0], at[1]);
    }
    fprintf(page->script, "\n");
}

static bool is_patch(const struct load *load)
{
    return load->kind == LOAD_TRACTION && (load->shape == LOAD_SQUARE || load->shape == LOAD_DISC);
}

static void write_patches(const struct page *page, size_t c)
{
    fprintf(page->script, "$patches%zu << END\n", c);
    for (size_t k = 0; k < page->scene->loads && k < SHOWN; k++)
        if (is_patch(&page->scene->load[k])) write_patch(page, c, &page->scene->load[k]);
    fprintf(page->script, "END\n");
}

static bool looks(const struct scene *scene, int face, enum face_look look)
{
    const struct boundary *boundary = &scene->boundary[face];
    const bool damped = boundary_damps(boundary);
    return look == LOOK_DAMPED ? damped
                               : !damped && !boundary_has_layer(boundary) && !boundary_is_free(boundary);
}

bool marks_any_face(const struct page *page, enum face_look look)
{
    for (int face = 0; face < 2 * page->scene->dimension; face++)
        if (looks(page->scene, face, look)) return true;
    return false;
}

static void write_faces(const struct page *page, size_t c, enum face_look look)
{
    const struct cut *cut = &page->cut[c];
    fprintf(page->script, "$faces%zu_%d << END\n", c, look);
    for (int side = 0; side < 2; side++)
        for (int end = 0; end < 2; end++) {
            const int face = cut->face[side][end];
            if (face < 0 || !looks(page->scene, face, look)) continue;
            const double at = end == 0 ? cut->body_low[side] : cut->body_high[side];
            const double from = cut->body_low[1 - side], to = cut->body_high[1 - side];
            for (int n = 0; n < 2; n++) {
                double place[2];
                place[side] = at;
                place[1 - side] = n == 0 ? from : to;
                fprintf(page->script, "%.9g %.9g\n", place[0], place[1]);
            }
            fprintf(page->script, "\n");
        }
    fprintf(page->script, "END\n");
}

void marks_write(struct page *page, size_t c)
{
    write_places(page, c);
    write_patches(page, c);
    for (int look = 0; look < LOOKS; look++)
        write_faces(page, c, (enum face_look)look);
}
