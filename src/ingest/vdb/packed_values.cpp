// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers read it (LeafNode.h, InternalNode.h,
// io/Compression.h).
#include "ingest/vdb/packed_values.h"

#include <blosc.h>
#include <openvdb/io/Compression.h>

#include <array>
#include <bit>
#include <cstring>

#include "ingest/vdb/zip_chunk.h"

namespace deltasplat {
namespace {

// Takes what is stored from the front of some bytes.
class Front {
  public:
    explicit Front(std::span<const char> bytes) : rest_(bytes) {}

    template <typename T>
    bool take(T& value) {
        if (rest_.size() < sizeof value) return false;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_ = rest_.subspan(sizeof value);
        return true;
    }
    bool skip(std::size_t bytes) {
        if (rest_.size() < bytes) return false;
        rest_ = rest_.subspan(bytes);
        return true;
    }
    std::span<const char> rest() const { return rest_; }

  private:
    std::span<const char> rest_;
};

}  // namespace

std::optional<PackedValues> packedValues(std::span<const char> bytes,
                                         std::span<const std::uint64_t> mask,
                                         const VdbValueFormat& format) {
    using namespace openvdb::io;
    Front front(bytes);
    std::uint8_t kind = 0;
    if (!front.take(kind) || !front.skip(format.inactiveBytes(kind, mask.size_bytes())))
        return std::nullopt;
    auto count = std::uint32_t(64 * mask.size());
    if ((format.compression & COMPRESS_ACTIVE_MASK) != 0 && kind != NO_MASK_AND_ALL_VALS) {
        count = 0;
        for (const std::uint64_t word : mask) count += std::uint32_t(std::popcount(word));
    }
    const std::size_t size = std::size_t{format.stored} * count;
    const bool isHalf = format.stored != format.bytes;
    if ((format.compression & (COMPRESS_BLOSC | COMPRESS_ZIP)) == 0 || (isHalf && count == 0)) {
        if (front.rest().size() != size) return std::nullopt;
        return PackedValues{count, front.rest(), false};
    }
    std::int64_t packed = 0;
    if (!front.take(packed)) return std::nullopt;
    // Stored as they are, with the size's sign turned.
    const std::uint64_t stored = packed > 0 ? std::uint64_t(packed) : size;
    if (front.rest().size() != stored || (packed <= 0 && packed != -std::int64_t(size)))
        return std::nullopt;
    return PackedValues{count, front.rest(), packed > 0};
}

bool unpackBlosc(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    // The decoder believes what a chunk says of its sizes, in the second and fourth of its words.
    std::array<std::uint32_t, 4> words;
    if (chunk.size() < sizeof words) return false;
    std::memcpy(words.data(), chunk.data(), sizeof words);
    if (words[1] != size || words[3] != chunk.size()) return false;
    const int count = blosc_decompress_ctx(chunk.data(), values.data(), values.size(), 1);
    return count > 0 && std::size_t(count) == size;
}

bool unpack(const PackedValues& packed, const VdbValueFormat& format, std::span<char> values) {
    const std::size_t size = std::size_t{format.stored} * packed.count;
    if (packed.isPacked) {
        const bool isBlosc = (format.compression & openvdb::io::COMPRESS_BLOSC) != 0;
        return isBlosc ? unpackBlosc(packed.data, values, size)
                       : unpackZip(packed.data, values, size);
    }
    std::memcpy(values.data(), packed.data.data(), size);
    return true;
}

}  // namespace deltasplat
