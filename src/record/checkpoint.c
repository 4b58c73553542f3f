/* Checkpoints: the state and what the recorder has seen, in one HDF5 file under its own name only when
 * complete.
 *
 * /y, /a: state; /trace_N: rows of receiver N, (u, v, a) of every step; /profile_N and /seen_N: what the
 * profiles have; /watch: the energy watch as this version of the library keeps it. Attributes: version, deck
 * (with all defaults: a checkpoint goes on only with the very same scene), step and time. Numbers have 64
 * bits: what is read back is what was written. */
#include "record/run_file.h"

#include "base/memory.h"
#include "record/safe_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One array of the checkpoint, written or read by the same list. */
struct piece {
    char name[32];
    hid_t type;
    void *data;
    size_t count;
};

static bool transfer(hid_t file, const struct piece *piece, bool write)
{
    if (piece->count == 0) return true;
    const hsize_t size = piece->count;
    hid_t set = -1;
    bool good = false;
    if (write) {
        const hid_t space = H5Screate_simple(1, &size, NULL);
        set = H5Dcreate2(file, piece->name, piece->type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        good = set >= 0 && H5Dwrite(set, piece->type, H5S_ALL, H5S_ALL, H5P_DEFAULT, piece->data) >= 0;
        H5Sclose(space);
    } else if ((set = H5Dopen2(file, piece->name, H5P_DEFAULT)) >= 0) {
        const hid_t space = H5Dget_space(set);
        good = H5Sget_simple_extent_npoints(space) == (hssize_t)piece->count &&
               H5Dread(set, piece->type, H5S_ALL, H5S_ALL, H5P_DEFAULT, piece->data) >= 0;
        H5Sclose(space);
    }
    if (set >= 0) H5Dclose(set);
    return good;
}

/* State, receivers and profiles; `rows` is the number of steps seen. */
static bool transfer_all(hid_t file, struct recorder *recorder, struct state *state, size_t rows, bool write)
{
    const struct model *model = recorder->model;
    const struct scene *scene = recorder->scene;
    const hid_t real = H5T_NATIVE_DOUBLE, byte = H5T_NATIVE_UCHAR;
    const struct piece own[4] = {{"y", real, state->y, model->state_size},
                                 {"a", real, state->a, model->unknowns},
                                 {"watch", byte, &recorder->watch, sizeof recorder->watch},
                                 {"before", byte, &recorder->before, sizeof recorder->before}};
    bool good = true;
    for (size_t i = 0; i < 4; i++)
        good = good && transfer(file, &own[i], write);
    for (size_t r = 0; good && r < scene->receivers; r++) {
        struct trace *trace = &recorder->trace[r];
        double *const part[3] = {trace->u, trace->v, trace->a};
        for (size_t k = 0; k < 3; k++) {
            struct piece piece = {.type = real, .data = part[k], .count = 3 * rows};
            snprintf(piece.name, sizeof piece.name, "trace_%zu_%c", r + 1, "uva"[k]);
            good = good && transfer(file, &piece, write);
        }
        trace->rows = rows;
    }
    for (size_t p = 0; good && p < scene->profiles; p++) {
        struct profile_record *record = &recorder->profile[p];
        const size_t times = record->profile->times;
        struct piece value = {.type = real, .data = record->value};
        struct piece seen = {.type = byte, .data = record->seen, .count = times};
        value.count = times * record->profile->points * record->columns;
        snprintf(value.name, sizeof value.name, "profile_%zu", p + 1);
        snprintf(seen.name, sizeof seen.name, "seen_%zu", p + 1);
        good = transfer(file, &value, write) && transfer(file, &seen, write);
    }
    return good;
}

/* The deck with all defaults as text (free it), "" without a deck; NULL without memory. */
static char *scene_text(const struct scene *scene, struct messages *messages)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file == NULL) return NULL;
    const selas_status status = scene->deck != NULL ? deck_write(scene->deck, file, messages) : SELAS_OK;
    if (fclose(file) == 0 && status == SELAS_OK) return text;
    free(text);
    return NULL;
}

static bool same_text(hid_t file, const char *name, const char *expected)
{
    const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    if (attribute < 0) return false;
    const hid_t type = H5Aget_type(attribute);
    const size_t size = H5Tget_size(type);
    char *text = calloc(size + 1, 1);
    const bool same = text != NULL && H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                      H5Aread(attribute, type, text) >= 0 && strcmp(text, expected) == 0;
    free(text);
    H5Tclose(type);
    H5Aclose(attribute);
    return same;
}

static bool read_numbers(hid_t file, const char *name, double value[4])
{
    const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    if (attribute < 0) return false;
    const hid_t space = H5Aget_space(attribute);
    const bool good =
        H5Sget_simple_extent_npoints(space) == 4 && H5Aread(attribute, H5T_NATIVE_DOUBLE, value) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    return good;
}

selas_status checkpoint_write(struct recorder *recorder, struct state *state, const char *path,
                              struct messages *messages)
{
    char *text = scene_text(recorder->scene, messages), *temporary = NULL;
    const size_t room = strlen(path) + 16;
    temporary = malloc(room);
    if (text == NULL || temporary == NULL) {
        free(text);
        free(temporary);
        return fail(messages, SELAS_NO_MEMORY, "no memory for a checkpoint");
    }
    snprintf(temporary, room, "%s.new", path);
    const double figures[4] = {(double)state->step, state->time, recorder->last_time, recorder->before_time};
    bool good = false;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        const hid_t file = H5Fcreate(temporary, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
        if (file >= 0) {
            good = hdf_text(file, "version", selas_version()) && hdf_numbers(file, "figures", 4, figures) &&
                   transfer_all(file, recorder, state, (size_t)state->step + 1, true);
            const struct piece deck = {"deck", H5T_NATIVE_CHAR, text, strlen(text) + 1};
            good = good && transfer(file, &deck, true);
            good = H5Fclose(file) >= 0 && good;
        }
        quiet_end(quiet);
    }
    selas_status status = SELAS_OK;
    if (good) {
        status = safe_file_commit(temporary, path, messages);
    } else {
        remove(temporary);
        status = fail(messages, SELAS_FILE_ERROR, "cannot write the checkpoint '%s'", path);
    }
    free(text);
    free(temporary);
    return status;
}

/* The same deck to the letter. */
static bool same_deck(hid_t file, const char *text)
{
    const size_t size = strlen(text) + 1;
    char *kept = malloc(size);
    const struct piece deck = {"deck", H5T_NATIVE_CHAR, kept, size};
    const bool same = kept != NULL && transfer(file, &deck, false) && memcmp(kept, text, size) == 0;
    free(kept);
    return same;
}

static const char *read_all(hid_t file, struct recorder *recorder, struct state *state, const char *text,
                            struct messages *messages)
{
    double figures[4];
    if (!same_text(file, "version", selas_version()) || !read_numbers(file, "figures", figures))
        return "it is no checkpoint of this version";
    if (!same_deck(file, text)) return "it is of another scene";
    if (!(figures[0] >= 0 && figures[0] < 9e15)) return "its step makes no sense";
    const size_t rows = (size_t)figures[0] + 1;
    if (trace_reserve(recorder, rows, messages) != SELAS_OK) return "there is no memory for its histories";
    if (!transfer_all(file, recorder, state, rows, false)) return "it is damaged";
    state->step = (unsigned long)figures[0];
    state->time = figures[1];
    recorder->last_step = state->step;
    recorder->last_time = figures[2];
    recorder->before_time = figures[3];
    recorder->started = true;
    return NULL;
}

selas_status checkpoint_read(struct recorder *recorder, struct state *state, const char *path,
                             struct messages *messages)
{
    char *text = scene_text(recorder->scene, messages);
    const char *wrong = "it cannot be opened";
    if (text == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a checkpoint");
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        if (file >= 0) {
            wrong = read_all(file, recorder, state, text, messages);
            H5Fclose(file);
        }
        quiet_end(quiet);
    }
    free(text);
    return wrong == NULL
               ? SELAS_OK
               : fail(messages, SELAS_FILE_ERROR, "the checkpoint '%s' cannot be used: %s", path, wrong);
}
