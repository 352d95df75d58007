// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/zip_chunk.h"

#include <zlib.h>

namespace deltasplat {

bool unpackZip(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    uLongf unpacked = values.size();
    const int status =
        ::uncompress(reinterpret_cast<Bytef*>(values.data()), &unpacked,
                     reinterpret_cast<const Bytef*>(chunk.data()), uLong(chunk.size()));
    return status == Z_OK && unpacked == size;
}

}  // namespace deltasplat
