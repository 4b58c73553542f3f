/* CRC-64 (ECMA-182, reflected polynomial C96C5795D7870F42), eight bytes at a time: Sarwate (1988), Kounavis &
 * Berry (2005), "slicing by 8". */
#include "base/crc64.h"

void crc64_prepare(struct crc64_table *table)
{
    for (unsigned i = 0; i < 256; i++) {
        uint64_t crc = i;
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ ((crc & 1) != 0 ? UINT64_C(0xC96C5795D7870F42) : 0);
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
