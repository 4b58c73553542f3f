/* What is in a file that ranks share (see the header). */
#include "record/walk.h"

#include "record/run_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

enum { PIECE = 1 << 22 }; /* bytes that a rank passes at once */

/* The reason of what follows is not that of what went before. */
void walk_note(struct walk *walk, bool good)
{
    if (!good && !walk->failed) walk->error = errno;
    walk->failed = walk->failed || !good;
    errno = 0;
}

bool walk_good(const struct walk *walk)
{
    double failed = walk->failed;
    ranks_largest(walk->ranks, 1, &failed);
    return failed == 0;
}

selas_status walk_cannot(const struct walk *walk, const char *what, struct messages *messages)
{
    double reason = walk->failed ? walk->error : 0;
    selas_status status = SELAS_OK;
    ranks_largest(walk->ranks, 1, &reason);
    if (walk->failed && (walk->error != 0 || reason == 0))
        status = hdf_cannot(what, walk->named != NULL ? walk->named : walk->path, walk->error, messages);
    return ranks_agree(walk->ranks, status, messages);
}

/* --- The file ------------------------------------------------------------------------------------------- */

bool walk_begin(struct walk *walk)
{
    const bool first = ranks_first(walk->ranks);
    walk->file = -1;
    errno = 0;
    if (first)
        walk->file =
            walk->mode == SET_WRITE ? hdf_create_file(walk->path, walk->head) : hdf_open_file(walk->path);
    walk_note(walk, !first || walk->file >= 0);
    return walk_good(walk);
}

/* This rank can open the file: asked for before all open it, where one that fails would leave the others waiting. */
static bool there(const struct walk *walk)
{
    const int file = open(walk->path, (walk->mode == SET_WRITE ? O_RDWR : O_RDONLY) | O_CLOEXEC);
    return file >= 0 && close(file) == 0;
}

static bool open_together(struct walk *walk)
{
    walk->room = walk->mode == SET_COMPARE ? malloc(PIECE) : NULL;
    walk_note(walk, walk->mode != SET_COMPARE || walk->room != NULL);
    walk_note(walk, there(walk));
    if (!walk_good(walk)) return false;
    walk->file = hdf_open_together(walk->ranks, walk->path, walk->mode == SET_WRITE);
    walk_note(walk, walk->file >= 0);
    if (!walk_good(walk)) {
        if (walk->file >= 0) ranks_abort(walk->ranks, 1); /* to close it, all would have to have it */
        return false;
    }
    return true;
}

bool walk_again(struct walk *walk)
{
    if (walk->file >= 0) walk_note(walk, H5Fclose(walk->file) >= 0);
    walk->file = -1;
    if (!walk->together && ranks_count(walk->ranks) > 1 && walk_good(walk)) {
        walk->together = true;
        if (open_together(walk)) return true;
    }
    free(walk->room);
    return false;
}

bool walk_makes(const struct walk *walk)
{
    return !walk->together && ranks_first(walk->ranks);
}

/* --- Arrays --------------------------------------------------------------------------------------------- */

void walk_pass(struct walk *walk, const char *name, hid_t type, void *data, size_t count)
{
    if (count == 0 || walk->together) return;
    if (walk->file >= 0 && !walk->failed) {
        const hid_t set = set_open(walk->file, name, type, count, walk->mode);
        walk_note(walk, set >= 0 && set_pass(set, type, walk->mode, data, 0, count));
        if (set >= 0) walk_note(walk, H5Dclose(set) >= 0);
    }
    if (walk->mode == SET_READ) ranks_spread(walk->ranks, 0, data, count * H5Tget_size(type));
}

void walk_text(struct walk *walk, const char *name, const char *text)
{
    walk_pass(walk, name, H5T_NATIVE_CHAR, (char *)text, strlen(text) + 1);
}

void walk_real(struct walk *walk, const char *name, size_t number, const char *ending, double *data,
               size_t count)
{
    char full[48];
    snprintf(full, sizeof full, number > 0 ? "%s_%zu%s" : "%s", name, number, ending);
    walk_pass(walk, full, H5T_NATIVE_DOUBLE, data, count);
}

/* What a rank passes of a run: what it has, or where it wants what is read, halo and all; in parts of `cut` numbers of
 * `times` times, of so many that are no more than a piece. */
struct cut {
    size_t from, count, first, last; /* numbers at a time, and which times */
    size_t most, cuts, times;
};

static struct cut cut_run(const struct spread_run *run, bool window, size_t most)
{
    struct cut cut = {run->from, run->end - run->from, run->first, run->last, most, 0, 1};
    if (window) cut = (struct cut){0, run->count, 0, run->times, most, 0, 1};
    cut.cuts = (cut.count + most - 1) / most;
    if (cut.cuts == 1) cut.times = most / cut.count;
    return cut;
}

static size_t parts_of(const struct cut *cut)
{
    return cut->cuts * ((cut->last - cut->first + cut->times - 1) / cut->times);
}

static struct set_part part_of(const struct spread_run *run, const struct cut *cut, size_t k, size_t units)
{
    const size_t time = cut->first + k / cut->cuts * cut->times, from = k % cut->cuts * cut->most;
    const size_t count = cut->count - from < cut->most ? cut->count - from : cut->most;
    const size_t times = cut->last - time < cut->times ? cut->last - time : cut->times;
    return (struct set_part){.here = (run->here + time * run->here_step + cut->from + from) * units,
                             .there = (run->there + time * run->there_step + cut->from + from) * units,
                             .count = count * units,
                             .times = times,
                             .here_step = run->here_step * units,
                             .there_step = run->there_step * units};
}

/* An array that is shared. */
struct shared {
    hid_t set, type;
    char *data;
    size_t width; /* bytes of an entry */
};

/* The file's numbers come into the room, without gaps. */
static bool same_part(struct walk *walk, const struct shared *shared, const struct set_part *part)
{
    struct set_part packed = *part;
    packed.here = 0;
    packed.here_step = part->count;
    bool good = set_pass_part(shared->set, shared->type, false, walk->room, &packed);
    for (size_t t = 0; good && t < part->times; t++)
        good = memcmp(walk->room + t * part->count * shared->width,
                      shared->data + (part->here + t * part->here_step) * shared->width,
                      part->count * shared->width) == 0;
    return good;
}

/* The system's reason may be lost on its way through MPI. */
static bool wrote(const struct walk *walk, bool good)
{
    struct statvfs disk;
    if (!good && statvfs(walk->path, &disk) == 0 && disk.f_bavail * disk.f_frsize < PIECE) errno = ENOSPC;
    return good;
}

static bool pass_part(struct walk *walk, const struct shared *shared, const struct set_part *part)
{
    if (walk->mode == SET_COMPARE) return same_part(walk, shared, part);
    const bool write = walk->mode == SET_WRITE;
    const bool good = set_pass_part(shared->set, shared->type, write, shared->data, part);
    return write ? wrote(walk, good) : good;
}

static void pass_parts(struct walk *walk, const struct shared *shared, const struct spread *shares,
                       size_t units)
{
    const bool window = walk->mode == SET_READ;
    const size_t most = PIECE / (shared->width * units);
    for (size_t r = 0; r < shares->runs; r++) {
        const struct cut cut = cut_run(&shares->run[r], window, most);
        for (size_t k = 0; k < parts_of(&cut) && !walk->failed; k++) {
            const struct set_part part = part_of(&shares->run[r], &cut, k, units);
            walk_note(walk, pass_part(walk, shared, &part));
        }
    }
}

void walk_shared(struct walk *walk, const char *name, hid_t type, size_t units, void *data, size_t count,
                 const struct spread *shares)
{
    if (shares == NULL || ranks_count(walk->ranks) == 1) {
        walk_pass(walk, name, type, data, count * units);
        return;
    }
    walk_note(walk, !shares->full);
    if (walk->file < 0 || (!walk->together && walk->failed)) return;
    const size_t entries = shares->there * units;
    const hid_t set = walk->together ? set_open_known(walk->file, name, entries)
                                     : set_open(walk->file, name, type, entries, walk->mode);
    walk_note(walk, set >= 0);
    const struct shared shared = {set, type, data, H5Tget_size(type)};
    if (walk->together) pass_parts(walk, &shared, shares, units);
    if (set >= 0) walk_note(walk, H5Dclose(set) >= 0);
}

/* --- Tables --------------------------------------------------------------------------------------------- */

hid_t walk_group(struct walk *walk, const char *name)
{
    if (!walk_makes(walk) || walk->failed) return -1;
    const hid_t group = hdf_group(walk->file, name);
    walk_note(walk, group >= 0);
    return group;
}

hid_t walk_table(struct walk *walk, const char *name, hid_t type, size_t rows, size_t columns)
{
    if (!walk->together && (!walk_makes(walk) || walk->failed)) return -1;
    const hid_t table = walk->together ? H5Dopen2(walk->file, name, H5P_DEFAULT)
                                       : hdf_rows(walk->file, name, type, rows, columns);
    walk_note(walk, table >= 0);
    if (walk->together || ranks_count(walk->ranks) == 1) return table;
    walk_close(walk, table);
    return -1;
}

void walk_rows(struct walk *walk, hid_t table, size_t first, size_t rows, size_t columns, double *value)
{
    if (!walk->failed) walk_note(walk, wrote(walk, hdf_rows_pass(table, true, first, rows, columns, value)));
}

void walk_share(const struct walk *walk, size_t rows, size_t *first, size_t *end)
{
    const size_t count = (size_t)ranks_count(walk->ranks), me = (size_t)ranks_me(walk->ranks);
    *first = rows / count * me + rows % count * me / count;
    *end = rows / count * (me + 1) + rows % count * (me + 1) / count;
}

void walk_close(struct walk *walk, hid_t table)
{
    if (table >= 0) walk_note(walk, H5Dclose(table) >= 0);
}
