// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers read it (LeafNode.h,
// io/Compression.h).
#include "ingest/vdb/vdb_leaves.h"

#include <openvdb/io/Compression.h>
#include <openvdb/points/StreamCompression.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <iterator>
#include <utility>

namespace deltasplat {

namespace {

bool unpackBlosc(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    try {
        openvdb::compression::bloscDecompress(values.data(), size, values.size(), chunk.data());
    } catch (const std::exception&) {
        return false;
    }
    return true;
}

bool unpackZip(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    uLongf unpacked = values.size();
    const int status =
        ::uncompress(reinterpret_cast<Bytef*>(values.data()), &unpacked,
                     reinterpret_cast<const Bytef*>(chunk.data()), uLong(chunk.size()));
    return status == Z_OK && unpacked == size;
}

}  // namespace

VdbLeaves::VdbLeaves(std::vector<VdbRun> runs, std::vector<VdbLeaf> leaves,
                     const VdbValueFormat& format, openvdb::math::Transform::ConstPtr transform)
    : runs_(std::move(runs)),
      leaves_(std::move(leaves)),
      format_(format),
      transform_(std::move(transform)) {}

// Where a byte of a leaf is in memory, and those of the leaf behind it.
const char* VdbLeaves::at(std::uint64_t position) const {
    const VdbRun* run = &runs_.back();
    if (position < run->begin) {
        run = &*std::prev(std::upper_bound(
            runs_.begin(), runs_.end(), position,
            [](std::uint64_t place, const VdbRun& later) { return place < later.begin; }));
    }
    return run->bytes.data() + (position - run->begin);
}

VdbLeaves::Mask VdbLeaves::maskOf(const VdbLeaf& leaf) const {
    Mask mask;
    std::memcpy(mask.data(), at(leaf.mask), sizeof mask);
    return mask;
}

template <typename Stored>
std::span<const Stored> VdbLeaves::activeValues(const VdbLeaf& leaf, const Mask& mask,
                                                Values<Stored>& room) const {
    std::size_t active = 0;
    for (const std::uint64_t word : mask) active += std::size_t(std::popcount(word));
    const std::span<char> bytes(reinterpret_cast<char*>(room.data()), sizeof room);
    if (active == 0 || !unpack(leaf, bytes)) return {};
    if (leaf.count == active) return {room.data(), active};
    // All values are there.
    std::size_t kept = 0;
    for (std::size_t x = 0; x < mask.size(); ++x) {
        for (std::uint64_t rest = mask[x]; rest != 0; rest &= rest - 1)
            room[kept++] = room[64 * x + std::size_t(std::countr_zero(rest))];
    }
    return {room.data(), kept};
}

template std::span<const std::uint16_t> VdbLeaves::activeValues(const VdbLeaf&, const Mask&,
                                                                Values<std::uint16_t>&) const;
template std::span<const float> VdbLeaves::activeValues(const VdbLeaf&, const Mask&,
                                                        Values<float>&) const;
template std::span<const double> VdbLeaves::activeValues(const VdbLeaf&, const Mask&,
                                                         Values<double>&) const;
template std::span<const std::int32_t> VdbLeaves::activeValues(const VdbLeaf&, const Mask&,
                                                               Values<std::int32_t>&) const;
template std::span<const std::int64_t> VdbLeaves::activeValues(const VdbLeaf&, const Mask&,
                                                               Values<std::int64_t>&) const;

// The walk has found that sizes are what the file says.
bool VdbLeaves::unpack(const VdbLeaf& leaf, std::span<char> values) const {
    const std::size_t size = std::size_t{format_.stored} * leaf.count;
    std::uint64_t data = leaf.data;
    const bool isBlosc = (format_.compression & openvdb::io::COMPRESS_BLOSC) != 0;
    if (isBlosc || (format_.compression & openvdb::io::COMPRESS_ZIP) != 0) {
        std::int64_t packed;
        std::memcpy(&packed, at(data), sizeof packed);
        data += sizeof packed;
        if (packed > 0) {
            const std::span<const char> chunk(at(data), std::size_t(packed));
            return isBlosc ? unpackBlosc(chunk, values, size) : unpackZip(chunk, values, size);
        }
    }
    std::memcpy(values.data(), at(data), size);
    return true;
}

}  // namespace deltasplat
