// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/mixed_blocks.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "base/parallel.h"

namespace deltasplat {
namespace {

// The slices of a layer that are in memory.
struct Layer {
    const DenseSource& source;
    const std::byte* bytes;
    int slices;

    std::size_t valueBytes() const { return std::size_t(rawTypeBytes(source.type)); }
    const std::byte* at(int x, int y, int z) const {
        return bytes + std::size_t(z) * source.sliceBytes() + std::size_t(y) * source.rowBytes() +
               std::size_t(x) * valueBytes();
    }

    bool isMixed(int x, int y) const {
        const int width = std::min(8, int(source.dims.x) - x);
        const int height = std::min(8, int(source.dims.y) - y);
        if (width < 8 || height < 8 || slices < 8) return true;
        const std::byte* first = at(x, y, 0);
        const std::size_t row = 8 * valueBytes();
        // The first row is uniform if it equals itself one value on.
        if (std::memcmp(first, first + valueBytes(), row - valueBytes()) != 0) return true;
        for (int z = 0; z < 8; ++z) {
            for (int v = 0; v < 8; ++v) {
                if (std::memcmp(first, at(x, y + v, z), row) != 0) return true;
            }
        }
        return false;
    }
};

}  // namespace

std::uint64_t countMixedBlocks(const DenseSource& source, const Listener& listener) {
    std::atomic<std::uint64_t> mixed{0};
    source.forEachLayer(
        [&](int, int slices, const std::byte* bytes) {
            const Layer layer{source, bytes, slices};
            parallelFor(std::size_t((source.dims.y + 7) / 8), [&](std::size_t row) {
                std::uint64_t count = 0;
                for (int x = 0; x < int(source.dims.x); x += 8)
                    count += layer.isMixed(x, 8 * int(row)) ? 1 : 0;
                mixed += count;
            });
        },
        listener);
    return mixed;
}

}  // namespace deltasplat
