// SPDX-License-Identifier: Apache-2.0
#include "scene_digest.h"

#include <bit>
#include <cstddef>
#include <vector>

#include "parallel.h"

namespace deltasplat {
namespace {

// 64-bit words multiplied into a state, as MurmurHash3's finalizer mixes (Austin Appleby, public
// domain).
class Digest {
  public:
    void add(std::uint64_t word) {
        state_ = (state_ ^ word) * 0xff51afd7ed558ccdULL;
        state_ ^= state_ >> 32;
    }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0xc4ceb9fe1a85ec53ULL;
};

void addColors(const ClassTable::Digit& digit, Digest& digest) {
    for (const ClassTable::Color& color : digit.colors)
        digest.add(std::bit_cast<std::uint64_t>(color));
}

std::uint64_t digestOfSlice(const PackedDeltas& deltas, std::size_t slice) {
    Digest digest;
    for (std::size_t i = deltas.begins[slice]; i < deltas.begins[slice + 1]; ++i) {
        const DeltaWord& word = deltas.words[i];
        digest.add(word.visible);
        digest.add(word.changed);
        digest.add(std::uint64_t(std::uint32_t(word.block.x)) << 32 | std::uint32_t(word.block.y));
        for (int voxel = 0; voxel < 64; voxel += 4) {
            std::uint64_t classes = 0;
            for (int next = voxel; next < voxel + 4; ++next)
                classes = classes << 16 | word.classes[next];
            digest.add(classes);
        }
        if (deltas.looks.empty()) continue;
        for (int voxel = 0; voxel < 64; ++voxel)
            digest.add(std::bit_cast<std::uint64_t>(deltas.looks[i][voxel]));
    }
    return digest.value();
}

}  // namespace

std::uint64_t digestOf(const PictureView& view) {
    const PackedDeltas& deltas = view.axis().deltas();
    const std::size_t slices = deltas.begins.empty() ? 0 : deltas.begins.size() - 1;
    std::vector<std::uint64_t> ofSlices(slices);
    parallelFor(slices, [&](std::size_t i) { ofSlices[i] = digestOfSlice(deltas, i); });
    Digest digest;
    for (const std::uint64_t slice : ofSlices) digest.add(slice);
    const ClassTable& table = view.slabs().splat.colors.classes();
    for (const ClassTable::Plane& plane : table.planes) {
        addColors(plane.high, digest);
        addColors(plane.low, digest);
    }
    for (int channel = 0; channel < 4; ++channel) digest.add(table.scale[channel]);
    for (const std::int32_t weight : view.footprint().weights) digest.add(std::uint64_t(weight));
    return digest.value();
}

}  // namespace deltasplat
