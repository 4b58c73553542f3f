/* Which receivers a run has: the names of the histories in its run.h5. */
#include "base/hdf_quiet.h"
#include "base/stored.h"
#include "compare/diff.h"

#include <stdlib.h>
#include <string.h>

/* "a_exact" is the exact history at "a". */
static bool is_exact(hid_t histories, const char *name)
{
    static const char ending[] = "_exact";
    const size_t length = strlen(name), tail = sizeof ending - 1;
    if (length <= tail || strcmp(name + length - tail, ending) != 0) return false;
    char *stem = strndup(name, length - tail);
    const bool exact = stem != NULL && stored_here(histories, stem);
    free(stem);
    return exact;
}

static char *name_of(hid_t histories, hsize_t index)
{
    const ssize_t length =
        H5Lget_name_by_idx(histories, ".", H5_INDEX_NAME, H5_ITER_INC, index, NULL, 0, H5P_DEFAULT);
    char *name = length >= 0 ? malloc((size_t)length + 1) : NULL;
    if (name != NULL)
        H5Lget_name_by_idx(histories, ".", H5_INDEX_NAME, H5_ITER_INC, index, name, (size_t)length + 1,
                           H5P_DEFAULT);
    return name;
}

static bool read_names(hid_t histories, struct run_receivers *receivers)
{
    H5G_info_t about = {0};
    if (H5Gget_info(histories, &about) < 0) return false;
    receivers->name = calloc((size_t)about.nlinks + 1, sizeof *receivers->name);
    for (hsize_t i = 0; receivers->name != NULL && i < about.nlinks; i++) {
        char *name = name_of(histories, i);
        if (name == NULL) return false;
        if (is_exact(histories, name))
            free(name);
        else
            receivers->name[receivers->count++] = name;
    }
    return receivers->name != NULL;
}

bool run_receivers_read(const char *path, struct run_receivers *receivers)
{
    *receivers = (struct run_receivers){0};
    const struct quiet quiet = quiet_begin();
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t histories =
        file >= 0 && stored_here(file, "histories") ? H5Gopen2(file, "histories", H5P_DEFAULT) : -1;
    const bool good = histories >= 0 && read_names(histories, receivers);
    if (histories >= 0) H5Gclose(histories);
    if (file >= 0) H5Fclose(file);
    quiet_end(quiet);
    if (!good) run_receivers_free(receivers);
    return good;
}

void run_receivers_free(struct run_receivers *receivers)
{
    for (size_t i = 0; i < receivers->count; i++)
        free(receivers->name[i]);
    free(receivers->name);
    *receivers = (struct run_receivers){0};
}
