/* See crc32.h.  Table k holds the remainder of a byte followed by k zero bytes; the eight
 * remainders of eight bytes are independent, which is what makes it some times faster than byte
 * by byte. */
#include "store/crc32.h"

#include <string.h>

void crc32_init(struct crc32 *crc)
{
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t remainder = i;
        for (int bit = 0; bit < 8; bit++)
            remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xEDB88320u : 0u);
        crc->table[0][i] = remainder;
    }
    for (int k = 1; k < 8; k++)
        for (int i = 0; i < 256; i++) {
            const uint32_t before = crc->table[k - 1][i];
            crc->table[k][i] = (before >> 8) ^ crc->table[0][before & 255];
        }
}

uint32_t crc32_of(const struct crc32 *crc, const void *bytes, size_t n)
{
    return crc32_more(crc, 0, bytes, n);
}

uint32_t crc32_more(const struct crc32 *crc, uint32_t sum, const void *bytes, size_t n)
{
    const unsigned char *p = bytes;
    uint32_t state = ~sum;
    for (; n >= 8; n -= 8, p += 8) {
        const uint32_t low = state ^ ((uint32_t)p[0] | (uint32_t)p[1] << 8 |
                                      (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24);
        state = crc->table[7][low & 255] ^ crc->table[6][low >> 8 & 255] ^
                crc->table[5][low >> 16 & 255] ^ crc->table[4][low >> 24] ^
                crc->table[3][p[4]] ^ crc->table[2][p[5]] ^ crc->table[1][p[6]] ^
                crc->table[0][p[7]];
    }
    for (; n > 0; n--, p++)
        state = state >> 8 ^ crc->table[0][(state ^ *p) & 255];
    return state ^ 0xFFFFFFFFu;
}
