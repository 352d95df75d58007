// SPDX-License-Identifier: Apache-2.0
#include "words/block_looks.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "view/factorization.h"
#include "volume/leaf_slices.h"
#include "words/mix_window.h"

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

// Outside of the box nothing is visible, whatever the values beside it suggest.
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

namespace {

// Half the difference across `here`, or that to the only neighbour; NaN without a value.
inline float centralDifference(float before, float here, float after) {
    const bool hasBefore = before == before;
    const bool hasAfter = after == after;
    const float first = hasBefore ? before : here;
    const float last = hasAfter ? after : here;
    const float share = hasBefore && hasAfter ? 0.5f : 1.0f;
    const float nothing = here - here;  // 0 or NaN
    return (last - first) * share + nothing;
}

}  // namespace

GradientReader::GradientReader(const CodeTree& codes, int sliceAxis, const Subdivision& parts,
                               const GradientScale& scale)
    : finder_(codes, sliceAxis), sliceAxis_(sliceAxis), parts_(parts), scale_(scale) {
    const int blocks = parts.voxels();
    fields_.resize(std::size_t(blocks));
}

std::span<const BlockField> GradientReader::read(const CodeBlock& block) {
    readValues(block);
    const glm::ivec3 order = sliceOrder(sliceAxis_);
    for (int axis = 0; axis < 3; ++axis) {
        const auto channel = std::size_t(order[axis]);
        fill([&](int rim, float* out) { takeDifferences(axis, rim, out); },
             [&](BlockField & field) -> auto& { return field.gradients[channel]; });
    }
    if (scale_.withValues) {
        fill([&](int rim, float* out) { takeValues(rim, out); },
             [](BlockField & field) -> auto& { return field.values; });
    }
    return fields_;
}

// Fills an array per field with take(rim, out) of the block and a rim around it.
template <typename Take, typename ArrayOf>
void GradientReader::fill(const Take& take, const ArrayOf& arrayOf) {
    if (!parts_.divides()) return take(0, arrayOf(fields_.front()).data());
    std::array<float, MixWindow::kSide * MixWindow::kPlane> window;
    take(1, window.data());
    mixRows(window, parts_, [&](int part, int place, const float* row) {
        std::copy_n(row, 8, &arrayOf(fields_[std::size_t(part)])[std::size_t(place)]);
    });
}

void GradientReader::readValues(const CodeBlock& block) {
    for (int s = -1; s <= 1; ++s) {
        for (int u = -1; u <= 1; ++u) {
            for (int v = -1; v <= 1; ++v) {
                const glm::ivec3 side(s, u, v);
                const std::optional<CodeBlock> found = finder_.find(block.position + side);
                readPart(found ? &*found : nullptr, side);
            }
        }
    }
}

// Reads the rim's part of the block on one side (each component -1, 0 or 1).
void GradientReader::readPart(const CodeBlock* block, const glm::ivec3& side) {
    glm::ivec3 first, last;
    for (int i = 0; i < 3; ++i) {
        first[i] = side[i] < 0 ? 8 - kRim : 0;
        last[i] = side[i] > 0 ? kRim - 1 : 7;
    }
    const auto forAll = [&](const auto& valueOf) {
        forLeafVoxels(sliceAxis_, first, last, [&](const glm::ivec3& place, int n) {
            const glm::ivec3 at = 8 * side + place + kRim;
            const int index = (at.x * kSide + at.y) * kSide + at.z;
            values_[std::size_t(index)] = valueOf(n);
        });
    };
    if (block && block->slots) return readSlots(block->slots, side, first, last);
    const float nothing = scale_.background.value_or(std::numeric_limits<float>::quiet_NaN());
    const CodeTree::Leaf* leaf = block ? block->leaf : nullptr;
    if (!leaf) {
        const bool isThere = block && block->tileSlot != kEmptySlot;
        const float value = isThere ? scale_.ofCode[std::size_t(block->tileSlot) - 1] : nothing;
        return forAll([&](int) { return value; });
    }
    const Code* codes = leaf->buffer().data();
    const float* ofCode = scale_.ofCode.data();
    if (leaf->isDense()) return forAll([&](int n) { return ofCode[codes[n]]; });
    forAll([&](int n) { return leaf->isValueOn(openvdb::Index(n)) ? ofCode[codes[n]] : nothing; });
}

void GradientReader::readSlots(const ShortSlot* slots, const glm::ivec3& side,
                               const glm::ivec3& first, const glm::ivec3& last) {
    const float nothing = scale_.background.value_or(std::numeric_limits<float>::quiet_NaN());
    for (int s = first.x; s <= last.x; ++s) {
        for (int u = first.y; u <= last.y; ++u) {
            for (int v = first.z; v <= last.z; ++v) {
                const glm::ivec3 at = 8 * side + glm::ivec3(s, u, v) + kRim;
                const int index = (at.x * kSide + at.y) * kSide + at.z;
                const ShortSlot slot = slots[64 * s + 8 * u + v];
                values_[std::size_t(index)] =
                    slot == kEmptySlot ? nothing : scale_.ofCode[std::size_t(slot) - 1];
            }
        }
    }
}

// Differences along an axis of (slice, u, v), for the block and a rim.
void GradientReader::takeDifferences(int axis, int rim, float* out) const {
    constexpr int kStrides[] = {kSide * kSide, kSide, 1};
    const int stride = kStrides[axis];
    const int side = 8 + 2 * rim;
    for (int s = 0; s < side; ++s) {
        for (int u = 0; u < side; ++u, out += side) {
            const int first = kRim - rim;
            const int row = ((s + first) * kSide + u + first) * kSide + first;
            const float* here = values_.data() + row;
            for (int v = 0; v < side; ++v)
                out[v] = centralDifference(here[v - stride], here[v], here[v + stride]);
        }
    }
}

void GradientReader::takeValues(int rim, float* out) const {
    const int side = 8 + 2 * rim;
    const int first = kRim - rim;
    for (int s = 0; s < side; ++s) {
        for (int u = 0; u < side; ++u, out += side) {
            const int row = ((s + first) * kSide + u + first) * kSide + first;
            std::copy_n(values_.data() + row, side, out);
        }
    }
}

}  // namespace deltasplat
