// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers read it (LeafNode.h,
// io/Compression.h).
#include "ingest/vdb/vdb_leaves.h"

#include <openvdb/io/Compression.h>
#include <openvdb/points/StreamCompression.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <exception>
#include <iterator>
#include <utility>

#include "ingest/vdb/zip_chunk.h"
#include "parallel.h"

namespace deltasplat {

namespace {

// The values of a leaf, as its bytes have them.
struct PackedValues {
    std::uint32_t count;  // of all voxels, or of the active ones
    std::span<const char> data;
    bool isPacked;
};

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

std::uint32_t countOf(const VdbLeaves::Mask& mask) {
    std::uint32_t active = 0;
    for (const std::uint64_t word : mask) active += std::uint32_t(std::popcount(word));
    return active;
}

// Returns nothing if the bytes are not those of the leaf, from the first to the last.
std::optional<PackedValues> valuesOf(const VdbLeaf& leaf, std::span<const char> bytes,
                                     const VdbValueFormat& format, VdbLeaf::Mask& mask) {
    using namespace openvdb::io;
    Front front(bytes);
    std::uint8_t kind = 0;
    if (!front.take(mask) || !front.take(kind)) return std::nullopt;
    if (VdbLeaf::sumOf(mask) != leaf.maskSum) return std::nullopt;
    const bool one = kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL;
    const bool two = kind == MASK_AND_TWO_INACTIVE_VALS;
    const bool hasMask = kind >= MASK_AND_NO_INACTIVE_VALS && kind <= MASK_AND_TWO_INACTIVE_VALS;
    const std::size_t inactive = format.bytes * (two ? 2 : one ? 1 : 0);
    if (!front.skip(inactive + (hasMask ? sizeof mask : 0))) return std::nullopt;
    const bool activeAlone =
        (format.compression & COMPRESS_ACTIVE_MASK) != 0 && kind != NO_MASK_AND_ALL_VALS;
    const std::uint32_t count = activeAlone ? countOf(mask) : std::uint32_t(VdbLeaves::kVoxels);
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

// The decoder believes what a chunk says of its sizes, in the second and fourth of its words.
bool unpackBlosc(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    std::array<std::uint32_t, 4> words;
    if (chunk.size() < sizeof words) return false;
    std::memcpy(words.data(), chunk.data(), sizeof words);
    if (words[1] != size || words[3] != chunk.size()) return false;
    try {
        openvdb::compression::bloscDecompress(values.data(), size, values.size(), chunk.data());
    } catch (const std::exception&) {
        return false;
    }
    return true;
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

}  // namespace

bool VdbRun::read(const FileBytes& file, std::uint64_t begin, std::uint64_t end) {
    constexpr std::uint64_t kPart = std::uint64_t{1} << 20;
    const std::uint64_t size = end - begin;
    begin_ = end_ = 0;
    if (size > capacity_) {
        bytes_ = std::make_unique_for_overwrite<char[]>(size);
        capacity_ = size;
    }
    std::atomic<bool> isThere = true;
    const auto readPart = [&](std::size_t part) {
        const std::uint64_t first = part * kPart;
        const std::uint64_t wanted = std::min(kPart, size - first);
        if (file.read(begin + first, bytes_.get() + first, wanted) != wanted) isThere = false;
    };
    if (size <= kPart) {
        readPart(0);
    } else {
        parallelFor((size + kPart - 1) / kPart, readPart);
    }
    if (!isThere) return false;
    begin_ = begin;
    end_ = end;
    return true;
}

VdbLeaves::VdbLeaves(std::shared_ptr<const FileBytes> file, std::vector<VdbLeaf> leaves,
                     const VdbValueFormat& format, openvdb::math::Transform::ConstPtr transform)
    : file_(std::move(file)),
      leaves_(std::move(leaves)),
      format_(format),
      transform_(std::move(transform)) {}

std::uint64_t VdbLeaves::bytes() const {
    std::uint64_t sum = 0;
    for (const VdbLeaf& leaf : leaves_) sum += leaf.size;
    return sum;
}

void VdbLeaves::hold() {
    for (std::size_t i = 0; i < leaves_.size();) {
        const std::uint64_t begin = leaves_[i].begin;
        std::uint64_t end = begin;
        for (; i < leaves_.size() && leaves_[i].begin == end; ++i) end = leaves_[i].end();
        VdbRun run;
        if (run.read(*file_, begin, end)) held_.push_back(std::move(run));
    }
}

// Reads a leaf, and those that are asked for next.
bool VdbLeaves::readRun(const VdbLeaf& leaf, VdbRun& run) const {
    constexpr std::size_t kLeaves = 128;
    // Sound leaves are far from it.
    constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 20;
    const auto first = std::size_t(&leaf - leaves_.data());
    const std::size_t last = std::min(leaves_.size(), (first / kLeaves + 1) * kLeaves) - 1;
    std::uint64_t end = leaf.end();
    for (std::size_t i = first + 1; i <= last && leaves_[i].begin == end; ++i) {
        if (leaves_[i].end() - leaf.begin > kMostBytes) break;
        end = leaves_[i].end();
    }
    return run.read(*file_, leaf.begin, end);
}

std::optional<std::span<const char>> VdbLeaves::bytesOf(const VdbLeaf& leaf, VdbRun& room) const {
    if (held_.empty()) {
        if (!room.has(leaf) && !readRun(leaf, room)) return std::nullopt;
        return room.of(leaf);
    }
    const VdbRun* run = &held_.back();
    if (leaf.begin < run->begin()) {
        const auto later = std::upper_bound(
            held_.begin(), held_.end(), leaf.begin,
            [](std::uint64_t place, const VdbRun& other) { return place < other.begin(); });
        if (later == held_.begin()) return std::nullopt;
        run = &*std::prev(later);
    }
    if (!run->has(leaf)) return std::nullopt;
    return run->of(leaf);
}

template <typename Stored>
std::optional<std::span<const Stored>> VdbLeaves::activeValues(const VdbLeaf& leaf, Mask& mask,
                                                               Room<Stored>& room) const {
    const auto bytes = bytesOf(leaf, room.run);
    if (!bytes) return std::nullopt;
    const auto packed = valuesOf(leaf, *bytes, format_, mask);
    if (!packed) return std::nullopt;
    const std::uint32_t active = countOf(mask);
    // What nobody sees must be whole, too.
    if (active == 0 && !packed->isPacked) return std::span<const Stored>{};
    auto& values = room.values;
    if (!unpack(*packed, format_, {reinterpret_cast<char*>(values.data()), sizeof values}))
        return std::nullopt;
    std::size_t kept = active;
    if (packed->count != active) {
        // All values are there.
        kept = 0;
        for (std::size_t x = 0; x < mask.size(); ++x) {
            for (std::uint64_t rest = mask[x]; rest != 0; rest &= rest - 1)
                values[kept++] = values[64 * x + std::size_t(std::countr_zero(rest))];
        }
    }
    return std::span<const Stored>(values.data(), kept);
}

bool VdbLeaves::areSound() const {
    constexpr std::size_t kLeaves = 128;
    // Of a grid of vectors of doubles.
    constexpr std::size_t kMostBytes = 24 * std::size_t{kVoxels} + 64;
    std::atomic<bool> areSound = true;
    parallelFor((leaves_.size() + kLeaves - 1) / kLeaves, [&](std::size_t part) {
        VdbRun run;
        std::vector<char> values(kMostBytes);
        const std::size_t end = std::min(leaves_.size(), (part + 1) * kLeaves);
        for (std::size_t i = part * kLeaves; i < end && areSound; ++i) {
            Mask mask;
            const auto bytes = bytesOf(leaves_[i], run);
            const auto packed = bytes ? valuesOf(leaves_[i], *bytes, format_, mask) : std::nullopt;
            if (!packed || !unpack(*packed, format_, values)) areSound = false;
        }
    });
    return areSound;
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

}  // namespace deltasplat
