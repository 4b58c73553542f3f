/* CRC-64 of ECMA-182 in its reflected form (as in xz): finds every burst of errors up to 64 bits, anything
 * else but one case in 2^64. */
#ifndef SELAS_CRC64_H
#define SELAS_CRC64_H

#include <stddef.h>
#include <stdint.h>

struct crc64_table {
    uint64_t of[8][256];
};

void crc64_prepare(struct crc64_table *table);
/* Checksum of what came before (0: nothing) and `size` bytes more. */
uint64_t crc64_add(const struct crc64_table *table, uint64_t before, const void *data, size_t size);

/* Checksum of two pieces that follow each other from those of each: crc(AB) = x^(8 |B|) crc(A) + crc(B) modulo the
 * polynomial. It is linear: of many pieces, the exclusive or of what each gives with nothing (0) behind it for as many
 * bytes as follow. */
uint64_t crc64_join(uint64_t before, uint64_t after, uint64_t size_after);

#endif
