// SPDX-License-Identifier: Apache-2.0
#include "delta/joined_class_reader.h"

#include <algorithm>
#include <cstddef>
#include <glm/vec3.hpp>

#include "ingest/codes/leaf_slices.h"

namespace deltasplat {

// A block of which single voxels are read; empty: there is none.
struct JoinedClassReader::OpenBlock {
    const ShortSlot* slots = nullptr;                      // as CodeBlock has them
    const Code* codes = nullptr;                           // of a leaf
    const CodeTree::Leaf::NodeMaskType* active = nullptr;  // of its voxels; null: all
    ClassIndex tile = 0;   // of what is neither slot nor active code
    glm::ivec3 stride{0};  // from voxel to voxel, (slice, u, v)

    int placeOf(const glm::ivec3& at) const {
        return at.x * stride.x + at.y * stride.y + at.z * stride.z;
    }
};

// Reads a block of joined slices.
void JoinedClassReader::read(const JoinedSources& sources,
                             std::span<ClassIndex, 512> joined) const {
    constexpr std::size_t kSlice = 64;
    constexpr std::size_t kJoined = 4;  // of each half
    // Rows are copied from one voxel before or behind them on.
    constexpr std::size_t kSpare = 8;
    std::array<ClassIndex, 512 + kSpare> padded{};
    const std::span<ClassIndex, 512> own = std::span(padded).first<512>();
    std::array<ClassIndex, kSlice> slanted;
    const bool isSlanted = slant_ != glm::ivec2(0);
    ClassIndex* out = joined.data();
    for (const auto& half : sources) {
        if (half[0]) {
            classes_.read(*half[0], own);
        } else {
            std::fill(own.begin(), own.end(), ClassIndex{0});
        }
        std::array<OpenBlock, 4> beside;
        for (std::size_t i = 1; isSlanted && i < beside.size(); ++i)
            if (half[i]) beside[i] = open(*half[i]);
        for (std::size_t i = 0; i < kJoined; ++i, out += kSlice) {
            const ClassIndex* first = &own[2 * i * kSlice];
            const ClassIndex* second = first + kSlice;
            if (isSlanted) {
                slantSlice(beside, second, int(2 * i + 1), slanted.data());
                second = slanted.data();
            }
            joiner_.join(first, second, out);
        }
    }
}

// Writes a slice moved by the slant.
// @param beside  the blocks that the others than its own come from
// @param own     of the block that it is moved in; there is a voxel before and behind it
void JoinedClassReader::slantSlice(const std::array<OpenBlock, 4>& beside, const ClassIndex* own,
                                   int slice, ClassIndex* out) const {
    const int edgeU = slant_.x > 0 ? 7 : 0;  // of the blocks beside
    const int edgeV = slant_.y > 0 ? 7 : 0;
    std::array<ClassIndex, 24> padded{};
    const auto row = std::span(padded).subspan<8, 8>();
    if (slant_.x != 0) readLine(beside[1], {slice, edgeU, 0}, {0, 0, 1}, row);
    std::array<ClassIndex, 8> column{};
    if (slant_.y != 0) readLine(beside[2], {slice, 0, edgeV}, {0, 1, 0}, column);
    for (int u = 0; u < 8; ++u, out += 8) {
        const int fromU = u - slant_.x;
        const bool isIn = fromU >= 0 && fromU < 8;
        std::copy_n((isIn ? own + 8 * fromU : row.data()) - slant_.y, 8, out);
        if (slant_.y == 0) continue;
        out[7 - edgeV] =
            isIn ? column[std::size_t(fromU)] : classAt(beside[3], glm::ivec3(slice, edgeU, edgeV));
    }
}

JoinedClassReader::OpenBlock JoinedClassReader::open(const CodeBlock& block) const {
    constexpr glm::ivec3 kSlotStride{64, 8, 1};
    if (block.slots) return {block.slots, nullptr, nullptr, 0, kSlotStride};
    if (!block.leaf) return {nullptr, nullptr, nullptr, ClassIndex(block.tileSlot), kSlotStride};
    return {nullptr, block.leaf->buffer().data(),
            block.leaf->isDense() ? nullptr : &block.leaf->valueMask(), 0,
            toSliceOrder(kLeafStride, classes_.sliceAxis())};
}

// Returns the class of a voxel of a block, at (slice, u, v) of 0..7 each.
ClassIndex JoinedClassReader::classAt(const OpenBlock& block, const glm::ivec3& at) const {
    const int n = block.placeOf(at);
    if (block.slots) return ClassIndex(classes_.slotMap()[block.slots[n]]);
    if (!block.codes || (block.active && !block.active->isOn(openvdb::Index(n)))) return block.tile;
    return ClassIndex(classes_.slotMap()[block.codes[n] + 1]);
}

// Reads the classes of a line of voxels.
// @param step  from one to the next
void JoinedClassReader::readLine(const OpenBlock& block, const glm::ivec3& first,
                                 const glm::ivec3& step, std::span<ClassIndex, 8> out) const {
    const Slot* const map = classes_.slotMap().data();
    const int begin = block.placeOf(first);
    const int stride = block.placeOf(step);
    if (block.slots) {
        for (int i = 0; i < 8; ++i) out[i] = ClassIndex(map[block.slots[begin + i * stride]]);
    } else if (block.codes && !block.active) {
        for (int i = 0; i < 8; ++i) out[i] = ClassIndex(map[block.codes[begin + i * stride] + 1]);
    } else {
        for (int i = 0; i < 8; ++i) out[i] = classAt(block, first + i * step);
    }
}

}  // namespace deltasplat
