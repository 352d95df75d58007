// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "delta/block_windows.h"

#include "memory.h"

namespace deltasplat {
namespace {

// So large that no volume has it, and so small that differences of two are finite.
constexpr double kLargestValue = double(std::numeric_limits<float>::max()) / 4;

float valueOf(const CodeBook& book, int code) {
    return float(std::clamp(book.valueOf(Code(code)), -kLargestValue, kLargestValue));
}

// Code and offset are added as floats: exact as long as their sum is.
bool isDirect(const CodeBook& book) {
    constexpr double kExactFloats = 1 << 24;
    return book.kind == CodeBook::Kind::kInteger &&
           std::abs(book.offset) + kCodeCount <= kExactFloats;
}

// Fills in what values the volume has, and returns the slots of those that matter.
std::vector<Slot> readValues(const Volume& volume, RayRule rule, RayVolume& rays) {
    std::vector<Slot> slots(kSlotCount, kEmptySlot);
    rays.values.direct = isDirect(volume.codeBook);
    rays.values.offset = float(volume.codeBook.offset);
    if (!rays.values.direct) rays.table.assign(kCodeCount, 0);
    bool any = false;
    for (int code = 0; code < kCodeCount; ++code) {
        const std::uint64_t voxels = volume.histogram[std::size_t(code)];
        if (voxels == 0) continue;
        const float value = valueOf(volume.codeBook, code);
        rays.lowest = any ? std::min(rays.lowest, value) : value;
        rays.highest = any ? std::max(rays.highest, value) : value;
        any = true;
        if (!rays.values.direct) rays.table[std::size_t(code)] = value;
        if (rule == RayRule::kSum && value == 0) continue;
        slots[std::size_t(code) + 1] = code + 1;
        rays.visible += voxels;
    }
    rays.empty = rule == RayRule::kMax ? std::min(rays.lowest, 0.0f) : 0.0f;
    rays.values.table = rays.table.data();
    return slots;
}

// Puts blocks, which are ordered by u and v, in the order of layers, u and v.
void sortByLayer(const std::vector<CodeBlock>& blocks, RayVolume& rays) {
    const int first = rays.box.min.x >> 3;
    const int layers = (rays.box.max.x >> 3) - first + 1;
    requireMemory("list of layers", 16.0 * layers);
    rays.begins.assign(std::size_t(layers) + 1, 0);
    for (const CodeBlock& block : blocks) ++rays.begins[std::size_t(block.position.x - first) + 1];
    std::partial_sum(rays.begins.begin(), rays.begins.end(), rays.begins.begin());
    std::vector<std::size_t> next(rays.begins.begin(), rays.begins.end() - 1);
    rays.blocks.resize(blocks.size());
    for (const CodeBlock& block : blocks)
        rays.blocks[next[std::size_t(block.position.x - first)]++] = block;
}

}  // namespace

RayVolume makeRayVolume(const Volume& volume, int sliceAxis, RayRule rule) {
    RayVolume rays;
    rays.box = permutedBox(volume.box, sliceAxis);
    rays.sliceAxis = sliceAxis;
    const std::vector<Slot> slots = readValues(volume, rule, rays);
    sortByLayer(BlockReader(*volume.codes, nullptr, sliceAxis, slots).blocks(), rays);
    return rays;
}

}  // namespace deltasplat
