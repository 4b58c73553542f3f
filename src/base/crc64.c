/* CRC-64 (ECMA-182, reflected polynomial C96C5795D7870F42), eight bytes at a time: Sarwate (1988), Kounavis &
 * Berry (2005), "slicing by 8". A checksum is a polynomial of bits modulo that one; n bytes behind it multiply it by
 * x^(8 n) (M. Adler, zlib's crc32_combine). */
#include "base/crc64.h"

static const uint64_t polynomial = UINT64_C(0xC96C5795D7870F42), one = UINT64_C(1) << 63;

static uint64_t times_x(uint64_t crc)
{
    return crc >> 1 ^ ((crc & 1) != 0 ? polynomial : 0);
}

void crc64_prepare(struct crc64_table *table)
{
    for (unsigned i = 0; i < 256; i++) {
        uint64_t crc = i;
        for (int bit = 0; bit < 8; bit++)
            crc = times_x(crc);
        table->of[0][i] = crc;
    }
    for (int k = 1; k < 8; k++)
        for (unsigned i = 0; i < 256; i++) {
            const uint64_t before = table->of[k - 1][i];
            table->of[k][i] = before >> 8 ^ table->of[0][before & 255];
        }
}

uint64_t crc64_add(const struct crc64_table *table, uint64_t before, const void *data, size_t size)
{
    const unsigned char *at = data;
    uint64_t crc = ~before;
    for (; size >= 8; size -= 8, at += 8) {
        for (unsigned k = 0; k < 8; k++)
            crc ^= (uint64_t)at[k] << 8 * k;
        uint64_t next = 0;
        for (unsigned k = 0; k < 8; k++)
            next ^= table->of[7 - k][crc >> 8 * k & 255];
        crc = next;
    }
    for (; size > 0; size--, at++)
        crc = crc >> 8 ^ table->of[0][(crc ^ *at) & 255];
    return ~crc;
}

static uint64_t product(uint64_t a, uint64_t b)
{
    uint64_t sum = 0;
    for (; a != 0; a <<= 1, b = times_x(b))
        sum ^= (a & one) != 0 ? b : 0;
    return sum;
}

uint64_t crc64_join(uint64_t before, uint64_t after, uint64_t size_after)
{
    uint64_t power = one >> 8; /* x^8, x^16, x^32, ... */
    for (uint64_t left = size_after; left > 0; left >>= 1, power = product(power, power))
        if ((left & 1) != 0) before = product(power, before);
    return before ^ after;
}
