/* Where a run comes from: /provenance in run.h5, and the first lines of report.txt. */
#include "record/kept.h"
#include "record/run_file.h"

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

static const char *build_flags(void)
{
    return SELAS_FLAGS;
}

const char *build_commit(void)
{
    return SELAS_COMMIT;
}

static const char *compiler_name(void)
{
#ifdef __clang__
    return __VERSION__; /* says its own name */
#else
    return "gcc " __VERSION__;
#endif
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

struct lines {
    hid_t place;
    bool good;
};

static void write_line(void *pointer, const char *key, const char *value)
{
    struct lines *lines = pointer;
    lines->good = hdf_text(lines->place, key, value) && lines->good;
}

static bool write_origin(const struct recorder *recorder, hid_t place, const struct run_figures *figures)
{
    const double threads = figures != NULL ? (double)figures->threads : 0.0;
    const struct stepper *stepper = recorder->stepper;
    const double steps = (double)recorder->last_step;
    struct lines lines = {place, true};
    provenance_tell(write_line, &lines);
    return lines.good && hdf_numbers(place, "threads", 1, &threads) &&
           hdf_text(place, "scheme", stepper->scheme->name) &&
           hdf_numbers(place, "time_step", 1, &stepper->dt) && hdf_numbers(place, "steps", 1, &steps) &&
           hdf_text(place, "method", recorder->model->method->name) &&
           hdf_text(place, "variant", recorder->model->method->variant);
}

static bool write_deck_texts(const struct recorder *recorder, hid_t place, struct messages *messages)
{
    const struct deck *deck = recorder->scene->deck;
    if (deck == NULL) return true;
    char *echo = deck_echo(deck, messages);
    const bool good = echo != NULL &&
                      hdf_text(place, "files", recorder->files != NULL ? recorder->files : "") &&
                      hdf_text(place, "deck", deck_source(deck)) && hdf_text(place, "deck_echo", echo) &&
                      hdf_text(place, "deck_name", deck_name(deck));
    free(echo);
    return good;
}

bool write_provenance(const struct recorder *recorder, hid_t file, const struct run_figures *figures,
                      struct messages *messages)
{
    const hid_t place = hdf_group(file, "provenance");
    const bool good = place >= 0 && write_origin(recorder, place, figures) &&
                      write_deck_texts(recorder, place, messages) &&
                      hdf_text(file, "title", recorder->scene->title);
    if (place >= 0) H5Gclose(place);
    return good;
}
