/* A disk that fails, for regress/checks/disks.sh: preloaded (LD_PRELOAD), it lets writes to files fail from
 * the FAIL_AT-th on (FAIL_FOR of them, all without it) with the error FAIL_ERROR (a number: ENOSPC, EDQUOT,
 * EIO). Counted are write, pwrite, ftruncate and fsync on files above the standard streams, and what streams
 * opened for writing hand over. FAIL_COUNT names a file that gets the number of writes at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static long calls;

static long number(const char *name, long without)
{
    const char *text = getenv(name);
    return text != NULL ? atol(text) : without;
}

static int fails(void)
{
    const long at = number("FAIL_AT", 0), times = number("FAIL_FOR", 1000000000);
    calls++;
    if (at == 0 || calls < at || calls >= at + times) return 0;
    errno = (int)number("FAIL_ERROR", ENOSPC);
    return 1;
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("FAIL_COUNT");
    if (path == NULL) return;
    FILE *(*open_stream)(const char *, const char *) = dlsym(RTLD_NEXT, "fopen");
    FILE *file = open_stream(path, "a");
    if (file == NULL) return;
    fprintf(file, "%ld\n", calls);
    fclose(file);
}

ssize_t write(int file, const void *data, size_t size)
{
    ssize_t (*next)(int, const void *, size_t) = dlsym(RTLD_NEXT, "write");
    return file > 2 && fails() ? -1 : next(file, data, size);
}

ssize_t pwrite(int file, const void *data, size_t size, off_t at)
{
    ssize_t (*next)(int, const void *, size_t, off_t) = dlsym(RTLD_NEXT, "pwrite");
    return fails() ? -1 : next(file, data, size, at);
}

ssize_t pwrite64(int file, const void *data, size_t size, off64_t at)
{
    ssize_t (*next)(int, const void *, size_t, off64_t) = dlsym(RTLD_NEXT, "pwrite64");
    return fails() ? -1 : next(file, data, size, at);
}

int ftruncate(int file, off_t size)
{
    int (*next)(int, off_t) = dlsym(RTLD_NEXT, "ftruncate");
    return fails() ? -1 : next(file, size);
}

int ftruncate64(int file, off64_t size)
{
    int (*next)(int, off64_t) = dlsym(RTLD_NEXT, "ftruncate64");
    return fails() ? -1 : next(file, size);
}

int fsync(int file)
{
    int (*next)(int) = dlsym(RTLD_NEXT, "fsync");
    return fails() ? -1 : next(file);
}

/* Streams write past the functions above: they are made to hand over here. */
static ssize_t hand_over(void *stream, const char *data, size_t size)
{
    if (fails()) return 0;
    return (ssize_t)fwrite(data, 1, size, stream);
}

static int close_stream(void *stream)
{
    return fclose(stream);
}

FILE *fopen(const char *path, const char *mode)
{
    FILE *(*next)(const char *, const char *) = dlsym(RTLD_NEXT, "fopen");
    FILE *stream = next(path, mode);
    if (stream == NULL || strchr(mode, 'w') == NULL) return stream;
    setvbuf(stream, NULL, _IONBF, 0);
    const cookie_io_functions_t functions = {.write = hand_over, .close = close_stream};
    return fopencookie(stream, "w", functions);
}
