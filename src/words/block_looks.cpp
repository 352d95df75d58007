// SPDX-License-Identifier: Apache-2.0
#include "words/block_looks.h"

#include <algorithm>
#include <bit>

#include "view/factorization.h"

namespace deltasplat {

BlockLooks::BlockLooks(const VoxelPainter& painter, const CodeTree& codes, int sliceAxis,
                       const Subdivision& parts, const IndexBox& box)
    : painter_(painter), indexFromThin_(indexFromThinVoxel(sliceAxis, parts)), box_(box) {
    if (const GradientScale* scale = painter.gradientScale())
        reader_.emplace(codes, sliceAxis, parts, *scale);
}

void BlockLooks::beginColumn() {
    block_ = {};
    before_ = {};
    held_ = {};
}

void BlockLooks::beginBlock(const CodeBlock& block) {
    inHand_ = &block;
    fields_ = {};
}

void BlockLooks::paint(const glm::ivec3& position, int number, std::span<ClassIndex, 512> classes) {
    const auto isSeen = [](ClassIndex one) { return one != 0; };
    const bool addsVoxels = painter_.choosesClasses() || painter_.more();
    if (!addsVoxels && std::none_of(classes.begin(), classes.end(), isSeen)) return;
    const BlockPlace place{glm::dvec3(indexFromThin_ * glm::dvec4(8 * position, 1)),
                           glm::dmat3(indexFromThin_)};
    const BlockField* field = nullptr;
    if (reader_) {
        if (fields_.empty()) fields_ = reader_->read(*inHand_);
        field = &fields_[std::size_t(number)];
    }
    painter_.paint(place, field, classes, block_);
    if (addsVoxels) keepInBox(position, classes);
}

void BlockLooks::compare(std::size_t part, BlockChanges& changes) const {
    const OwnLook* last = before_[part].data();
    const OwnLook* slice = block_.data();
    for (int s = 0; s < 8; ++s, last = slice, slice += 64) {
        for (std::uint64_t rest = changes.visible[s]; rest != 0; rest &= rest - 1) {
            const int n = std::countr_zero(rest);
            if (!(slice[n] == last[n])) changes.changed[s] |= std::uint64_t{1} << n;
        }
    }
}

void BlockLooks::endBlock(std::size_t part) {
    std::copy_n(&block_[7 * 64], 64, before_[part].begin());
}

// Nothing is seen where there are no voxels: values beside them may say otherwise.
void BlockLooks::keepInBox(const glm::ivec3& position, std::span<ClassIndex, 512> classes) const {
    const glm::ivec3 first = 8 * position;
    const glm::ivec3 last = first + 7;
    const auto isWithin = [&](const glm::ivec3& at) {
        return glm::all(glm::greaterThanEqual(at, box_.min)) &&
               glm::all(glm::lessThanEqual(at, box_.max));
    };
    if (isWithin(first) && isWithin(last)) return;
    for (int n = 0; n < 512; ++n)
        if (!isWithin(first + glm::ivec3(n / 64, n / 8 % 8, n % 8))) classes[std::size_t(n)] = 0;
}

}  // namespace deltasplat
