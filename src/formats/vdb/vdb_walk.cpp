// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, versions 222 to 225, as OpenVDB 10's headers read it
// (Tree.h, RootNode.h, InternalNode.h, LeafNode*.h, io/Compression.h).
#include "formats/vdb/vdb_walk.h"

#include <openvdb/io/Compression.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "formats/vdb/packed_values.h"

namespace deltasplat {
namespace {

using Place = std::array<std::int32_t, 3>;
using Leaf = VdbValueFormat::Leaf;

constexpr int kUpperLog2 = 5;
constexpr int kLowerLog2 = 4;
constexpr int kLeafLog2 = 3;
constexpr int kUpperExtentLog2 = kUpperLog2 + kLowerLog2 + kLeafLog2;
constexpr int kUpperExtent = 1 << kUpperExtentLog2;

template <int kLog2>
using Mask = std::array<std::uint64_t, (std::size_t{1} << (3 * kLog2)) / 64>;

class Walk {
  public:
    Walk(VdbBytes& bytes, const VdbValueFormat& format, VdbTreePlaces* places)
        : bytes_(bytes), format_(format), places_(places) {}

    VdbTreeSize run() {
        topology();
        // Values follow in the order of the root's map, not in the order of the nodes.
        for (const auto& [origin, leaves] : root_)
            for (const VdbLeaf& leaf : leaves) leafValues(leaf);
        return size_;
    }

    VdbTreeSize runTopology() {
        topology();
        places_->leaves.reserve(size_.leaves);
        for (auto& [origin, leaves] : root_) {
            places_->leaves.insert(places_->leaves.end(), leaves.begin(), leaves.end());
            leaves = {};
        }
        return size_;
    }

    void noteLeaf(VdbLeaf& leaf) {
        leaf.begin = bytes_.position();
        leafValues(leaf);
        const std::uint64_t size = bytes_.position() - leaf.begin;
        leaf.size = std::uint32_t(size);
        if (leaf.size != size) fail("a leaf of " + std::to_string(size) + " bytes");
    }

  private:
    void leafValues(const VdbLeaf& leaf) {
        const auto active = mask<kLeafLog2>();
        if (VdbLeaf::sumOf(active) != leaf.maskSum) fail("a leaf of two different masks");
        if (format_.leaf == Leaf::kValues) return nodeValues<kLeafLog2>(active);
        if (place() != leaf.origin) fail("a misplaced leaf");
        if (format_.leaf == Leaf::kBools) mask<kLeafLog2>();
    }

    void topology() {
        if (bytes_.u32() != 1) fail("a tree of several buffers");
        if (places_) places_->background = bytes_.position();
        bytes_.skip(format_.alone);
        const std::uint32_t tiles = bytes_.u32();
        const std::uint32_t children = bytes_.u32();
        for (std::uint32_t i = 0; i < tiles; ++i) {
            const Place origin = place();
            addRoot(origin);
            const std::uint64_t begin = bytes_.position();
            bytes_.skip(format_.alone);
            const int state = bytes_.u8();
            if (state > 1) fail("a tile that is neither active nor inactive");
            noteNode({origin, 3, begin, format_.alone, std::uint64_t(state)});
            if (places_ && state == 1) noteRootTile(origin);
        }
        for (std::uint32_t i = 0; i < children; ++i) {
            const Place origin = place();
            leaves_ = &addRoot(origin);
            node<kUpperLog2>(origin);
        }
    }

    [[noreturn]] void fail(const std::string& got) const {
        bytes_.failCorrupt(got, "a sound OpenVDB tree");
    }

    Place place() {
        Place place;
        for (std::int32_t& index : place) index = std::int32_t(bytes_.u32());
        return place;
    }

    std::vector<VdbLeaf>& addRoot(const Place& origin) {
        for (const std::int32_t index : origin) {
            if ((index & (kUpperExtent - 1)) != 0) fail("a misplaced root node");
        }
        const auto [entry, added] = root_.try_emplace(origin);
        if (!added) fail("two root nodes in one place");
        return entry->second;
    }

    template <int kLog2>
    Mask<kLog2> mask() {
        Mask<kLog2> words;
        bytes_.read(words.data(), sizeof words);
        return words;
    }

    template <int kLog2>
    void node(const Place& origin) {
        const std::uint64_t begin = bytes_.position();
        const auto children = mask<kLog2>();
        const auto values = mask<kLog2>();
        for (std::size_t i = 0; i < children.size(); ++i) {
            if ((children[i] & values[i]) != 0) fail("a node that is both tile and child");
        }
        ++(kLog2 == kUpperLog2 ? size_.upper : size_.lower);
        nodeValues<kLog2>(values);
        std::uint64_t tiles = 0;
        for (const std::uint64_t word : values) tiles += std::uint64_t(std::popcount(word));
        const int level = kLog2 == kUpperLog2 ? 2 : 1;
        constexpr int kTileLog2 = kLog2 == kUpperLog2 ? kLowerLog2 + kLeafLog2 : kLeafLog2;
        if (places_) noteActive<kLog2>(origin, values, kTileLog2);
        noteNode({origin, level, begin, bytes_.position() - begin, tiles});
        if constexpr (kLog2 == kLowerLog2) readLeafMasks(children);
        std::size_t before = 0;
        for (std::size_t i = 0; i < children.size(); ++i) {
            for (std::uint64_t rest = children[i]; rest != 0; rest &= rest - 1)
                child<kLog2>(origin, int(i * 64) + std::countr_zero(rest), before++);
        }
    }

    // The masks of a node's leaves follow each other.
    void readLeafMasks(const Mask<kLowerLog2>& leaves) {
        std::size_t count = 0;
        for (const std::uint64_t word : leaves) count += std::size_t(std::popcount(word));
        leafMasks_.resize(count);
        bytes_.read(leafMasks_.data(), count * sizeof leafMasks_[0]);
    }

    // Children are numbered x slowest, z fastest.
    // @param before  number of children before this one
    template <int kLog2>
    void child(const Place& origin, int number, std::size_t before) {
        constexpr int kChildLog2 = kLog2 == kUpperLog2 ? kLowerLog2 + kLeafLog2 : kLeafLog2;
        constexpr int kMask = (1 << kLog2) - 1;
        const std::array<int, 3> step{number >> (2 * kLog2), number >> kLog2 & kMask,
                                      number & kMask};
        Place place;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Origins are whole multiples of the extent, so adding cannot overflow.
            place[axis] = origin[axis] + (step[axis] << kChildLog2);
        }
        if constexpr (kLog2 == kUpperLog2) {
            node<kLowerLog2>(place);
        } else {
            leaves_->push_back({place, 0, 0, VdbLeaf::sumOf(leafMasks_[before])});
            ++size_.leaves;
            if (places_) noteActive<kLeafLog2>(place, leafMasks_[before], 0);
        }
    }

    void noteRootTile(const Place& origin) {
        places_->activeVoxels += std::uint64_t{1} << (3 * kUpperExtentLog2);
        places_->activeBox.expand(
            openvdb::CoordBBox::createCube(openvdb::Coord(origin.data()), kUpperExtent));
    }

    // Notes the active voxels of a node or leaf at `origin`.
    // @param childLog2  log2 of the extent of one of its places, in voxels
    template <int kLog2>
    void noteActive(const Place& origin, const Mask<kLog2>& values, int childLog2) {
        std::uint64_t places = 0;
        for (const std::uint64_t word : values) places += std::uint64_t(std::popcount(word));
        if (places == 0) return;
        places_->activeVoxels += places << (3 * childLog2);
        openvdb::CoordBBox& box = places_->activeBox;
        const openvdb::Coord first(origin.data());
        const int width = 1 << (kLog2 + childLog2);
        if (box.isInside(openvdb::CoordBBox::createCube(first, width))) return;
        constexpr int kMask = (1 << kLog2) - 1;
        for (std::size_t i = 0; i < values.size(); ++i) {
            for (std::uint64_t rest = values[i]; rest != 0; rest &= rest - 1) {
                const int number = int(i * 64) + std::countr_zero(rest);
                const openvdb::Coord place((number >> (2 * kLog2)) << childLog2,
                                           (number >> kLog2 & kMask) << childLog2,
                                           (number & kMask) << childLog2);
                box.expand(openvdb::CoordBBox::createCube(first + place, 1 << childLog2));
            }
        }
    }

    void noteNode(const VdbNode& node) {
        size_.tiles += node.tiles;
        if (places_) places_->nodes.push_back(node);
    }

    template <int kLog2>
    void nodeValues(const Mask<kLog2>& active) {
        using namespace openvdb::io;
        const int kind = bytes_.u8();
        bytes_.skip(format_.inactiveBytes(kind, sizeof active));
        std::uint64_t count = active.size() * 64;
        if ((format_.compression & COMPRESS_ACTIVE_MASK) != 0 && kind != NO_MASK_AND_ALL_VALS) {
            count = 0;
            for (const std::uint64_t word : active) count += std::uint64_t(std::popcount(word));
        }
        data(count, kLog2 == kLeafLog2);
    }

    // @param ofLeaf  leaf values: whoever unpacks them later checks them
    void data(std::uint64_t count, bool ofLeaf) {
        if (format_.areKeptAsHalves() && count == 0) return;
        const std::uint64_t expected = count * format_.stored;
        const bool blosc = (format_.compression & openvdb::io::COMPRESS_BLOSC) != 0;
        const bool zip = (format_.compression & openvdb::io::COMPRESS_ZIP) != 0;
        if (!blosc && !zip) {
            bytes_.skip(expected);
            return;
        }
        const std::int64_t size = bytes_.i64();
        if (size <= 0) {
            // A negative size marks values that are not packed.
            if (std::uint64_t{0} - std::uint64_t(size) != expected) {
                fail("a node of " + std::to_string(size) + " bytes instead of -" +
                     std::to_string(expected));
            }
            bytes_.skip(expected);
        } else if (std::uint64_t(size) > expected + expected / 8 + 1024) {
            // Packing adds little to incompressible values: no memory for such a size.
            fail("a compressed node of " + std::to_string(size) + " bytes");
        } else if (blosc) {
            bloscData(std::uint64_t(size), expected);
        } else if (ofLeaf) {
            bytes_.skip(std::uint64_t(size));
        } else {
            std::vector<char> values(expected);
            if (!unpackZip(bytes_.bytes(std::uint64_t(size)), values, expected))
                fail("a compressed node that is damaged");
        }
    }

    // Checks both sizes in a Blosc chunk's head of 16 bytes, because the decoder trusts them.
    void bloscData(std::uint64_t size, std::uint64_t expected) {
        constexpr std::uint64_t kHeader = 16;
        if (size < kHeader) fail("a compressed node of " + std::to_string(size) + " bytes");
        bytes_.u32();
        const std::uint32_t unpacked = bytes_.u32();
        bytes_.u32();
        const std::uint32_t packed = bytes_.u32();
        if (unpacked != expected || packed != size) fail("a compressed node of another size");
        bytes_.skip(size - kHeader);
    }

    VdbBytes& bytes_;
    const VdbValueFormat& format_;
    VdbTreePlaces* places_;
    VdbTreeSize size_;
    std::map<Place, std::vector<VdbLeaf>> root_;  // leaves of each root node, in file order
    std::vector<VdbLeaf>* leaves_ = nullptr;
    std::vector<VdbLeaf::Mask> leafMasks_;  // of the current node
};

}  // namespace

// Sums up 32-bit halves of words, each times its own random number below the prime 2^61 - 1, modulo
// this prime. Two different masks get the same sum with a probability of 2^-61, whatever they are
// (L. Carter and M. Wegman, "Universal Classes of Hash Functions", 1979).
std::uint64_t VdbLeaf::sumOf(const Mask& mask) {
    __extension__ using Wide = unsigned __int128;
    constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;
    static const std::array<std::uint64_t, 16> numbers = [] {
        std::random_device random;
        std::array<std::uint64_t, 16> drawn;
        for (std::uint64_t& number : drawn)
            number = (std::uint64_t{random()} << 32 | random()) % kPrime;
        return drawn;
    }();
    Wide sum = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        sum += Wide{numbers[2 * i]} * std::uint32_t(mask[i]);
        sum += Wide{numbers[2 * i + 1]} * (mask[i] >> 32);
    }
    // Below 2^98.
    sum = (sum & kPrime) + (sum >> 61);
    return std::uint64_t(sum % kPrime);
}

std::uint64_t VdbValueFormat::inactiveBytes(int kind, std::uint64_t mask) const {
    using namespace openvdb::io;
    const bool one = kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL;
    const bool two = kind == MASK_AND_TWO_INACTIVE_VALS;
    const bool hasMask = kind >= MASK_AND_NO_INACTIVE_VALS && kind <= MASK_AND_TWO_INACTIVE_VALS;
    return std::uint64_t{alone} * (two ? 2 : one ? 1 : 0) + (hasMask ? mask : 0);
}

bool VdbValueFormat::setType(const std::string& type, bool half) {
    static const std::map<std::string, std::pair<std::uint32_t, bool>> kTypes{
        {"float", {4, true}},  {"double", {8, true}}, {"int32", {4, false}}, {"half", {4, true}},
        {"int64", {8, false}}, {"bool", {1, false}},  {"mask", {1, false}},  {"vec3s", {12, true}},
        {"vec3d", {24, true}}, {"vec3i", {12, false}}};
    const auto found = kTypes.find(type);
    if (found == kTypes.end()) return false;
    bytes = found->second.first;
    real = found->second.second;
    const bool vector = type.starts_with("vec3");
    const bool isHalf = type == kHalfType;
    stored = (half && real) || isHalf ? (vector ? 6 : 2) : bytes;
    alone = isHalf ? stored : bytes;
    leaf = type == "bool" ? Leaf::kBools : type == "mask" ? Leaf::kMask : Leaf::kValues;
    return true;
}

double VdbTreeSize::memoryBytes(const VdbValueFormat& format) const {
    // A node's slot holds a pointer or a value; a leaf has 128 bytes besides its values.
    const auto treeBytes = [&](std::uint32_t value) {
        const std::uint32_t slot = std::max<std::uint32_t>(8, (value + 7) / 8 * 8);
        return double(leaves) * (512.0 * value + 128) +
               (double(lower) * 4096 + double(upper) * 32768) * slot;
    };
    constexpr std::uint32_t kCodeBytes = 2;
    const bool isVector = format.bytes > 8;
    return treeBytes(format.bytes) + treeBytes(kCodeBytes) +
           (isVector ? treeBytes(format.bytes / 3) : 0);
}

double VdbTreeSize::codeBytes(const VdbValueFormat& format) const {
    // A tile's place, value and code, and its share of a node's unpacked bytes.
    const double tileBytes = 16 + 2.0 * format.bytes + 2;
    return double(leaves) * (512.0 * 2 + 128) + double(tiles) * tileBytes +
           (double(lower) * 4096 + double(upper) * 32768) * 8;
}

double VdbTreeSize::nodeBytes() const {
    // A leaf's mask, its other members, and a VdbLeaf.
    const double leafBytes = 64 + 64 + sizeof(VdbLeaf);
    return double(leaves) * leafBytes + (double(lower) * 4096 + double(upper) * 32768) * 8;
}

VdbTreeSize walkTree(VdbBytes& bytes, const VdbValueFormat& format) {
    return Walk(bytes, format, nullptr).run();
}

VdbTreeSize walkTopology(VdbBytes& bytes, const VdbValueFormat& format, VdbTreePlaces& places) {
    return Walk(bytes, format, &places).runTopology();
}

void walkLeaves(VdbBytes& bytes, const VdbValueFormat& format, std::vector<VdbLeaf>& leaves) {
    Walk walk(bytes, format, nullptr);
    for (VdbLeaf& leaf : leaves) walk.noteLeaf(leaf);
}

}  // namespace deltasplat
