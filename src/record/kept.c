/* Decks that files keep (see the header). */
#include "record/kept.h"

#include "base/crc64.h"
#include "base/stored.h"
#include "record/checkpoint_head.h"
#include "record/run_file.h"
#include "record/sets.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static uint64_t file_checksum(const struct crc64_table *table, uint64_t before, const char *path)
{
    char block[4096];
    size_t length;
    FILE *file = fopen(path, "rb");
    if (file == NULL) return crc64_add(table, before, "?", 1);
    while ((length = fread(block, 1, sizeof block, file)) > 0)
        before = crc64_add(table, before, block, length);
    fclose(file);
    return before;
}

struct sum {
    struct crc64_table table;
    uint64_t checksum;
};

static bool add_file(void *context, const char *path)
{
    struct sum *sum = context;
    sum->checksum = file_checksum(&sum->table, sum->checksum, path);
    return true;
}

static void add_bytes(struct sum *sum, const void *bytes, size_t length)
{
    if (bytes != NULL) sum->checksum = crc64_add(&sum->table, sum->checksum, bytes, length);
}

/* What a host gives beside the deck: points, and which loads and faces it drives. */
static void add_host(const struct scene *scene, struct sum *sum)
{
    const struct given_points *given = scene->body.given;
    if (given != NULL) {
        add_bytes(sum, given->position, 3 * given->count * sizeof *given->position);
        add_bytes(sum, given->volume, given->count * sizeof *given->volume);
        add_bytes(sum, given->material, given->material != NULL ? given->count * sizeof *given->material : 0);
    }
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].driven != BY_HISTORY) add_bytes(sum, &k, sizeof k);
    for (size_t face = 0; face < FACES; face++)
        if (scene->boundary[face].driven != BY_HISTORY) add_bytes(sum, &face, sizeof face);
}

bool kept_files_checksum(const struct scene *scene, uint64_t *checksum)
{
    struct sum sum = {.checksum = 0};
    crc64_prepare(&sum.table);
    const bool good = scene->deck == NULL || deck_files(scene->deck, add_file, &sum);
    add_host(scene, &sum);
    *checksum = sum.checksum;
    return good;
}

void kept_text_of(uint64_t checksum, char text[KEPT_CHECKSUM])
{
    snprintf(text, KEPT_CHECKSUM, "%016llx", (unsigned long long)checksum);
}

bool kept_files_text(const struct scene *scene, char text[KEPT_CHECKSUM])
{
    uint64_t checksum = 0;
    const bool good = kept_files_checksum(scene, &checksum);
    kept_text_of(checksum, text);
    return good;
}

selas_status kept_deck_of_checkpoint(const char *path, struct ranks *ranks, struct kept_deck *kept,
                                     struct messages *messages)
{
    char why[200] = "it holds no deck", rounding[CHECKPOINT_ROUNDING];
    *kept = (struct kept_deck){0};
    if (checkpoint_whole(path, ranks, why, sizeof why, rounding)) {
        snprintf(why, sizeof why, "it holds no deck");
#pragma omp critical(selas_hdf5)
        {
            const struct quiet quiet = quiet_begin();
            const hid_t file = hdf_open_file(path);
            if (file >= 0) {
                kept->text = set_text(file, "deck");
                kept->source = set_text(file, "source");
                kept->name = set_text(file, "name");
                kept->origin = set_text(file, "origin");
                H5Fclose(file);
            }
            quiet_end(quiet);
        }
    }
    if (kept->text != NULL && kept->source != NULL && kept->name != NULL && kept->text[0] != '\0')
        return SELAS_OK;
    kept_deck_free(kept);
    return fail(messages, SELAS_FILE_ERROR, "the checkpoint '%s' cannot be used: %s", path, why);
}

/* A text that is an attribute or, if it is long, a data set (provenance.c); NULL if there is none. */
static char *provenance_text(hid_t place, const char *name)
{
    const bool attribute = H5Aexists(place, name) > 0;
    const hid_t from = attribute ? H5Aopen(place, name, H5P_DEFAULT) : stored_set(place, name);
    if (from < 0) return NULL;
    const hid_t type = attribute ? H5Aget_type(from) : H5Dget_type(from);
    const hid_t space = attribute ? H5Aget_space(from) : H5Dget_space(from);
    const size_t size = H5Tget_size(type);
    const bool right = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                       H5Sget_simple_extent_npoints(space) == 1 && size < (size_t)1 << 30;
    char *text = right ? calloc(size + 1, 1) : NULL;
    const bool good =
        text != NULL && (attribute ? H5Aread(from, type, text)
                                   : H5Dread(from, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text)) >= 0;
    H5Sclose(space);
    H5Tclose(type);
    if (attribute)
        H5Aclose(from);
    else
        H5Dclose(from);
    if (good) return text;
    free(text);
    return NULL;
}

selas_status kept_deck_of_run(const char *path, struct kept_deck *kept, struct messages *messages)
{
    *kept = (struct kept_deck){0};
    const struct quiet quiet = quiet_begin();
    const hid_t file = hdf_open_file(path);
    const int error = errno;
    const hid_t place =
        file >= 0 && stored_here(file, "provenance") ? H5Gopen2(file, "provenance", H5P_DEFAULT) : -1;
    if (place >= 0) {
        kept->text = provenance_text(place, "deck_echo");
        kept->source = provenance_text(place, "deck");
        kept->name = provenance_text(place, "deck_name");
        kept->files = provenance_text(place, "files");
        H5Gclose(place);
    }
    if (file >= 0) H5Fclose(file);
    quiet_end(quiet);
    if (kept->text != NULL && kept->source != NULL && kept->name != NULL) return SELAS_OK;
    kept_deck_free(kept);
    if (file < 0) return hdf_cannot("read", path, error, messages);
    return fail(messages, SELAS_FILE_ERROR,
                "'%s' holds no deck (/provenance/deck_echo): is it the run.h5 of a run?", path);
}

void kept_deck_free(struct kept_deck *kept)
{
    free(kept->text);
    free(kept->source);
    free(kept->name);
    free(kept->origin);
    free(kept->files);
    *kept = (struct kept_deck){0};
}
