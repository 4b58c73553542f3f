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

/* Of a file; "?": it cannot be read. */
static uint64_t file_checksum(const struct crc64_table *table, const char *path)
{
    char block[4096];
    size_t length;
    uint64_t sum = 0;
    FILE *file = fopen(path, "rb");
    if (file == NULL) return crc64_add(table, 0, "?", 1);
    while ((length = fread(block, 1, sizeof block, file)) > 0)
        sum = crc64_add(table, sum, block, length);
    fclose(file);
    return sum;
}

struct sums {
    struct crc64_table table;
    const char *before; /* lines that these are held against; NULL: these are written */
    FILE *lines;
    bool differ;
};

static void add_line(struct sums *sums, const char *word, uint64_t sum)
{
    char line[128];
    const int length = snprintf(line, sizeof line, "%s=%016llx\n", word, (unsigned long long)sum);
    if (sums->before == NULL) {
        fputs(line, sums->lines);
        return;
    }
    for (const char *at = sums->before; (at = strstr(at, word)) != NULL; at++) {
        const bool begins = at == sums->before || at[-1] == '\n';
        if (begins && at[strlen(word)] == '=') {
            sums->differ = sums->differ || strncmp(at, line, (size_t)length) != 0;
            return;
        }
    }
}

static bool add_file(void *context, const char *word, const char *path, bool overridden)
{
    struct sums *sums = context;
    if (sums->before == NULL || !overridden) add_line(sums, word, file_checksum(&sums->table, path));
    return true;
}

static uint64_t add_bytes(const struct sums *sums, uint64_t sum, const void *bytes, size_t length)
{
    return bytes != NULL ? crc64_add(&sums->table, sum, bytes, length) : sum;
}

/* What a host gives beside the deck: points, and which loads and faces it drives; 0: nothing. */
static uint64_t sum_of_host(const struct scene *scene, const struct sums *sums)
{
    const struct given_points *given = scene->body.given;
    uint64_t sum = 0;
    if (given != NULL) {
        sum = add_bytes(sums, sum, given->position, 3 * given->count * sizeof *given->position);
        sum = add_bytes(sums, sum, given->volume, given->count * sizeof *given->volume);
        sum = add_bytes(sums, sum, given->material, given->count * sizeof *given->material);
    }
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].driven != BY_HISTORY) sum = add_bytes(sums, sum + 1, &k, sizeof k);
    for (size_t face = 0; face < FACES; face++)
        if (scene->boundary[face].driven != BY_HISTORY) sum = add_bytes(sums, sum + 2, &face, sizeof face);
    return sum;
}

static bool add_all(const struct scene *scene, struct sums *sums)
{
    crc64_prepare(&sums->table);
    const bool good = scene->deck == NULL || deck_files(scene->deck, add_file, sums);
    add_line(sums, "host", sum_of_host(scene, sums));
    return good;
}

char *kept_files(const struct scene *scene)
{
    char *text = NULL;
    size_t length = 0;
    struct sums sums = {.lines = open_memstream(&text, &length)};
    if (sums.lines == NULL) return NULL;
    const bool good = add_all(scene, &sums);
    if (fclose(sums.lines) == 0 && good) return text;
    free(text);
    return NULL;
}

bool kept_files_changed(const struct scene *scene, const char *files)
{
    struct sums sums = {.before = files};
    return add_all(scene, &sums) && sums.differ;
}

uint64_t kept_sum(const char *files)
{
    struct crc64_table table;
    crc64_prepare(&table);
    return crc64_add(&table, 0, files, files != NULL ? strlen(files) : 0);
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
