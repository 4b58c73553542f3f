/* What the user wants to see: receivers, profiles, snapshots. */
#include "base/memory.h"
#include "scene/build.h"
#include "scene/topography.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Names become file names: letters, digits, '_', '-', '+' and '.', not a '.' or '-' first, and not those of
 * other files of a run. */
static bool check_file_name(struct builder *builder, const struct deck_group *group, const char *name)
{
    static const char safe[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.";
    const size_t length = strlen(name), good = strspn(name, safe);
    if (good < length) {
        size_t bytes = 1; /* of the character, which may be UTF-8 */
        while (((unsigned char)name[good + bytes] & 0xc0) == 0x80)
            bytes++;
        complain(builder, group, "name",
                 "'%.*s' in the name '%s' cannot stand in a file name; expected letters, digits, _ - + .",
                 (int)bytes, name + good, name);
        return false;
    }
    if (name[0] == '.' || name[0] == '-') {
        complain(builder, group, "name", "the name '%s' begins with '%c'; expected a letter or a digit first",
                 name, name[0]);
        return false;
    }
    if (length >= 6 && strcasecmp(name + length - 6, ".exact") == 0) {
        complain(builder, group, "name", "names ending in '.exact' are those of the exact histories");
        return false;
    }
    return true;
}

/* A receiver's plot, NAME.png, is none of those that a run makes of other things. */
static void check_picture(struct builder *builder, const struct deck_group *group, const char *name)
{
    static const char *const taken[] = {"ground", "damping", "snapshot_"};
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++) {
        const size_t length = strlen(taken[i]);
        const bool stem = taken[i][length - 1] == '_';
        if (stem ? strncasecmp(name, taken[i], length) == 0 : strcasecmp(name, taken[i]) == 0)
            complain(builder, group, "name",
                     "'%s.png' is a plot of the run itself; expected another name than 'ground', 'damping' "
                     "or 'snapshot_...'",
                     name);
    }
}

struct named {
    const char *name;
    size_t number; /* from 0 */
};

static int by_name(const void *one, const void *other)
{
    const struct named *a = one, *b = other;
    const int order = strcasecmp(a->name, b->name);
    return order != 0 ? order : (a->number > b->number) - (a->number < b->number);
}

/* Receivers and profiles share a folder; some file systems do not tell case. */
static void check_receivers(struct builder *builder)
{
    const size_t count = builder->scene->receivers;
    struct named *sorted = scene_array(builder, count, sizeof *sorted);
    if (sorted == NULL) return;
    for (size_t i = 0; i < count; i++)
        sorted[i] = (struct named){builder->scene->receiver[i].name, i};
    qsort(sorted, count, sizeof *sorted, by_name);
    for (size_t i = 1; i < count; i++)
        if (sorted[i].name[0] != '\0' && strcasecmp(sorted[i - 1].name, sorted[i].name) == 0)
            complain(builder, deck_get(builder->deck, "receiver", sorted[i].number), "name",
                     "there is a receiver '%s' already (&receiver %zu)", sorted[i].name,
                     sorted[i - 1].number + 1);
    array_free(sorted);
}

static void check_profile(struct builder *builder, const struct deck_group *group, const char *name,
                          size_t profiles)
{
    const struct scene *scene = builder->scene;
    for (size_t i = 0; i < scene->receivers; i++)
        if (strcasecmp(scene->receiver[i].name, name) == 0)
            complain(builder, group, "name", "there is a receiver '%s' already (&receiver %zu)", name, i + 1);
    for (size_t i = 0; i < profiles; i++)
        if (strcasecmp(scene->profile[i].name, name) == 0)
            complain(builder, group, "name", "there is a profile '%s' already (&profile %zu)", name, i + 1);
}

/* Who means the ground under a hill by the level of face z- stands in the hill. */
static void look_at_hill(struct builder *builder, const struct deck_group *group, const char *what,
                         const double position[3])
{
    const struct body *body = &builder->scene->body;
    const struct topography *hill = body->topography;
    const int down = builder->scene->dimension - 1;
    char text[VECTOR_TEXT_SIZE];
    double above[3] = {position[0], position[1], position[2]}, surface[3];
    if (hill == NULL || fabs(position[down] - hill->plane) > body_tolerance(body)) return;
    above[down] = hill->plane + hill->top - body->spacing;
    if (body_holds(body, down + 1, above, surface)) return;
    if (position[down] - surface[down] > 0.5 * body->spacing)
        deck_warning(
            builder->deck, group, "position", builder->messages,
            "%s is %.4g below the surface, at the level of face '%c-'; position = %s, depth = 0 is on it",
            what, position[down] - surface[down], "xyz"[down], vector_text(text, position, down));
}

static void read_place(struct builder *builder, const struct deck_group *group, const char *name,
                       const char *what, double position[3])
{
    char given[VECTOR_TEXT_SIZE], near[VECTOR_TEXT_SIZE];
    const struct body *body = &builder->scene->body;
    const int dimension = builder->scene->dimension;
    double nearest[3];
    const bool has_depth = strcmp(name, "position") == 0;
    const bool placed = has_depth ? need_place(builder, group, name, what, position)
                                  : need_vector(builder, group, name, what, position);
    if (!placed || !builder->body_known) return;
    if (has_depth) look_at_hill(builder, group, what, position);
    if (body_holds(body, dimension, position, nearest)) return;
    const int down = dimension - 1;
    double off = 0, aside = 0; /* the box is missed by this much, beside the vertical axis by that */
    for (int c = 0; c < 3; c++) {
        off = fmax(off, fabs(nearest[c] - position[c]));
        if (c != down) aside = fmax(aside, fabs(nearest[c] - position[c]));
    }
    if (body->shape == BODY_PLATE_WITH_HOLE && off <= body_tolerance(body))
        complain(builder, group, name, "%s at %s lies in the hole", what,
                 vector_text(given, position, dimension));
    else if (has_depth && body->topography != NULL && nearest[down] > position[down] &&
             aside <= body_tolerance(body))
        complain(builder, group, name,
                 "%s at %s lies above the surface, which is at %c = %.10g there; %s = %s, depth = 0 is on it",
                 what, vector_text(given, position, dimension), "xyz"[down], nearest[down], name,
                 vector_text(near, position, down));
    else
        complain(builder, group, name, "%s at %s lies outside the body; the nearest place in it is %s", what,
                 vector_text(given, position, dimension), vector_text(near, nearest, dimension));
}

/* Below a surface that is not level a line between two places of the body may leave it. */
static void check_line(struct builder *builder, const struct deck_group *group, const struct profile *profile)
{
    const struct body *body = &builder->scene->body;
    char text[VECTOR_TEXT_SIZE];
    for (size_t i = 1; body->topography != NULL && i + 1 < profile->points; i++) {
        const double part = (double)i / (double)(profile->points - 1);
        double place[3];
        for (int c = 0; c < 3; c++)
            place[c] = (1 - part) * profile->from[c] + part * profile->to[c];
        if (body_holds(body, builder->scene->dimension, place, NULL)) continue;
        complain(builder, group, "to", "the profile leaves the ground at %s",
                 vector_text(text, place, builder->scene->dimension));
        return;
    }
}

void build_receivers(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const size_t count = deck_count(builder->deck, "receiver");
    if (count == 0) return;
    scene->receiver = scene_array(builder, count, sizeof *scene->receiver);
    if (scene->receiver == NULL) return;
    scene->receivers = count;
    for (size_t i = 0; i < count; i++) {
        const struct deck_group *group = deck_get(builder->deck, "receiver", i);
        struct receiver *receiver = &scene->receiver[i];
        if (take_name(builder, group, "name", receiver->name) &&
            check_file_name(builder, group, receiver->name))
            check_picture(builder, group, receiver->name);
        read_place(builder, group, "position", "the receiver", receiver->position);
    }
    check_receivers(builder);
}

/* The values of `times`, ascending; NULL after complaining. */
static double *read_times(struct builder *builder, const struct deck_group *group, size_t *count)
{
    *count = deck_values(group, "times");
    double *times = scene_array(builder, *count, sizeof *times);
    if (times == NULL) {
        *count = 0;
        return NULL;
    }
    for (size_t i = 0; i < *count; i++) {
        times[i] = deck_real(group, "times", i);
        if (times[i] > builder->scene->end_time)
            complain(builder, group, "times", "%g is after scene%%end_time = %g", times[i],
                     builder->scene->end_time);
    }
    gsl_sort(times, 1, *count);
    return times;
}

static unsigned read_fields(const struct deck_group *group)
{
    static const selas_field field[] = {FIELDS(CHOICE_SYMBOL)};
    unsigned fields = 0;
    for (size_t i = 0; i < deck_values(group, "fields"); i++)
        fields |= 1U << field[deck_choice(group, "fields", i)];
    return fields;
}

void build_profiles(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const size_t count = deck_count(builder->deck, "profile");
    if (count == 0) return;
    scene->profile = scene_array(builder, count, sizeof *scene->profile);
    if (scene->profile == NULL) return;
    scene->profiles = count;
    for (size_t i = 0; i < count; i++) {
        const struct deck_group *group = deck_get(builder->deck, "profile", i);
        struct profile *profile = &scene->profile[i];
        if (take_name(builder, group, "name", profile->name) &&
            check_file_name(builder, group, profile->name))
            check_profile(builder, group, profile->name, i);
        read_place(builder, group, "from", "the profile's first point", profile->from);
        read_place(builder, group, "to", "the profile's last point", profile->to);
        profile->points = (size_t)deck_integer(group, "points", 0);
        profile->fields = read_fields(group);
        if (builder->body_known) check_line(builder, group, profile);
        if (deck_values(group, "times") > 0) {
            profile->time = read_times(builder, group, &profile->times);
        } else {
            profile->time = scene_array(builder, 1, sizeof *profile->time);
            if (profile->time == NULL) return;
            profile->times = 1;
            profile->time[0] = scene->end_time;
        }
    }
}

static void read_region(struct builder *builder, const struct deck_group *group, struct snapshot *snapshot)
{
    const size_t dimension = (size_t)builder->scene->dimension, count = deck_values(group, "region");
    snapshot->whole = count == 0;
    if (count == 0) return;
    if (count != 2 * dimension) {
        complain(builder, group, "region",
                 "region has %zu values; expected %zu: the lowest corner, then the "
                 "highest",
                 count, 2 * dimension);
        return;
    }
    for (size_t c = 0; c < dimension; c++) {
        snapshot->region_low[c] = deck_real(group, "region", c);
        snapshot->region_high[c] = deck_real(group, "region", dimension + c);
        if (snapshot->region_low[c] > snapshot->region_high[c])
            complain(builder, group, "region",
                     "along %c the region goes from %g to %g; expected the lowest corner first", "xyz"[c],
                     snapshot -> region_low[c], snapshot -> region_high[c]);
    }
}

void build_snapshots(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const size_t count = deck_count(builder->deck, "snapshot");
    if (count == 0) return;
    scene->snapshot = scene_array(builder, count, sizeof *scene->snapshot);
    if (scene->snapshot == NULL) return;
    scene->snapshots = count;
    for (size_t i = 0; i < count; i++) {
        const struct deck_group *group = deck_get(builder->deck, "snapshot", i);
        struct snapshot *snapshot = &scene->snapshot[i];
        const bool every = deck_given(group, "every"), times = deck_given(group, "times");
        if (every == times)
            complain(builder, group, every ? "times" : NULL, "a snapshot needs %s",
                     every ? "either every or times, not both" : "every (time between snapshots) or times");
        if (every) snapshot->every = deck_real(group, "every", 0);
        if (times) snapshot->time = read_times(builder, group, &snapshot->times);
        snapshot->fields = read_fields(group);
        read_region(builder, group, snapshot);
    }
}
