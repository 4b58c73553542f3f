/* The head of a checkpoint (see the header): lines of text,
 *
 *   selas checkpoint, format 2
 *   version 0.1.0
 *   commit 1234567
 *   bytes little-endian
 *   rounding fused       or plain: of the kernels (base/processor.h); of older ones not there
 *   size 123456          of the whole file
 *   body 0123456789abcdef     CRC-64 of all that follows the head
 *   head 0123456789abcdef     CRC-64 of the lines before this one
 *
 * and zeros up to 512 bytes. */
#include "record/checkpoint_head.h"
#include "record/run_file.h"

#include "base/crc64.h"
#include "base/processor.h"
#include "record/parts.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char first_line[] = "selas checkpoint, format ";
enum { FORMAT = 7, BLOCK = 1 << 16 };

static const char *byte_order(void)
{
    const unsigned one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1 ? "little-endian" : "big-endian";
}

const char *checkpoint_rounding(void)
{
    return processor_taken() == PROCESSOR_PLAIN ? "plain" : "fused";
}

/* CRC of the bytes from .. end - 1 of the file; false if they cannot be read. */
static bool part_checksum(int file, uint64_t from, uint64_t end, uint64_t *checksum)
{
    struct crc64_table table;
    char block[BLOCK];
    crc64_prepare(&table);
    *checksum = 0;
    while (from < end) {
        const size_t most = end - from < BLOCK ? (size_t)(end - from) : BLOCK;
        const ssize_t length = pread(file, block, most, (off_t)from);
        if (length <= 0) return false;
        *checksum = crc64_add(&table, *checksum, block, (size_t)length);
        from += (uint64_t)length;
    }
    return true;
}

/* Together: the exclusive or of what ranks have, whose bits are counted. */
static uint64_t joined(struct ranks *ranks, uint64_t own)
{
    enum { BITS = 64 };
    double bit[BITS];
    uint64_t value = 0;
    for (int k = 0; k < BITS; k++)
        bit[k] = (double)(own >> k & 1);
    ranks_sum(ranks, BITS, bit);
    for (int k = 0; k < BITS; k++)
        value |= ((uint64_t)bit[k] & 1) << k;
    return value;
}

/* Together: CRC of all behind the head of a file of `size` bytes, of which each rank reads a share. `read`: could this
 * rank, where it wants to; false if one could not. */
static bool body_checksum(int file, uint64_t size, struct ranks *ranks, bool *read, uint64_t *checksum)
{
    const uint64_t count = (uint64_t)ranks_count(ranks), me = (uint64_t)ranks_me(ranks);
    const uint64_t body = size > CHECKPOINT_HEAD ? size - CHECKPOINT_HEAD : 0;
    const uint64_t first = body / count * me + body % count * me / count;
    const uint64_t last = body / count * (me + 1) + body % count * (me + 1) / count;
    uint64_t own = 0;
    *read = *read && part_checksum(file, CHECKPOINT_HEAD + first, CHECKPOINT_HEAD + last, &own);
    double failed = !*read;
    ranks_largest(ranks, 1, &failed);
    *checksum = joined(ranks, crc64_join(own, 0, body - last));
    return failed == 0;
}

static uint64_t text_checksum(const char *text, size_t length)
{
    struct crc64_table table;
    crc64_prepare(&table);
    return crc64_add(&table, 0, text, length);
}

static bool write_head(int file, uint64_t size, uint64_t body)
{
    char head[CHECKPOINT_HEAD] = {0};
    const int length = snprintf(
        head, sizeof head,
        "%s%d\nversion %s\ncommit %.60s\nbytes %s\nrounding %s\nsize %" PRIu64 "\nbody %016" PRIx64 "\n",
        first_line, FORMAT, selas_version(), build_commit(), byte_order(), checkpoint_rounding(), size, body);
    snprintf(head + length, sizeof head - (size_t)length, "head %016" PRIx64 "\n",
             text_checksum(head, (size_t)length));
    return pwrite(file, head, sizeof head, 0) == (ssize_t)sizeof head;
}

selas_status checkpoint_seal(const char *path, struct ranks *ranks, struct messages *messages)
{
    uint64_t body;
    struct stat about = {0};
    const int file = open(path, O_RDWR | O_CLOEXEC);
    bool good = file >= 0 && fstat(file, &about) == 0;
    const bool all = body_checksum(file, (uint64_t)about.st_size, ranks, &good, &body);
    if (all && ranks_first(ranks)) good = write_head(file, (uint64_t)about.st_size, body);
    good = good && fsync(file) == 0;
    const int error = errno;
    if (file >= 0) close(file);
    return good ? SELAS_OK : hdf_cannot("write", path, error, messages);
}

/* The rest of the line that begins with `word`, in value[size]; "" if there is none. */
static void line_of(const char *head, const char *word, char *value, size_t size)
{
    char wanted[32];
    snprintf(wanted, sizeof wanted, "\n%s ", word);
    const char *at = strstr(head, wanted);
    if (at != NULL) at += strlen(wanted);
    snprintf(value, size, "%.*s", at != NULL ? (int)strcspn(at, "\n") : 0, at != NULL ? at : "");
}

/* The head is as it was written. */
static bool head_whole(const char head[CHECKPOINT_HEAD + 1])
{
    char kept[32], made[32];
    const size_t length = strlen(head);
    for (size_t i = length; i < CHECKPOINT_HEAD; i++)
        if (head[i] != '\0') return false;
    const char *last = strstr(head, "\nhead ");
    if (last == NULL || length != (size_t)(last - head) + sizeof "\nhead 0123456789abcdef") return false;
    line_of(head, "head", kept, sizeof kept);
    snprintf(made, sizeof made, "%016" PRIx64, text_checksum(head, (size_t)(last - head) + 1));
    return strcmp(kept, made) == 0;
}

/* The head, read into head[]. */
static bool head_fits(int file, char head[CHECKPOINT_HEAD + 1], char *why, size_t size)
{
    char value[80], format[16];
    struct stat about;
    const ssize_t length = pread(file, head, CHECKPOINT_HEAD, 0);
    snprintf(format, sizeof format, "%d\n", FORMAT);
    if (length < 0 && errno == EISDIR) {
        snprintf(
            why, size,
            "it is a folder; that of a run that has not ended holds the checkpoint unfinished/checkpoint.h5");
        return false;
    }
    if (length <= 0 || strncmp(head, first_line, sizeof first_line - 1) != 0) {
        snprintf(why, size, "it is no checkpoint of selas");
        return false;
    }
    if (length < CHECKPOINT_HEAD) {
        snprintf(why, size, "it is cut short: %zd bytes", length);
        return false;
    }
    if (!head_whole(head)) {
        snprintf(why, size, "it is damaged: its first lines are not as they were written");
        return false;
    }
    if (strncmp(head + sizeof first_line - 1, format, strlen(format)) != 0) {
        snprintf(why, size, "it has format %.*s, this is selas %s with format %d",
                 (int)strcspn(head + sizeof first_line - 1, "\n"), head + sizeof first_line - 1,
                 selas_version(), FORMAT);
        return false;
    }
    line_of(head, "version", value, sizeof value);
    if (strcmp(value, selas_version()) != 0) {
        snprintf(why, size, "it was written by version %s, this is %s", value, selas_version());
        return false;
    }
    line_of(head, "bytes", value, sizeof value);
    if (strcmp(value, byte_order()) != 0) {
        snprintf(why, size, "it was written by a %s machine, this one is %s", value, byte_order());
        return false;
    }
    line_of(head, "size", value, sizeof value);
    const uint64_t wanted = strtoull(value, NULL, 10);
    if (fstat(file, &about) == 0 && (uint64_t)about.st_size >= wanted) return true;
    snprintf(why, size, "it is cut short: %" PRIu64 " bytes of %" PRIu64, (uint64_t)about.st_size, wanted);
    return false;
}

/* Together; `fits`: of this rank's look at the head. */
static bool body_fits(int file, const char *head, bool fits, struct ranks *ranks, char *why, size_t size)
{
    char kept[32], made[32];
    struct stat about = {0};
    uint64_t body;
    bool read = fits && fstat(file, &about) == 0;
    const bool all = body_checksum(file, (uint64_t)about.st_size, ranks, &read, &body);
    if (!fits) return false;
    line_of(head, "size", kept, sizeof kept);
    const bool longer = (uint64_t)about.st_size != strtoull(kept, NULL, 10);
    line_of(head, "body", kept, sizeof kept);
    snprintf(made, sizeof made, "%016" PRIx64, body);
    if (read && !longer && (!all || strcmp(kept, made) == 0)) return true;
    snprintf(why, size, "%s", read ? "it is damaged: its checksum is wrong" : "it cannot be read to its end");
    return false;
}

bool checkpoint_whole(const char *path, struct ranks *ranks, char *why, size_t size,
                      char rounding[CHECKPOINT_ROUNDING])
{
    char head[CHECKPOINT_HEAD + 1] = {0};
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    bool good = file >= 0;
    if (!good) snprintf(why, size, "%s", strerror(errno));
    good = good && head_fits(file, head, why, size);
    good = body_fits(file, head, good, ranks, why, size);
    if (good) line_of(head, "commit", why, size);
    if (good) line_of(head, "rounding", rounding, CHECKPOINT_ROUNDING);
    if (file >= 0) close(file);
    return good;
}
