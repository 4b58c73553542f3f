/* Comparing two files or two run folders, with a table and plots. */
#include "compare/diff.h"

#include "base/safe_file.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_folder(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static void write_table_row(FILE *table, const char *receiver, const char *component,
                            const struct channel_difference *d)
{
    if (table == NULL) return;
    fprintf(table, "%-20s %-4s %10.3e %10.3e %11.3e %10.3e %10.3e %s", receiver, component, d->l2, d->linf,
            d->shift, d->envelope, d->phase, d->differs ? "differs" : "same");
    if (isfinite(d->excess) && d->excess > 1.0)
        fprintf(table, " (%.3g times what is allowed, t = %.6g)", d->excess, d->when);
    if (!isfinite(d->excess))
        fprintf(table, " (%s, t = %.6g)", isfinite(d->l2) ? "none is allowed" : "not finite", d->when);
    if (d->absolute) fputs(" (L2 and Linf absolute: the first run is zero)", table);
    fputc('\n', table);
}

/* What the two are compared with and where the outcome goes. */
struct comparison {
    const char *a, *b; /* as named by the user */
    const struct tolerance *tolerance;
    struct diff_report *report;
    size_t compared;
    bool told; /* of units and low-passes */
    struct messages *messages;
};

static void tell_times(FILE *table, const char *receiver, const struct history_file *a,
                       const struct history_file *b)
{
    if (table == NULL || same_span(a, b)) return;
    fprintf(table, "%-20s      times %.6g to %.6g against %.6g to %.6g\n", receiver, a->time[0],
            a->time[a->rows - 1], b->time[0], b->time[b->rows - 1]);
}

static selas_status diff_files(struct comparison *c, const char *a, const char *b, const char *receiver)
{
    struct history_file first = {0}, second = {0};
    struct channel_difference difference[DIFF_CHANNELS];
    struct diff_report *report = c->report;
    selas_status status = history_file_read(a, &first, c->messages);
    if (status == SELAS_OK) status = history_file_read(b, &second, c->messages);
    if (status == SELAS_OK) status = diff_histories(&first, &second, c->tolerance, difference, c->messages);
    size_t differences = 0;
    for (size_t k = 0; k < DIFF_CHANNELS && status == SELAS_OK; k++) {
        write_table_row(report->table, receiver, diff_channel[k], &difference[k]);
        if (difference[k].differs) differences++;
    }
    if (status == SELAS_OK) {
        const char *const label[2] = {c->a, c->b};
        tell_times(report->table, receiver, &first, &second);
        tell_heads(receiver, label, &first, &second, &c->told, c->messages);
        if (differences > 0)
            status = tell_interpolation(receiver, label, &first, &second, difference, c->messages);
        if (report->plots != NULL && differences > 0)
            diff_plots(report->plots, receiver, label, &first, &second, difference, c->messages);
        report->differences += differences;
    }
    history_file_free(&first);
    history_file_free(&second);
    return status;
}

/* A history begins with the header that histories have; profiles and others do not. */
static bool is_history(const char *path)
{
    FILE *file = fopen(path, "r");
    if (file == NULL) return false;
    char line[1024];
    bool found = false;
    while (!found && fgets(line, sizeof line, file) != NULL && line[0] == '#')
        found = strncmp(line, "# t ux uy uz vx vy vz", 21) == 0;
    fclose(file);
    return found;
}

static char *path_in(const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s/%s", folder, name);
    return path;
}

static bool has_ending(const char *name, const char *ending)
{
    const size_t length = strlen(name), tail = strlen(ending);
    return length > tail && strcmp(name + length - tail, ending) == 0;
}

/* Receiver `name` of folder `a` is compared with its namesake in `b`, or (with `only_missing`) just looked
 * for. */
static selas_status diff_one(struct comparison *c, const char *a, const char *b, const char *name,
                             bool only_missing)
{
    char file[FILE_NAME_SIZE];
    snprintf(file, sizeof file, "%s.dat", name);
    char *here = path_in(a, file), *there = path_in(b, file);
    selas_status status = SELAS_OK;
    struct stat about;
    c->compared++;
    if (here == NULL || there == NULL) {
        status = fail(c->messages, SELAS_NO_MEMORY, "no memory for the name of a file");
    } else if (stat(there, &about) != 0) {
        c->report->differences++;
        if (c->report->table != NULL) fprintf(c->report->table, "%-20s is not in %s\n", name, b);
    } else if (!only_missing) {
        status = diff_files(c, here, there, name);
    }
    free(here);
    free(there);
    return status;
}

/* Receivers of a folder without run.h5: its files that are histories. */
static selas_status find_receivers(const char *folder, struct run_receivers *receivers,
                                   struct messages *messages)
{
    struct dirent **entry = NULL;
    const int count = scandir(folder, &entry, NULL, alphasort);
    if (count < 0)
        return fail(messages, SELAS_FILE_ERROR, "cannot read the folder '%s': %s", folder, strerror(errno));
    receivers->name = calloc((size_t)count + 1, sizeof *receivers->name);
    for (int i = 0; i < count; i++) {
        char *name = entry[i]->d_name, *path = path_in(folder, name);
        if (receivers->name != NULL && path != NULL && has_ending(name, ".dat") &&
            !has_ending(name, ".exact.dat") && is_history(path)) {
            name[strlen(name) - strlen(".dat")] = '\0';
            receivers->name[receivers->count] = strdup(name);
            if (receivers->name[receivers->count] != NULL) receivers->count++;
        }
        free(path);
        free(entry[i]);
    }
    free(entry);
    return SELAS_OK;
}

static selas_status diff_folder(struct comparison *c, const char *a, const char *b, bool only_missing)
{
    struct run_receivers receivers = {0};
    char *run = path_in(a, "run.h5");
    selas_status status = SELAS_OK;
    if (run == NULL || !run_receivers_read(run, &receivers))
        status = find_receivers(a, &receivers, c->messages);
    for (size_t r = 0; r < receivers.count && status == SELAS_OK; r++)
        status = diff_one(c, a, b, receivers.name[r], only_missing);
    run_receivers_free(&receivers);
    free(run);
    return status;
}

/* Name of a file without its folder and ".dat". */
static void receiver_of(const char *path, char *receiver, size_t size)
{
    const char *slash = strrchr(path, '/');
    snprintf(receiver, size, "%s", slash != NULL ? slash + 1 : path);
    if (has_ending(receiver, ".dat")) receiver[strlen(receiver) - strlen(".dat")] = '\0';
}

selas_status diff_paths(const char *a, const char *b, const struct tolerance *tolerance,
                        struct diff_report *report, struct messages *messages)
{
    report->differences = 0;
    const char *const path[2] = {a, b};
    for (int k = 0; k < 2; k++)
        if (access(path[k], F_OK) != 0)
            return fail(messages, SELAS_FILE_ERROR, "cannot open '%s': %s", path[k], strerror(errno));
    const bool folder = is_folder(a);
    if (folder != is_folder(b))
        return fail(messages, SELAS_BAD_ARGUMENT, "'%s' and '%s' are not both folders or both files", a, b);
    if (report->table != NULL)
        fprintf(report->table, "%-20s %-4s %10s %10s %11s %10s %10s\n", "receiver", "", "L2", "Linf", "shift",
                "envelope", "phase");
    struct comparison c = {a,     b,       tolerance != NULL ? tolerance : &tolerance_default, report, 0,
                           false, messages};
    if (!folder) {
        char receiver[128];
        receiver_of(a, receiver, sizeof receiver);
        return diff_files(&c, a, b, receiver);
    }
    selas_status status = diff_folder(&c, a, b, false);
    if (status == SELAS_OK) status = diff_folder(&c, b, a, true);
    if (status == SELAS_OK && c.compared == 0)
        return fail(messages, SELAS_FILE_ERROR, "there are no histories in '%s'", a);
    return status;
}
