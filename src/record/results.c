/* Which files in the folder of the results are a run's own. The file `.selas-results` there lists what selas
 * has written into it, one name a line: so a run overwrites nothing but results of selas, and takes away what
 * an earlier run has left and this one does not write. */
#include "record/results.h"

#include "base/memory.h"
#include "base/safe_file.h"
#include "damping/ground.h"
#include "record/kept.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char list_name[] = ".selas-results";

/* --- Lists: a text "\nNAME\nNAME\n" --- */

static void put(FILE *list, const char *stem, const char *ending)
{
    char name[FILE_NAME_SIZE];
    file_name_of(stem, ending, name, sizeof name);
    fprintf(list, "%s\n", name);
}

static size_t pictures_of(const struct recorder *recorder, bool done)
{
    const struct scene *scene = recorder->scene;
    double most = 0.0;
    for (size_t s = 0; s < scene->snapshots; s++) {
        const struct snapshot *snapshot = &scene->snapshot[s];
        most += snapshot->every > 0.0 ? floor(scene->end_time / snapshot->every * (1.0 + 1e-9)) + 1.0
                                      : (double)snapshot->times;
    }
    const double steps = (double)(recorder->stepper->steps + 1) * (double)scene->snapshots;
    return done ? recorder->entries : (size_t)fmin(most, steps);
}

static void put_pictures(FILE *list, const struct recorder *recorder, bool done)
{
    const struct scene *scene = recorder->scene;
    for (size_t r = 0; r < scene->receivers; r++)
        put(list, scene->receiver[r].name, ".png");
    for (size_t k = 0; k < pictures_of(recorder, done); k++)
        fprintf(list, "snapshot_%04zu.png\n", k);
    for (size_t s = 0; s < scene->snapshots; s++)
        fprintf(list, s == 0 ? "surface.gif\n" : "surface_%zu.gif\n", s + 1);
    if (ground_is_damped(scene)) fprintf(list, "damping.png\n");
    if (plots_ground(scene)) fprintf(list, "ground.png\n");
}

static void put_run(FILE *list, const struct recorder *recorder, bool done)
{
    const struct scene *scene = recorder->scene;
    if (scene->deck != NULL) fprintf(list, "deck.nml\n");
    fprintf(list, "run.h5\nreport.txt\n");
    for (size_t r = 0; r < scene->receivers; r++)
        put(list, scene->receiver[r].name, ".dat");
    for (size_t p = 0; p < scene->profiles; p++)
        put(list, scene->profile[p].name, ".dat");
    for (size_t s = 0; s < scene->snapshots; s++)
        fprintf(list, s == 0 ? "run.xdmf\n" : "run_%zu.xdmf\n", s + 1);
    if (scene->output.plots) put_pictures(list, recorder, done);
}

char *results_names(const struct scene *scene, const struct recorder *recorder, bool done)
{
    char *names = NULL;
    size_t size = 0;
    FILE *list = open_memstream(&names, &size);
    if (list == NULL) return NULL;
    fprintf(list, "\n");
    if (recorder != NULL) put_run(list, recorder, done);
    const bool exact = recorder != NULL && done ? recorder->exact != NULL : scene->reference.kind[0] != '\0';
    for (size_t r = 0; exact && r < scene->receivers; r++)
        put(list, scene->receiver[r].name, ".exact.dat");
    for (size_t r = 0; exact && scene->reference.stress && r < scene->receivers; r++)
        put(list, scene->receiver[r].name, ".exact.stress.dat");
    if (fclose(list) == 0) return names;
    free(names);
    return NULL;
}

/* The name that begins at *at, in `name`; false behind the last one. */
static bool next_name(const char **at, char name[FILE_NAME_SIZE])
{
    if (*at == NULL) return false;
    *at += strspn(*at, "\n");
    const size_t length = strcspn(*at, "\n");
    snprintf(name, FILE_NAME_SIZE, "%.*s", (int)length, *at);
    *at += length;
    return length > 0;
}

static bool has(const char *names, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = strstr(names, name); at != NULL; at = strstr(at + 1, name))
        if (at[-1] == '\n' && at[length] == '\n') return true;
    return false;
}

static bool path_of(const char *folder, const char *name, char *path, size_t size)
{
    return (size_t)snprintf(path, size, "%s/%s", folder, name) < size;
}

enum { PATH_SIZE = 4096 };

/* What is listed in the folder, "\n" if nothing is; NULL without memory. */
static char *listed_in(const char *folder)
{
    char path[PATH_SIZE];
    struct stat about;
    FILE *file = path_of(folder, list_name, path, sizeof path) ? fopen(path, "r") : NULL;
    const size_t room = file != NULL && fstat(fileno(file), &about) == 0 ? (size_t)about.st_size : 0;
    char *names = calloc(room + 3, 1);
    if (names != NULL) {
        names[0] = '\n';
        const size_t length = file != NULL ? fread(names + 1, 1, room, file) : 0;
        if (length > 0 && names[length] != '\n') names[length + 1] = '\n';
    }
    if (file != NULL) fclose(file);
    return names;
}

/* Of several lists one; names in both stand there once. */
static selas_status write_list(const char *folder, const char *first, const char *second,
                               struct messages *messages)
{
    struct safe_file file;
    char name[FILE_NAME_SIZE];
    const selas_status status = safe_file_open(folder, list_name, &file, messages);
    if (status != SELAS_OK) return status;
    fputs(first + 1, file.file);
    for (const char *at = second; next_name(&at, name);)
        if (!has(first, name)) fprintf(file.file, "%s\n", name);
    return safe_file_close(&file, SELAS_OK, messages);
}

/* --- The folder --- */

/* A run without a list, of an older program. */
static bool has_run(const char *folder)
{
    char path[PATH_SIZE];
    struct kept_deck kept;
    struct messages unheard = {0};
    const bool found = path_of(folder, "run.h5", path, sizeof path) && access(path, R_OK) == 0 &&
                       kept_deck_of_run(path, &kept, &unheard) == SELAS_OK;
    if (found) kept_deck_free(&kept);
    messages_free(&unheard);
    return found;
}

struct search {
    struct stat wanted;
    bool found;
};

/* Goes on unless the file is the wanted one. */
static bool look_at(void *context, const char *word, const char *path, bool overridden)
{
    (void)word;
    (void)overridden;
    struct search *search = context;
    struct stat about;
    search->found = stat(path, &about) == 0 && about.st_ino == search->wanted.st_ino &&
                    about.st_dev == search->wanted.st_dev;
    return !search->found;
}

static selas_status no_memory(struct messages *messages)
{
    return fail(messages, SELAS_NO_MEMORY, "no memory for the names of the results");
}

static selas_status claim_one(const struct scene *scene, const char *name, const char *listed,
                              struct messages *messages)
{
    const char *folder = scene->output.directory;
    char path[PATH_SIZE];
    struct search search = {.found = false};
    if (!path_of(folder, name, path, sizeof path) || stat(path, &search.wanted) != 0) return SELAS_OK;
    const bool all = scene->deck == NULL || (look_at(&search, "", deck_source_path(scene->deck), false) &&
                                             deck_files(scene->deck, look_at, &search));
    if (!all && !search.found) return no_memory(messages);
    if (search.found)
        return fail(messages, SELAS_FILE_ERROR,
                    "the results would overwrite '%s', which the deck is read from; choose another "
                    "output%%directory",
                    path);
    if (has(listed, name) || has_run(folder)) return SELAS_OK;
    return fail(messages, SELAS_FILE_ERROR,
                "'%s' is no result of selas and would be overwritten; choose another output%%directory or "
                "move the file",
                path);
}

selas_status results_claim(const struct scene *scene, const char *names, struct messages *messages)
{
    char name[FILE_NAME_SIZE];
    char *listed = listed_in(scene->output.directory);
    selas_status status = SELAS_OK;
    if (listed == NULL || names == NULL) {
        free(listed);
        return no_memory(messages);
    }
    for (const char *at = names; status == SELAS_OK && next_name(&at, name);)
        status = claim_one(scene, name, listed, messages);
    free(listed);
    return status;
}

static void take_away(const char *folder, const char *name)
{
    char path[PATH_SIZE];
    if (strchr(name, '/') == NULL && path_of(folder, name, path, sizeof path)) unlink(path);
}

static bool is_picture(const char *name)
{
    const size_t length = strlen(name);
    return length > 4 && (strcmp(name + length - 4, ".png") == 0 || strcmp(name + length - 4, ".gif") == 0);
}

selas_status results_list(const struct scene *scene, const char *names, struct messages *messages)
{
    char *listed = listed_in(scene->output.directory);
    const selas_status status = listed != NULL && names != NULL
                                    ? write_list(scene->output.directory, listed, names, messages)
                                    : no_memory(messages);
    free(listed);
    return status;
}

selas_status results_tidy(const struct scene *scene, const char *names, struct messages *messages)
{
    const char *folder = scene->output.directory;
    char name[FILE_NAME_SIZE];
    char *listed = listed_in(folder);
    if (listed == NULL || names == NULL) {
        free(listed);
        return no_memory(messages);
    }
    for (const char *at = listed; next_name(&at, name);)
        if (is_picture(name) || !has(names, name)) take_away(folder, name);
    free(listed);
    return write_list(folder, names, "\n", messages);
}
