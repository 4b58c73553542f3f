/* Where a run comes from: /settings (every setting of the deck) and /provenance in run.h5. */
#include "record/run_file.h"

#include <ctype.h>
#include <fftw3.h>
#include <gsl/gsl_version.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifndef SELAS_FLAGS
#define SELAS_FLAGS "not recorded"
#endif
#ifndef SELAS_COMMIT
#define SELAS_COMMIT "unknown"
#endif

const char *build_flags(void)
{
    return SELAS_FLAGS;
}

const char *build_commit(void)
{
    return SELAS_COMMIT;
}

const char *compiler_name(void)
{
#ifdef __clang__
    return __VERSION__; /* says its own name */
#else
    return "gcc " __VERSION__;
#endif
}

/* Text attributes are kept in the object header, which holds at most 64 KiB: longer texts become data sets.
 */
static bool write_long_text(hid_t place, const char *name, const char *text)
{
    if (strlen(text) < 32000) return hdf_text(place, name, text);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) + 1);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t set = H5Dcreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    if (set >= 0) H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    return good;
}

struct settings_context {
    hid_t settings;
    bool good;
};

/* Numbers of a value list, or 0 if it holds anything else. */
static size_t numbers_of(const char *value, double *number, size_t room)
{
    size_t count = 0;
    for (const char *at = value; *at != '\0';) {
        char *end = NULL;
        const double x = strtod(at, &end);
        if (end == at || isalpha((unsigned char)*at) || count == room) return 0;
        number[count++] = x;
        at = end;
        while (isspace((unsigned char)*at) || *at == ',')
            at++;
    }
    return count;
}

static void write_setting(void *pointer, const char *group, size_t occurrence, const char *name,
                          const char *value)
{
    struct settings_context *context = pointer;
    char path[NAME_SIZE + 24];
    snprintf(path, sizeof path, "%s_%zu", group, occurrence);
    const bool there = H5Lexists(context->settings, path, H5P_DEFAULT) > 0;
    const hid_t place =
        there ? H5Gopen2(context->settings, path, H5P_DEFAULT) : hdf_group(context->settings, path);
    enum { ROOM = 512 };
    double number[ROOM];
    const size_t count = numbers_of(value, number, ROOM);
    bool good = place >= 0;
    if (good && count > 0) {
        good = hdf_numbers(place, name, count, number);
    } else if (good) { /* a single string goes without its quotes, anything else as it stands */
        const size_t length = strlen(value);
        const bool single = length >= 2 && (value[0] == '\'' || value[0] == '"') &&
                            strchr(value + 1, value[0]) == value + length - 1;
        char *text = single ? strndup(value + 1, length - 2) : strdup(value);
        good = text != NULL && write_long_text(place, name, text);
        free(text);
    }
    if (place >= 0) H5Gclose(place);
    context->good = context->good && good;
}

void provenance_tell(void (*tell)(void *context, const char *key, const char *value), void *context)
{
    char host[256] = "", date[64] = "", hdf[32];
    if (gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
    const time_t now = time(NULL);
    struct tm split;
    if (gmtime_r(&now, &split) != NULL) strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &split);
    unsigned major = 0, minor = 0, release = 0;
    H5get_libversion(&major, &minor, &release);
    snprintf(hdf, sizeof hdf, "%u.%u.%u", major, minor, release);
    tell(context, "version", selas_version());
    tell(context, "commit", build_commit());
    tell(context, "compiler", compiler_name());
    tell(context, "flags", build_flags());
    tell(context, "hdf5", hdf);
    tell(context, "fftw", fftw_version);
    tell(context, "gsl", gsl_version);
    tell(context, "host", host);
    tell(context, "date", date);
}

static void write_line(void *pointer, const char *key, const char *value)
{
    struct settings_context *context = pointer;
    context->good = hdf_text(context->settings, key, value) && context->good;
}

static bool write_origin(const struct recorder *recorder, hid_t place, const struct run_figures *figures)
{
    const double threads = figures != NULL ? (double)figures->threads : 0.0;
    const struct stepper *stepper = recorder->stepper;
    const double steps = (double)recorder->last_step;
    struct settings_context context = {place, true};
    provenance_tell(write_line, &context);
    return context.good && hdf_numbers(place, "threads", 1, &threads) &&
           hdf_text(place, "scheme", stepper->scheme->name) &&
           hdf_numbers(place, "time_step", 1, &stepper->dt) && hdf_numbers(place, "steps", 1, &steps) &&
           hdf_text(place, "method", recorder->model->method->name) &&
           hdf_text(place, "variant", recorder->model->method->variant);
}

static bool write_deck_texts(const struct deck *deck, hid_t place, struct messages *messages)
{
    if (deck == NULL) return true;
    char *echo = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&echo, &size);
    if (memory == NULL) return false;
    bool good = deck_write(deck, memory, messages) == SELAS_OK;
    good = fclose(memory) == 0 && good;
    good = good && write_long_text(place, "deck", deck_source(deck)) &&
           write_long_text(place, "deck_echo", echo) && hdf_text(place, "deck_name", deck_name(deck));
    free(echo);
    return good;
}

bool write_provenance(const struct recorder *recorder, hid_t file, const struct run_figures *figures,
                      struct messages *messages)
{
    const struct deck *deck = recorder->scene->deck;
    struct settings_context context = {hdf_group(file, "settings"), true};
    if (context.settings < 0) return false;
    const bool told = settings_walk(deck, write_setting, &context, messages);
    H5Gclose(context.settings);
    const hid_t place = hdf_group(file, "provenance");
    const bool good = told && context.good && place >= 0 && write_origin(recorder, place, figures) &&
                      write_deck_texts(deck, place, messages) &&
                      hdf_text(file, "title", recorder->scene->title);
    if (place >= 0) H5Gclose(place);
    return good;
}
