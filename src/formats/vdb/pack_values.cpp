// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/pack_values.h"

#include <blosc.h>

namespace deltasplat {

std::int64_t appendBlosc(const void* values, std::size_t bytes, std::string& to) {
    const std::size_t place = to.size();
    const std::size_t most = bytes + BLOSC_MAX_OVERHEAD;
    to.resize(place + most);
    // What OpenVDB asks for, whatever the size of a value is.
    constexpr int kLevel = 9;
    constexpr std::size_t kTypeSize = 4;
    const int size = blosc_compress_ctx(kLevel, BLOSC_SHUFFLE, kTypeSize, bytes, values,
                                        to.data() + place, most, BLOSC_LZ4_COMPNAME,
                                        /*blocksize=*/bytes, /*numinternalthreads=*/1);
    to.resize(place + std::size_t(std::max(0, size)));
    return std::max(0, size);
}

std::int64_t appendPacked(const void* values, std::size_t bytes, std::string& to) {
    const std::size_t place = to.size();
    appendBytes(std::int64_t{0}, to);
    std::int64_t size = appendBlosc(values, bytes, to);
    const std::int64_t noted = size > 0 ? size : std::int64_t(bytes);
    if (size == 0) {
        to.append(static_cast<const char*>(values), bytes);
        size = -std::int64_t(bytes);
    }
    to.replace(place, sizeof size, reinterpret_cast<const char*>(&size), sizeof size);
    return noted;
}

}  // namespace deltasplat
