/* From the deck to the scene: what the words mean together. Every part reads its groups and complains with
 * their place in the deck; the parts go on after an error, so that all errors come in one pass. */
#include "base/memory.h"
#include "scene/build.h"
#include "scene/grading.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static void build_settings(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const struct deck_group *group = deck_get(builder->deck, "scene", 0);
    const char *title = deck_values(group, "title") > 0 ? deck_text(group, "title", 0) : "";
    if (strlen(title) >= sizeof scene->title)
        complain(builder, group, "title", "the title has %zu characters; expected at most %zu", strlen(title),
                 sizeof scene->title - 1);
    else
        memcpy(scene->title, title, strlen(title) + 1);
    scene->dimension = (int)deck_integer(group, "dimension", 0);
    scene->end_time = deck_real(group, "end_time", 0);
    scene->plane = (enum plane)deck_choice(group, "plane", 0);
    if (scene->dimension == 3 && deck_given(group, "plane"))
        complain(builder, group, "plane", "plane has no meaning in three dimensions; leave it out");
}

/* True if the points of the body are no lattice. */
static bool scattered(const struct deck *deck)
{
    if (deck_count(deck, "body") == 0) return false;
    const struct deck_group *body = deck_get(deck, "body", 0);
    return (deck_values(body, "jitter") > 0 && deck_real(body, "jitter", 0) > 0) ||
           deck_chosen(body, "shape", "points");
}

static const struct {
    const char *family, *name;
    enum point_places points;
} variants[] = {
#define NO_FAMILY(word)
#define VARIANT(symbol, ...) {__VA_ARGS__},
    METHODS(NO_FAMILY, VARIANT)};
enum { VARIANTS = sizeof variants / sizeof *variants };

static void refuse_variant(struct builder *builder, const struct deck_group *group, const char *family)
{
    char expected[256] = "";
    size_t used = 0, left = 0;
    for (size_t i = 0; i < VARIANTS; i++)
        left += strcmp(variants[i].family, family) == 0;
    for (size_t i = 0; i < VARIANTS && used < sizeof expected; i++)
        if (strcmp(variants[i].family, family) == 0)
            used += (size_t)snprintf(expected + used, sizeof expected - used, "%s'%s'",
                                     used == 0     ? ""
                                     : --left == 1 ? " or "
                                                   : ", ",
                                     variants[i].name);
    complain(builder, group, "variant", "method '%s' has no variant '%s'; expected %s", family,
             deck_text(group, "variant", 0), expected);
}

/* The default of each family is its first variant, or the first for scattered points; a variant must belong
 * to its family. */
static void build_method(struct builder *builder)
{
    struct method_choice *method = &builder->scene->method;
    const struct deck_group *group = deck_get(builder->deck, "method", 0);
    const char *family = deck_text(group, "name", 0);
    const bool given = deck_given(group, "variant"), scatter = !given && scattered(builder->deck);
    const char *wanted = given ? deck_text(group, "variant", 0) : "";
    size_t first = VARIANTS, found = VARIANTS;
    for (size_t i = VARIANTS; i-- > 0;) {
        if (strcmp(variants[i].family, family) != 0) continue;
        first = i;
        if (scatter ? variants[i].points == POINTS_SCATTERED : strcmp(variants[i].name, wanted) == 0)
            found = i;
    }
    if (given && found == VARIANTS) refuse_variant(builder, group, family);
    if (found == VARIANTS) found = first;
    method->group = group;
    method->mechanisms =
        deck_values(group, "mechanisms") > 0 ? (size_t)deck_integer(group, "mechanisms", 0) : 3;
    method->points = variants[found].points;
    snprintf(method->name, sizeof method->name, "%s", family);
    snprintf(method->variant, sizeof method->variant, "%s", variants[found].name);
}

static void build_stepping(struct builder *builder)
{
    static const char *const words[3] = {"time_step", "courant", "safety"};
    struct stepping_choice *stepping = &builder->scene->stepping;
    const struct deck_group *group = deck_get(builder->deck, "stepping", 0);
    double *const values[3] = {&stepping->time_step, &stepping->courant, &stepping->safety};
    int given = 0;
    for (int i = 0; i < 3; i++) {
        if (!deck_given(group, words[i])) continue;
        if (given++ > 0)
            complain(
                builder, group, words[i],
                "'%s' comes on top of another choice of the step; give one of time_step, courant and safety",
                words[i]);
        *values[i] = deck_real(group, words[i], 0);
    }
    if (given == 0) stepping->safety = .9;
    if (deck_values(group, "scheme") > 0)
        snprintf(stepping->scheme, sizeof stepping->scheme, "%s", deck_text(group, "scheme", 0));
    if (deck_values(group, "stages") > 0) stepping->stages = deck_integer(group, "stages", 0);
    if (deck_values(group, "max_stages") > 0) stepping->max_stages = deck_integer(group, "max_stages", 0);
    stepping->paper_rule = deck_chosen(group, "rule", "paper");
    if (stepping->stages > 0 && stepping->max_stages > 0)
        complain(builder, group, "max_stages", "give stages or max_stages, not both");
    stepping->unwarp_given = deck_given(group, "unwarp");
    if (stepping->unwarp_given) stepping->unwarp = deck_logical(group, "unwarp", 0);
    stepping->force = deck_logical(group, "force", 0);
    if (stepping->time_step > builder->scene->end_time)
        complain(builder, group, "time_step", "time_step = %g is longer than scene%%end_time = %g",
                 stepping->time_step, builder->scene->end_time);
}

/* A name that can stand in a plot's text: letters (UTF-8), digits, no more than fit. */
static void build_unit(struct builder *builder, const struct deck_group *group, const char *name,
                       char unit[UNIT_SIZE])
{
    if (deck_values(group, name) == 0) return;
    const char *given = deck_text(group, name, 0);
    bool plain = given[0] != '\0' && strlen(given) < UNIT_SIZE;
    for (const char *c = given; *c != '\0'; c++)
        plain = plain && ((unsigned char)*c >= 128 || isalnum((unsigned char)*c));
    if (plain)
        snprintf(unit, UNIT_SIZE, "%s", given);
    else
        complain(builder, group, name,
                 "'%.40s' is no name of a unit; expected up to %d letters and digits, like 'km'", given,
                 UNIT_SIZE - 1);
}

/* Results go where the user stands, not where the deck lies. */
static void build_output(struct builder *builder)
{
    struct output_choice *output = &builder->scene->output;
    const struct deck_group *group = deck_get(builder->deck, "output", 0);
    const bool given = deck_given(group, "directory");
    const char *name = given ? deck_text(group, "directory", 0) : deck_name(builder->deck);
    if (given && name[0] == '\0') complain(builder, group, "directory", "the directory is empty");
    const size_t room = strlen(name) + sizeof "output/";
    output->directory = scene_array(builder, room, 1);
    if (output->directory != NULL) snprintf(output->directory, room, "%s%s", given ? "" : "output/", name);
    output->plots = deck_logical(group, "plots", 0);
    build_unit(builder, group, "length_unit", output->length_unit);
    build_unit(builder, group, "time_unit", output->time_unit);
    output->history_step = deck_real(group, "history_step", 0);
    output->low_pass = deck_real(group, "low_pass", 0);
    output->balance = deck_values(group, "balance") > 0 && deck_logical(group, "balance", 0);
    output->checkpoint_every = deck_integer(group, "checkpoint_every", 0);
    output->checkpoint_minutes = deck_real(group, "checkpoint_minutes", 0);
}

static void build_reference(struct builder *builder)
{
    static const char *const file_words[] = {"file", NULL};
    static const char *const ground_words[] = {"spectrum", "stress", NULL};
    static const char *const tolerance_words[] = {"tolerance", NULL};
    struct reference *reference = &builder->scene->reference;
    if (deck_count(builder->deck, "reference") == 0) return;
    const struct deck_group *group = deck_get(builder->deck, "reference", 0);
    reference->group = group;
    snprintf(reference->kind, sizeof reference->kind, "%s", deck_text(group, "kind", 0));
    const bool layered = strcmp(reference->kind, "layered") == 0;
    if (!layered) refuse(builder, group, ground_words, "this reference, only to 'layered'");
    if (!layered && strcmp(reference->kind, "lamb") != 0)
        refuse(builder, group, tolerance_words, "this reference, only to 'layered' and 'lamb'");
    if (deck_values(group, "tolerance") > 0) reference->tolerance = deck_real(group, "tolerance", 0);
    reference->scheme = deck_values(group, "spectrum") > 0 && deck_choice(group, "spectrum", 0) == 1;
    reference->stress = deck_values(group, "stress") > 0 && deck_logical(group, "stress", 0);
    if (strcmp(reference->kind, "file") != 0) {
        refuse(builder, group, file_words, "an exact solution");
    } else if (deck_values(group, "file") == 0) {
        complain(builder, group, NULL, "reference 'file' needs file");
    } else {
        reference->file = deck_path(builder, deck_text(group, "file", 0));
    }
}

selas_status scene_build(const struct deck *deck, const struct scene_choice *choice, struct scene **scene,
                         struct messages *messages)
{
    *scene = array_new(1, sizeof **scene);
    if (*scene == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the scene");
    struct builder builder = {.deck = deck, .scene = *scene, .messages = messages};
    if (choice != NULL) {
        builder.accurate = true;
        builder.spacing = choice->spacing;
        builder.grading = choice->grading;
        builder.layer_points = choice->layer_points;
        builder.large = choice->large;
    }
    (*scene)->deck = deck;
    build_settings(&builder);
    build_method(&builder);
    build_stepping(&builder);
    build_output(&builder);
    build_reference(&builder);
    build_materials(&builder);
    build_body(&builder);
    build_layers(&builder);
    build_boundaries(&builder);
    build_topography(&builder);
    build_grading(&builder);
    build_loads(&builder);
    build_initial(&builder);
    build_receivers(&builder);
    build_profiles(&builder);
    build_snapshots(&builder);
    check_half_space(&builder);
    if (choice != NULL) {
        choice->check(&builder);
        (*scene)->method.degree = choice->degree;
        (*scene)->method.sweeps = choice->sweeps;
        if (choice->mechanisms > 0) (*scene)->method.mechanisms = choice->mechanisms;
        if (choice->scheme != NULL)
            snprintf((*scene)->stepping.scheme, sizeof(*scene)->stepping.scheme, "%s", choice->scheme);
        if (choice->courant > 0) {
            (*scene)->stepping.courant = choice->courant;
            (*scene)->stepping.safety = 0;
        }
    }
    if (builder.status != SELAS_OK) scene_free(scene);
    return builder.status;
}

void scene_free(struct scene **scene)
{
    if (scene == NULL || *scene == NULL) return;
    struct scene *old = *scene;
    for (int face = 0; face < FACES; face++)
        history_free(&old->boundary[face].history);
    for (size_t i = 0; i < old->loads; i++)
        history_free(&old->load[i].history);
    for (size_t i = 0; i < old->profiles; i++)
        array_free(old->profile[i].time);
    for (size_t i = 0; i < old->snapshots; i++)
        array_free(old->snapshot[i].time);
    for (size_t i = 0; i < old->body.layers; i++)
        height_map_free(old->body.layer[i].map);
    array_free(old->body.layer);
    array_free(old->body.block);
    ground_model_free(old->body.model);
    topography_free(old->body.topography);
    grading_free(old->body.grading);
    array_free(old->body.file);
    array_free(old->output.directory);
    array_free(old->reference.file);
    array_free(old->material);
    array_free(old->load);
    array_free(old->receiver);
    array_free(old->profile);
    array_free(old->snapshot);
    array_free(old);
    *scene = NULL;
}
