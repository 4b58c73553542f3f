/* Comparing two files or two run folders, with a table. */
#include "record/diff.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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
    if (d->excess > 1.0) fprintf(table, " (%.3g times what is allowed, t = %.6g)", d->excess, d->when);
    fputc('\n', table);
}

static selas_status diff_files(const char *a, const char *b, const char *receiver,
                               const struct tolerance *tolerance, FILE *table, size_t *differences,
                               struct messages *messages)
{
    static const char *const component[6] = {"ux", "uy", "uz", "vx", "vy", "vz"};
    struct history_file first = {0}, second = {0};
    struct channel_difference difference[6];
    selas_status status = history_file_read(a, &first, messages);
    if (status == SELAS_OK) status = history_file_read(b, &second, messages);
    if (status == SELAS_OK) status = diff_histories(&first, &second, tolerance, difference, messages);
    for (size_t c = 0; c < 6 && status == SELAS_OK; c++) {
        write_table_row(table, receiver, component[c], &difference[c]);
        if (difference[c].differs) ++*differences;
    }
    if (status == SELAS_OK && table != NULL &&
        (first.time[0] != second.time[0] || first.time[first.rows - 1] != second.time[second.rows - 1]))
        fprintf(table, "%-20s      times %.6g to %.6g against %.6g to %.6g\n", receiver, first.time[0],
                first.time[first.rows - 1], second.time[0], second.time[second.rows - 1]);
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

/* What folder `a` has is compared with its namesake in `b`, or (with `only_missing`) just looked for. */
static selas_status diff_one(const char *a, const char *b, const char *name, bool only_missing,
                             const struct tolerance *tolerance, FILE *table, size_t *differences,
                             size_t *compared, struct messages *messages)
{
    if (!has_ending(name, ".dat") || has_ending(name, ".exact.dat")) return SELAS_OK;
    char *here = path_in(a, name), *there = path_in(b, name);
    selas_status status = SELAS_OK;
    if (here == NULL || there == NULL) {
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the name of a file");
    } else if (is_history(here)) {
        struct stat about;
        ++*compared;
        if (stat(there, &about) != 0) {
            ++*differences;
            if (table != NULL) fprintf(table, "%-20.*s is not in %s\n", (int)strlen(name) - 4, name, b);
        } else if (!only_missing) {
            char receiver[128];
            snprintf(receiver, sizeof receiver, "%.*s", (int)strlen(name) - 4, name);
            status = diff_files(here, there, receiver, tolerance, table, differences, messages);
        }
    }
    free(here);
    free(there);
    return status;
}

static selas_status diff_folder(const char *a, const char *b, bool only_missing,
                                const struct tolerance *tolerance, FILE *table, size_t *differences,
                                size_t *compared, struct messages *messages)
{
    struct dirent **entry = NULL;
    const int count = scandir(a, &entry, NULL, alphasort);
    if (count < 0)
        return fail(messages, SELAS_FILE_ERROR, "cannot read the folder '%s': %s", a, strerror(errno));
    selas_status status = SELAS_OK;
    for (int i = 0; i < count; i++) {
        if (status == SELAS_OK)
            status = diff_one(a, b, entry[i]->d_name, only_missing, tolerance, table, differences, compared,
                              messages);
        free(entry[i]);
    }
    free(entry);
    return status;
}

selas_status diff_paths(const char *a, const char *b, const struct tolerance *tolerance, FILE *table,
                        size_t *differences, struct messages *messages)
{
    *differences = 0;
    if (tolerance == NULL) tolerance = &tolerance_default;
    const bool folder = is_folder(a);
    if (folder != is_folder(b))
        return fail(messages, SELAS_BAD_ARGUMENT, "'%s' and '%s' are not both folders or both files", a, b);
    if (table != NULL)
        fprintf(table, "%-20s %-4s %10s %10s %11s %10s %10s\n", "receiver", "", "L2", "Linf", "shift",
                "envelope", "phase");
    if (!folder) {
        const char *slash = strrchr(a, '/');
        return diff_files(a, b, slash != NULL ? slash + 1 : a, tolerance, table, differences, messages);
    }
    size_t compared = 0;
    selas_status status = diff_folder(a, b, false, tolerance, table, differences, &compared, messages);
    if (status == SELAS_OK)
        status = diff_folder(b, a, true, tolerance, table, differences, &compared, messages);
    if (status == SELAS_OK && compared == 0)
        return fail(messages, SELAS_FILE_ERROR, "there are no histories in '%s'", a);
    return status;
}
