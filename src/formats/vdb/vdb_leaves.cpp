// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10 reads it (io/DelayedLoadMetadata.h).
#include "formats/vdb/vdb_leaves.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <span>
#include <utility>

#include "formats/vdb/packed_values.h"

namespace deltasplat {

namespace {

std::uint32_t countOf(const VdbLeaves::Mask& mask) {
    std::uint32_t active = 0;
    for (const std::uint64_t word : mask) active += std::uint32_t(std::popcount(word));
    return active;
}

// Takes a mask from a leaf's bytes. Returns whether its sum is right.
bool takeMask(const VdbLeaf& leaf, std::span<const char> bytes, VdbLeaf::Mask& mask) {
    if (bytes.size() < sizeof mask) return false;
    std::memcpy(mask.data(), bytes.data(), sizeof mask);
    return VdbLeaf::sumOf(mask) == leaf.maskSum;
}

// Returns nothing if the bytes are not those of the leaf, from first to last.
std::optional<PackedValues> valuesOf(const VdbLeaf& leaf, std::span<const char> bytes,
                                     const VdbValueFormat& format, VdbLeaf::Mask& mask) {
    if (!takeMask(leaf, bytes, mask)) return std::nullopt;
    return packedValues(bytes.subspan(sizeof mask), mask, format);
}

}  // namespace

bool VdbRun::read(const FileBytes& file, std::uint64_t begin, std::uint64_t end) {
    const std::uint64_t size = end - begin;
    begin_ = end_ = 0;
    if (size > capacity_) {
        bytes_ = std::make_unique_for_overwrite<char[]>(size);
        capacity_ = size;
    }
    if (file.readInParts(begin, bytes_.get(), size) != size) return false;
    begin_ = begin;
    end_ = end;
    return true;
}

VdbLeaves::VdbLeaves(std::shared_ptr<const FileBytes> file, std::vector<VdbLeaf> leaves,
                     const VdbValueFormat& format, openvdb::math::MapBase::ConstPtr transform)
    : file_(std::move(file)),
      leaves_(std::move(leaves)),
      format_(format),
      transform_(std::move(transform)) {}

// Reads a leaf and the following leaves before `behind`, which are asked for next.
bool VdbLeaves::readRun(const VdbLeaf& leaf, VdbRun& run, std::size_t behind) const {
    // Far more than sound leaves have.
    constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 20;
    const auto first = std::size_t(&leaf - leaves_.data());
    const std::size_t last = std::min({leaves_.size(), behind, (first / kRun + 1) * kRun}) - 1;
    std::uint64_t end = leaf.end();
    for (std::size_t i = first + 1; i <= last && leaves_[i].begin == end; ++i) {
        if (leaves_[i].end() - leaf.begin > kMostBytes) break;
        end = leaves_[i].end();
    }
    return run.read(*file_, leaf.begin, end);
}

std::optional<std::span<const char>> VdbLeaves::bytesOf(const VdbLeaf& leaf, VdbRun& room,
                                                        std::size_t behind) const {
    if (!room.has(leaf) && !readRun(leaf, room, behind)) return std::nullopt;
    return room.of(leaf);
}

template <typename Stored>
std::optional<std::span<const Stored>> VdbLeaves::activeValues(const VdbLeaf& leaf, Mask& mask,
                                                               Room<Stored>& room) const {
    const auto bytes = bytesOf(leaf, room.run, room.end);
    if (!bytes) return std::nullopt;
    const auto packed = valuesOf(leaf, *bytes, format_, mask);
    if (!packed) return std::nullopt;
    const std::uint32_t active = countOf(mask);
    // Values that no one sees must be intact, too.
    if (active == 0 && !packed->isPacked) return std::span<const Stored>{};
    auto& values = room.values;
    if (!unpack(*packed, format_, {reinterpret_cast<char*>(values.data()), sizeof values}))
        return std::nullopt;
    std::size_t kept = active;
    if (packed->count != active) {
        // Values of inactive voxels are stored as well.
        kept = 0;
        for (std::size_t x = 0; x < mask.size(); ++x) {
            for (std::uint64_t rest = mask[x]; rest != 0; rest &= rest - 1)
                values[kept++] = values[64 * x + std::size_t(std::countr_zero(rest))];
        }
    }
    return std::span<const Stored>(values.data(), kept);
}

template <typename T>
bool VdbLeaves::allValues(const VdbLeaf& leaf, T background, std::size_t behind, Mask& mask,
                          BytesRoom& room, T* values) const {
    const auto bytes = bytesOf(leaf, room.run, behind);
    return bytes && takeMask(leaf, *bytes, mask) &&
           unpackAll(bytes->subspan(sizeof mask), mask, format_, background, room.stored, values);
}

bool VdbLeaves::allBools(const VdbLeaf& leaf, std::size_t behind, Mask& mask, VdbRun& run,
                         Mask& values) const {
    const auto bytes = bytesOf(leaf, run, behind);
    if (!bytes || !takeMask(leaf, *bytes, mask)) return false;
    values = mask;
    const bool isMask = format_.leaf == VdbValueFormat::Leaf::kMask;
    const std::size_t place = sizeof mask;
    const std::size_t bits = place + sizeof leaf.origin;
    if (bytes->size() != bits + (isMask ? 0 : sizeof values)) return false;
    if (std::memcmp(&(*bytes)[place], leaf.origin.data(), sizeof leaf.origin) != 0) return false;
    if (!isMask) std::memcpy(values.data(), &(*bytes)[bits], sizeof values);
    return true;
}

#define DELTASPLAT_ACTIVE_VALUES(Stored)                                     \
    template std::optional<std::span<const Stored>> VdbLeaves::activeValues( \
        const VdbLeaf&, VdbLeaves::Mask&, VdbLeaves::Room<Stored>&) const;
DELTASPLAT_ACTIVE_VALUES(std::uint16_t)
DELTASPLAT_ACTIVE_VALUES(float)
DELTASPLAT_ACTIVE_VALUES(double)
DELTASPLAT_ACTIVE_VALUES(std::int32_t)
DELTASPLAT_ACTIVE_VALUES(std::int64_t)
#undef DELTASPLAT_ACTIVE_VALUES

template bool VdbLeaves::allValues(const VdbLeaf&, float, std::size_t, Mask&, BytesRoom&,
                                   float*) const;
template bool VdbLeaves::allValues(const VdbLeaf&, double, std::size_t, Mask&, BytesRoom&,
                                   double*) const;
template bool VdbLeaves::allValues(const VdbLeaf&, std::int32_t, std::size_t, Mask&, BytesRoom&,
                                   std::int32_t*) const;
template bool VdbLeaves::allValues(const VdbLeaf&, std::int64_t, std::size_t, Mask&, BytesRoom&,
                                   std::int64_t*) const;
template bool VdbLeaves::allValues(const VdbLeaf&, openvdb::Vec3f, std::size_t, Mask&, BytesRoom&,
                                   openvdb::Vec3f*) const;
template bool VdbLeaves::allValues(const VdbLeaf&, openvdb::Vec3d, std::size_t, Mask&, BytesRoom&,
                                   openvdb::Vec3d*) const;
template bool VdbLeaves::allValues(const VdbLeaf&, openvdb::Vec3i, std::size_t, Mask&, BytesRoom&,
                                   openvdb::Vec3i*) const;

namespace {

// OpenVDB packs no less than this: shorter arrays are padded with zeros.
constexpr std::size_t kLeastPacked = 128;

// Takes an array as OpenVDB writes it: its packed size, or 0 if it is not packed, then its bytes.
// Moves `place` behind it. Returns whether it is intact.
// @param values  room for max(`bytes`, kLeastPacked), and for unpacking
bool takeArray(const std::string& stored, std::size_t bytes, std::span<char> values,
               std::uint64_t& place) {
    std::uint32_t packed = 0;
    if (stored.size() - place < sizeof packed) return false;
    std::memcpy(&packed, stored.data() + place, sizeof packed);
    place += sizeof packed;
    const std::uint64_t size = packed > 0 ? packed : bytes;
    if (stored.size() - place < size) return false;
    const std::span<const char> data(stored.data() + place, size);
    place += size;
    if (packed > 0) return unpackBlosc(data, values, std::max(bytes, kLeastPacked));
    std::memcpy(values.data(), data.data(), size);
    return true;
}

}  // namespace

std::optional<std::vector<std::uint64_t>> leafSizesOf(const std::string& stored, std::size_t leaves,
                                                      const VdbValueFormat& format) {
    constexpr std::uint64_t kLeafMask = 64;
    std::uint32_t count = 0;
    if (stored.size() < sizeof count) return std::nullopt;
    std::memcpy(&count, stored.data(), sizeof count);
    if (count != leaves) return std::nullopt;
    std::uint64_t place = sizeof count;
    const auto take = [&](auto& values) {
        const std::size_t bytes = leaves * sizeof values[0];
        values.resize((std::max(bytes, kLeastPacked) + kUnpackBytes) / sizeof values[0]);
        const bool isThere = takeArray(
            stored, bytes,
            {reinterpret_cast<char*>(values.data()), values.size() * sizeof values[0]}, place);
        values.resize(leaves);
        return isThere;
    };
    std::vector<std::uint8_t> kinds;
    std::vector<std::uint64_t> sizes;
    if (!take(kinds) || !take(sizes)) return std::nullopt;
    for (std::size_t i = 0; i < leaves; ++i) {
        if (sizes[i] > std::uint64_t{1} << 20) return std::nullopt;
        // A byte for the kind of inactive values, these values, and the mask that assigns them.
        sizes[i] += 1 + format.inactiveBytes(kinds[i], kLeafMask);
    }
    return sizes;
}

}  // namespace deltasplat
