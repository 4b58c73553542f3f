/* Memory that runs out on purpose (see the header). */
#include "allocation.h"

#include <errno.h>
#include <execinfo.h>
#include <fftw3.h>
#include <gsl/gsl_matrix.h>
#include <link.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 1 << 16, PLACES = 24 };

struct block {
    void *start; /* NULL: never used; the table's own address: used and given back */
    unsigned long number;
};

static struct {
    bool armed, met;
    unsigned long number, fails;
    struct block block[ROOM];
    void *place[PLACES];
    int places;
} state;

static size_t slot_of(const void *start)
{
    return (size_t)(((unsigned long)start >> 4) * 0x9E3779B97F4A7C15UL >> 48) % ROOM;
}

/* Counts an allocation; true if it is the one that fails. */
static bool runs_out(void)
{
    if (!state.armed || ++state.number != state.fails) return false;
    state.met = true;
    errno = ENOMEM;
    state.places = backtrace(state.place, PLACES);
    return true;
}

static void *given(void *start)
{
    if (!state.armed || start == NULL) return start;
    size_t slot = slot_of(start);
    while (state.block[slot].start != NULL && state.block[slot].start != &state)
        slot = (slot + 1) % ROOM;
    state.block[slot] = (struct block){start, state.number};
    return start;
}

static void *back(void *start)
{
    if (start == NULL) return start;
    for (size_t slot = slot_of(start); state.block[slot].start != NULL; slot = (slot + 1) % ROOM)
        if (state.block[slot].start == start) {
            state.block[slot].start = &state;
            break;
        }
    return start;
}

void allocation_arm(unsigned long number)
{
    memset(state.block, 0, sizeof state.block);
    state.number = 0;
    state.fails = number;
    state.met = false;
    state.armed = true;
}

bool allocation_disarm(void)
{
    state.armed = false;
    return state.met;
}

size_t allocation_kept(unsigned long *number)
{
    size_t kept = 0;
    for (size_t slot = 0; slot < ROOM; slot++) {
        if (state.block[slot].start == NULL || state.block[slot].start == &state) continue;
        *number = state.block[slot].number;
        kept++;
    }
    return kept;
}

void allocation_tell(void)
{
    backtrace_symbols_fd(state.place, state.places, 2);
}

/* NAME as the library calls it; __real_NAME is what it would have called. */
#define WRAP(type, name, parameters, ...)                                                                    \
    type __real_##name parameters;                                                                           \
    type __wrap_##name parameters;                                                                           \
    type __wrap_##name parameters                                                                            \
    {                                                                                                        \
        return runs_out() ? NULL : given(__real_##name(__VA_ARGS__));                                        \
    }
#define WRAP_FREE(name, type)                                                                                \
    void __real_##name(type start);                                                                          \
    void __wrap_##name(type start);                                                                          \
    void __wrap_##name(type start)                                                                           \
    {                                                                                                        \
        __real_##name(back(start));                                                                          \
    }

WRAP(void *, malloc, (size_t size), size)
WRAP(void *, calloc, (size_t count, size_t size), count, size)
WRAP(void *, aligned_alloc, (size_t alignment, size_t size), alignment, size)
WRAP(char *, strdup, (const char *text), text)
WRAP(char *, strndup, (const char *text, size_t size), text, size)
WRAP(void *, fftw_malloc, (size_t size), size)
WRAP(double *, fftw_alloc_real, (size_t count), count)
WRAP(fftw_complex *, fftw_alloc_complex, (size_t count), count)
WRAP_FREE(free, void *)
WRAP_FREE(fftw_free, void *)

/* A block that cannot grow stays. */
void *__real_realloc(void *start, size_t size);
void *__wrap_realloc(void *start, size_t size);
void *__wrap_realloc(void *start, size_t size)
{
    if (runs_out()) return NULL;
    void *grown = __real_realloc(back(start), size);
    given(grown != NULL ? grown : start);
    return grown;
}

/* What it keeps is free()'s, which knows nothing of it. */
FILE *__real_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size)
{
    return runs_out() ? NULL : __real_open_memstream(text, size);
}

/* GSL asks malloc() itself: its calls are those from where it lies in memory. AddressSanitizer has a malloc()
 * of its own that cannot be replaced. */
#ifndef __SANITIZE_ADDRESS__
static struct {
    uintptr_t low, high;
} gsl;

static int find(struct dl_phdr_info *object, size_t size, void *inside)
{
    (void)size;
    for (int k = 0; k < object->dlpi_phnum; k++) {
        const ElfW(Phdr) *part = &object->dlpi_phdr[k];
        const uintptr_t low = object->dlpi_addr + part->p_vaddr;
        if (part->p_type != PT_LOAD || (uintptr_t)inside - low >= part->p_memsz) continue;
        gsl.low = low;
        gsl.high = low + part->p_memsz;
    }
    return 0;
}

__attribute__((constructor)) static void find_gsl(void)
{
    dl_iterate_phdr(find, (void *)(uintptr_t)gsl_matrix_alloc); /* the segment of its code */
}

void *__libc_malloc(size_t size);
void __libc_free(void *start);

__attribute__((visibility("default"))) void *malloc(size_t size)
{
    const uintptr_t caller = (uintptr_t)__builtin_return_address(0);
    if (caller - gsl.low >= gsl.high - gsl.low) return __libc_malloc(size);
    return runs_out() ? NULL : given(__libc_malloc(size));
}

/* GSL leaves for free() by a jump, which hides where it was: all blocks are looked up. */
__attribute__((visibility("default"))) void free(void *start)
{
    __libc_free(back(start));
}
#endif
