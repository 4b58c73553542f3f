/* The folder `unfinished` and the lock on the folder of the results (see the header). The lock is flock's: it
 * ends with the process that holds it, however that ends. */
#include "record/unfinished.h"

#include "base/safe_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static char *joined(const char *folder, const char *name)
{
    if (folder == NULL) return NULL;
    const size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s/%s", folder, name);
    return path;
}

/* --- The lock --- */

static selas_status refuse(int file, const char *folder, struct messages *messages)
{
    char holder[256] = "";
    const ssize_t length = pread(file, holder, sizeof holder - 1, 0);
    holder[length > 0 ? length : 0] = '\0';
    holder[strcspn(holder, "\n")] = '\0';
    close(file);
    return fail(messages, SELAS_FILE_ERROR,
                "another run writes into '%s': %s; wait for it, or choose another output%%directory", folder,
                holder[0] != '\0' ? holder : "it does not say which");
}

static void write_holder(int file)
{
    char host[128] = "", date[40] = "", text[256];
    if (gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
    const time_t now = time(NULL);
    struct tm split;
    if (gmtime_r(&now, &split) != NULL) strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &split);
    const int length =
        snprintf(text, sizeof text, "process %ld on %s, since %s\n", (long)getpid(), host, date);
    if (ftruncate(file, 0) == 0 && length > 0 && pwrite(file, text, (size_t)length, 0) < length)
        (void)ftruncate(file, 0); /* a full disk: the lock holds all the same */
}

/* True if `file` still is what the name says: its last holder removes it. */
static bool still_named(int file, const char *path)
{
    struct stat open_one, named;
    return fstat(file, &open_one) == 0 && stat(path, &named) == 0 && open_one.st_ino == named.st_ino &&
           open_one.st_dev == named.st_dev;
}

static selas_status take_lock(const char *folder, int *lock, struct messages *messages)
{
    char *path = joined(folder, ".running");
    if (path == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the name of a file");
    selas_status status = SELAS_OK;
    while (status == SELAS_OK && *lock < 0) {
        const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0) {
            status = fail(messages, SELAS_FILE_ERROR, "cannot write into the folder '%s': %s", folder,
                          strerror(errno));
        } else if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            status = refuse(file, folder, messages);
        } else if (still_named(file, path)) { /* held, or a file system without locks */
            *lock = file;
            write_holder(file);
        } else {
            close(file);
        }
    }
    free(path);
    return status;
}

static void give_lock(struct unfinished *unfinished)
{
    char *path = joined(unfinished->results, ".running");
    if (path != NULL) unlink(path); /* still held: nobody else has locked it */
    free(path);
    close(unfinished->lock);
    unfinished->lock = -1;
}

/* --- The folder --- */

static bool ends(const char *name, const char *ending)
{
    const size_t size = strlen(name), length = strlen(ending);
    return size > length && strcmp(name + size - length, ending) == 0;
}

static bool is_own(const char *name)
{
    if (ends(name, ".dat") || ends(name, ".png") || ends(name, ".dat.part") || ends(name, ".png.part"))
        return true; /* histories so far */
    return strncmp(name, "checkpoint", 10) == 0 || strncmp(name, "snapshot_", 9) == 0 ||
           strncmp(name, "points.h5", 9) == 0;
}

static void remove_folder(const char *path)
{
    DIR *folder = opendir(path);
    if (folder == NULL) return;
    /* first what needs the others: a kill in between must not leave a checkpoint without its snapshots */
    unlinkat(dirfd(folder), "checkpoint.h5", 0);
    unlinkat(dirfd(folder), "checkpoint_before.h5", 0);
    unlinkat(dirfd(folder), "checkpoint_earlier.h5", 0);
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder))
        if (is_own(entry->d_name)) unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    rmdir(path);
}

/* A run that was not finished and could be: it is kept, the one before it no longer. */
static selas_status put_aside(const struct unfinished *unfinished, struct messages *messages)
{
    char *checkpoint = joined(unfinished->path, "checkpoint.h5");
    char *aside = joined(unfinished->results, "unfinished-old");
    selas_status status = SELAS_OK;
    if (checkpoint == NULL || aside == NULL) {
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the name of a folder");
    } else if (access(checkpoint, F_OK) != 0) {
        remove_folder(unfinished->path);
    } else {
        remove_folder(aside);
        if (rename(unfinished->path, aside) == 0)
            warn(messages,
                 "an unfinished run was in '%s'; it is kept: selas restart %s/checkpoint.h5 goes on with it",
                 unfinished->results, aside);
        else
            status = fail(messages, SELAS_FILE_ERROR,
                          "there is an unfinished run in '%s', which cannot be put aside: %s",
                          unfinished->path, strerror(errno));
    }
    free(checkpoint);
    free(aside);
    return status;
}

selas_status unfinished_open(const char *results, const char *work, bool lock, struct unfinished *unfinished,
                             struct messages *messages)
{
    *unfinished = (struct unfinished){.lock = -1};
    unfinished->results = strdup(results);
    unfinished->path = work != NULL ? strdup(work) : joined(results, "unfinished");
    selas_status status = SELAS_OK;
    if (unfinished->results == NULL || unfinished->path == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the name of a folder");
    if (status == SELAS_OK && lock) status = take_lock(results, &unfinished->lock, messages);
    if (status == SELAS_OK && lock && work == NULL) status = put_aside(unfinished, messages);
    if (status != SELAS_OK) unfinished_close(unfinished);
    return status;
}

selas_status unfinished_make(struct unfinished *unfinished, struct messages *messages)
{
    if (unfinished->made) return SELAS_OK;
    const selas_status status = make_folder(unfinished->path, messages);
    unfinished->made = status == SELAS_OK;
    return status;
}

void unfinished_remove(const struct unfinished *unfinished)
{
    remove_folder(unfinished->path);
}

void unfinished_close(struct unfinished *unfinished)
{
    if (unfinished->lock >= 0) give_lock(unfinished);
    free(unfinished->results);
    free(unfinished->path);
    *unfinished = (struct unfinished){.lock = -1};
}
