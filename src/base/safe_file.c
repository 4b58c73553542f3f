/* Files that last: temporary name in the same folder, flush, sync, rename. */
#include "base/safe_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static selas_status cannot(struct messages *messages, const char *what, const char *path, int error)
{
    return fail(messages, SELAS_FILE_ERROR, "cannot %s '%s': %s", what, path, strerror(error));
}

static char *joined(const char *folder, const char *name, const char *suffix)
{
    const size_t size = strlen(folder) + strlen(name) + strlen(suffix) + 2;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s/%s%s", folder, name, suffix);
    return path;
}

selas_status safe_file_names(const char *folder, const char *name, char **path, char **temporary,
                             struct messages *messages)
{
    *path = joined(folder, name, "");
    *temporary = joined(folder, name, ".part");
    if (*path != NULL && *temporary != NULL) return SELAS_OK;
    free(*path);
    free(*temporary);
    *path = *temporary = NULL;
    return fail(messages, SELAS_NO_MEMORY, "no memory for the name of a file");
}

selas_status safe_file_open(const char *folder, const char *name, struct safe_file *file,
                            struct messages *messages)
{
    *file = (struct safe_file){0};
    const selas_status status = safe_file_names(folder, name, &file->path, &file->temporary, messages);
    if (status != SELAS_OK) return status;
    file->file = fopen(file->temporary, "w");
    if (file->file != NULL) return SELAS_OK;
    const int error = errno;
    cannot(messages, "write", file->path, error);
    free(file->path);
    free(file->temporary);
    *file = (struct safe_file){0};
    return SELAS_FILE_ERROR;
}

/* A new name lasts only when its folder is on the disk too; where folders cannot be synced there is nothing
 * to gain and nothing to say. */
static void sync_folder_of(const char *path)
{
    char *folder = strdup(path);
    if (folder == NULL) return;
    char *slash = strrchr(folder, '/');
    if (slash != NULL) *(slash == folder ? slash + 1 : slash) = '\0';
    const int handle = open(slash != NULL ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle >= 0) {
        fsync(handle);
        close(handle);
    }
    free(folder);
}

static selas_status put(const char *temporary, const char *path, int error, struct messages *messages)
{
    if (error == 0 && rename(temporary, path) != 0) error = errno;
    if (error == 0) return SELAS_OK;
    unlink(temporary);
    return cannot(messages, "write", path, error);
}

selas_status safe_file_commit(const char *temporary, const char *path, struct messages *messages)
{
    int error = 0;
    const int handle = open(temporary, O_RDONLY | O_CLOEXEC);
    if (handle < 0 || fsync(handle) != 0) error = errno;
    if (handle >= 0 && close(handle) != 0 && error == 0) error = errno;
    const selas_status status = put(temporary, path, error, messages);
    if (status == SELAS_OK) sync_folder_of(path);
    return status;
}

selas_status safe_file_close(struct safe_file *file, selas_status status, struct messages *messages)
{
    if (file->file == NULL) return status;
    errno = 0;
    const bool bad = ferror(file->file) != 0 || fflush(file->file) != 0;
    int error = bad ? errno : 0;
    if (fclose(file->file) != 0 && !bad) error = errno;
    if (status == SELAS_OK && (bad || error != 0))
        status = cannot(messages, "write", file->path, error != 0 ? error : EIO);
    if (status == SELAS_OK)
        status = file->twice ? put(file->temporary, file->path, 0, messages)
                             : safe_file_commit(file->temporary, file->path, messages);
    else
        unlink(file->temporary);
    free(file->path);
    free(file->temporary);
    *file = (struct safe_file){0};
    return status;
}

selas_status make_folder(const char *path, struct messages *messages)
{
    char *part = strdup(path);
    if (part == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the name of a folder");
    int error = 0;
    for (char *end = part; error == 0 && *end != '\0';) {
        end += strspn(end, "/");
        end += strcspn(end, "/");
        const char kept = *end;
        *end = '\0';
        if (*part != '\0' && mkdir(part, 0777) != 0 && errno != EEXIST) error = errno;
        *end = kept;
    }
    free(part);
    struct stat about;
    if (error == 0 && stat(path, &about) != 0) error = errno;
    if (error == 0 && !S_ISDIR(about.st_mode)) error = ENOTDIR;
    if (error == 0 && access(path, W_OK | X_OK) != 0) error = errno;
    return error == 0 ? SELAS_OK : cannot(messages, "write into the folder", path, error);
}

void file_name_of(const char *name, const char *ending, char *text, size_t size)
{
    snprintf(text, size, "%s%s", name, ending);
    for (char *c = text; *c != '\0'; c++)
        if (*c == '/' || (unsigned char)*c < ' ') *c = '_';
    if (text[0] == '.') text[0] = '_';
}
