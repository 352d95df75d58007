// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10 writes it (io/DelayedLoadMetadata.h,
// points/StreamCompression.h).
#include "vdb/leaf_notes.h"

#include <blosc.h>

#include <cstddef>
#include <cstring>

#include "vdb/pack_values.h"

namespace deltasplat {
namespace {

// Smaller arrays are not packed, or with zeros behind them.
constexpr std::size_t kLeastBytes = 48;
constexpr std::size_t kLeastPacked = 128;

// Appends an array: how many bytes it is packed in, 0 if it is not, and those.
template <typename T>
void appendArray(const std::vector<T>& values, bool mayPack, std::string& to) {
    const std::size_t bytes = values.size() * sizeof(T);
    const std::size_t place = to.size();
    appendBytes(std::uint32_t{0}, to);
    if (mayPack && bytes > kLeastBytes && bytes <= BLOSC_MAX_BUFFERSIZE - BLOSC_MAX_OVERHEAD) {
        std::string padded(reinterpret_cast<const char*>(values.data()), bytes);
        if (bytes < kLeastPacked) padded.resize(kLeastPacked);
        const auto size = std::uint32_t(appendBlosc(padded.data(), padded.size(), to));
        if (size > 0 && size < bytes) {
            std::memcpy(&to[place], &size, sizeof size);
            return;
        }
        to.resize(place + sizeof size);
    }
    to.append(reinterpret_cast<const char*>(values.data()), bytes);
}

}  // namespace

std::string leafNotes(const std::vector<std::int8_t>& kinds, const std::vector<std::int64_t>& sizes,
                      bool mayPack) {
    std::string notes;
    if (kinds.empty()) return notes;
    appendBytes(std::uint32_t(kinds.size()), notes);
    appendArray(kinds, mayPack, notes);
    appendArray(sizes, mayPack, notes);
    return notes;
}

}  // namespace deltasplat
