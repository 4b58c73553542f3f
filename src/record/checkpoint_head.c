/* The head of a checkpoint (see the header): lines of text,
 *
 *   selas checkpoint, format 2
 *   version 0.1.0
 *   commit 1234567
 *   bytes little-endian
 *   size 123456          of the whole file
 *   body 0123456789abcdef     CRC-64 of all that follows the head
 *   head 0123456789abcdef     CRC-64 of the lines before this one
 *
 * and zeros up to 512 bytes. */
#include "record/checkpoint_head.h"
#include "record/run_file.h"

#include "base/crc64.h"
#include "record/parts.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char first_line[] = "selas checkpoint, format ";
enum { FORMAT = 3, BLOCK = 1 << 16 };

static const char *byte_order(void)
{
    const unsigned one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1 ? "little-endian" : "big-endian";
}

/* CRC of the file behind the head; false if it cannot be read to its end. */
static bool body_checksum(int file, uint64_t *checksum)
{
    struct crc64_table table;
    char block[BLOCK];
    off_t at = CHECKPOINT_HEAD;
    ssize_t length = -1;
    crc64_prepare(&table);
    *checksum = 0;
    while ((length = pread(file, block, BLOCK, at)) > 0) {
        *checksum = crc64_add(&table, *checksum, block, (size_t)length);
        at += length;
    }
    return length == 0;
}

static uint64_t text_checksum(const char *text, size_t length)
{
    struct crc64_table table;
    crc64_prepare(&table);
    return crc64_add(&table, 0, text, length);
}

selas_status checkpoint_seal(const char *path, struct messages *messages)
{
    char head[CHECKPOINT_HEAD] = {0};
    uint64_t body = 0;
    struct stat about;
    const int file = open(path, O_RDWR | O_CLOEXEC);
    bool good = file >= 0 && fstat(file, &about) == 0 && body_checksum(file, &body);
    if (good) {
        const int length = snprintf(
            head, sizeof head,
            "%s%d\nversion %s\ncommit %.60s\nbytes %s\nsize %" PRIu64 "\nbody %016" PRIx64 "\n", first_line,
            FORMAT, selas_version(), build_commit(), byte_order(), (uint64_t)about.st_size, body);
        snprintf(head + length, sizeof head - (size_t)length, "head %016" PRIx64 "\n",
                 text_checksum(head, (size_t)length));
        good = pwrite(file, head, sizeof head, 0) == (ssize_t)sizeof head && fsync(file) == 0;
    }
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

static bool body_whole(int file, const char *head, char *why, size_t size)
{
    char kept[32], made[32];
    struct stat about;
    uint64_t body = 0;
    line_of(head, "size", kept, sizeof kept);
    const uint64_t wanted = strtoull(kept, NULL, 10);
    if (fstat(file, &about) != 0 || (uint64_t)about.st_size < wanted) {
        snprintf(why, size, "it is cut short: %" PRIu64 " bytes of %" PRIu64, (uint64_t)about.st_size,
                 wanted);
        return false;
    }
    const bool read = body_checksum(file, &body);
    line_of(head, "body", kept, sizeof kept);
    snprintf(made, sizeof made, "%016" PRIx64, body);
    if (read && (uint64_t)about.st_size == wanted && strcmp(kept, made) == 0) return true;
    snprintf(why, size, "%s", read ? "it is damaged: its checksum is wrong" : "it cannot be read to its end");
    return false;
}

static bool whole(int file, char *why, size_t size)
{
    char head[CHECKPOINT_HEAD + 1] = {0}, value[80], format[16];
    const ssize_t length = pread(file, head, CHECKPOINT_HEAD, 0);
    snprintf(format, sizeof format, "%d\n", FORMAT);
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
    return body_whole(file, head, why, size);
}

bool checkpoint_whole(const char *path, char *why, size_t size)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        snprintf(why, size, "%s", strerror(errno));
        return false;
    }
    const bool good = whole(file, why, size);
    close(file);
    return good;
}
