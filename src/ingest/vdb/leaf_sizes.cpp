// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers read it (io/Compression.h,
// io/DelayedLoadMetadata.h).
#include "ingest/vdb/leaf_sizes.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/DelayedLoadMetadata.h>

#include <cstring>
#include <exception>
#include <ios>
#include <sstream>

#include "ingest/vdb/vdb_bytes.h"

namespace deltasplat {
namespace {

// Whether an array begins at `place` as OpenVDB writes one: how many bytes it is packed in, 0 if it
// is not, and those. Moves `place` behind it. What a chunk of Blosc's says of its sizes, in the
// second and fourth of its first four words, its decoder would believe.
bool isArray(const std::string& stored, std::uint64_t bytes, std::uint64_t& place) {
    const auto wordAt = [&](std::uint64_t at) {
        std::uint32_t word;
        std::memcpy(&word, stored.data() + at, sizeof word);
        return word;
    };
    constexpr std::uint64_t kHeader = 16;
    if (stored.size() - place < sizeof(std::uint32_t)) return false;
    const std::uint32_t packed = wordAt(place);
    place += sizeof packed;
    if (stored.size() - place < (packed > 0 ? packed : bytes)) return false;
    if (packed > 0 &&
        (packed < kHeader || wordAt(place + 4) != bytes || wordAt(place + 12) != packed)) {
        return false;
    }
    place += packed > 0 ? packed : bytes;
    return true;
}

// Whether there is a byte for each leaf, and then a size of eight.
bool isSound(const std::string& stored, std::size_t leaves) {
    std::uint64_t place = sizeof(std::uint32_t);
    return isArray(stored, leaves, place) && isArray(stored, 8 * std::uint64_t{leaves}, place);
}

}  // namespace

std::optional<std::vector<std::uint64_t>> leafSizesOf(const std::string& stored, std::size_t leaves,
                                                      const VdbValueFormat& format) {
    using openvdb::io::DelayedLoadMetadata;
    std::uint32_t count = 0;
    if (stored.size() < sizeof count || !DelayedLoadMetadata::isRegisteredType())
        return std::nullopt;
    std::memcpy(&count, stored.data(), sizeof count);
    if (count != leaves || !isSound(stored, leaves)) return std::nullopt;
    try {
        std::string text;
        appendU32(text, 1);
        const std::string type = DelayedLoadMetadata::staticTypeName();
        for (const std::string& part : {std::string("sizes"), type, stored}) {
            appendU32(text, std::uint32_t(part.size()));
            text += part;
        }
        std::istringstream stream(text);
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        openvdb::MetaMap map;
        map.readMeta(stream);
        const auto metadata = map.getMetadata<DelayedLoadMetadata>("sizes");
        if (!metadata) return std::nullopt;
        std::vector<std::uint64_t> sizes;
        for (std::size_t i = 0; i < leaves; ++i) {
            // A byte that says what inactive values are like, those, and which voxel has which.
            using namespace openvdb::io;
            const int kind = static_cast<unsigned char>(metadata->getMask(i));
            const bool one =
                kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL;
            const bool two = kind == MASK_AND_TWO_INACTIVE_VALS;
            const bool hasMask =
                kind >= MASK_AND_NO_INACTIVE_VALS && kind <= MASK_AND_TWO_INACTIVE_VALS;
            const std::int64_t packed = metadata->getCompressedSize(i);
            if (packed < 0 || packed > std::int64_t{1} << 20) return std::nullopt;
            const std::uint64_t inactive = format.bytes * (two ? 2u : one ? 1u : 0u);
            sizes.push_back(1 + inactive + (hasMask ? 64u : 0u) + std::uint64_t(packed));
        }
        return sizes;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace deltasplat
