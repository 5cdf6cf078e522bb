/* CRC-32 as zlib, PNG and Ethernet have it (polynomial 0xEDB88320), so that any tool can check
 * our files: Python's zlib.crc32 gives the same numbers. */
#ifndef TREMIE_STORE_CRC32_H
#define TREMIE_STORE_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* Eight tables, so that eight bytes are taken at once. */
struct crc32 {
    uint32_t table[8][256];
};

void crc32_init(struct crc32 *crc);
uint32_t crc32_of(const struct crc32 *crc, const void *bytes, size_t n);
/* That of what was summed up, followed by these bytes. */
uint32_t crc32_more(const struct crc32 *crc, uint32_t sum, const void *bytes, size_t n);

#endif
