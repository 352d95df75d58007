// SPDX-License-Identifier: Apache-2.0
// Based on: Lance Williams, "Pyramidal Parametrics", 1983 (what is finer than a pixel is averaged
// beforehand).
#include "rays/coarse_rays.h"

#include <algorithm>
#include <array>
#include <memory>
#include <tuple>
#include <utility>

#include "floor_div.h"
#include "parallel_sort.h"
#include "rays/block_values.h"

namespace deltasplat {
namespace {

glm::ivec3 quotient(const glm::ivec3& a, const glm::ivec3& b) {
    return {floorDiv(a.x, b.x), floorDiv(a.y, b.y), floorDiv(a.z, b.z)};
}

// Makes each `count` pieces of `length` values into their sum.
void sumPieces(std::size_t sums, int count, std::size_t length, float* values) {
    if (count == 1) return;
    const float* in = values;
    for (float* out = values; sums > 0; --sums, out += length) {
        std::copy_n(in, length, out);
        in += length;
        for (int k = 1; k < count; ++k, in += length)
            for (std::size_t i = 0; i < length; ++i) out[i] += in[i];
    }
}

// Writes the means of a block's boxes.
void writeMeans(const RayVolume& fine, const CodeBlock& block, const glm::ivec3& boxes,
                const BlockPlace& place) {
    std::array<float, 512> values;
    readActiveValues(fine, block, {values.data(), 64, 8});
    const auto slices = std::size_t(8 / boxes.x);
    const auto rows = std::size_t(8 / boxes.y);
    const auto columns = std::size_t(8 / boxes.z);
    sumPieces(slices, boxes.x, 64, values.data());
    sumPieces(slices * rows, boxes.y, 8, values.data());
    sumPieces(slices * rows * columns, boxes.z, 1, values.data());
    const float share = 1 / float(boxes.x * boxes.y * boxes.z);
    const float* value = values.data();
    for (std::size_t slice = 0; slice < slices; ++slice) {
        for (std::size_t u = 0; u < rows; ++u) {
            float* const out = place.first + slice * place.sliceStep + u * place.rowStep;
            for (std::size_t v = 0; v < columns; ++v) out[v] = *value++ * share;
        }
    }
}

// Reads blocks of boxes.
class BoxReader {
  public:
    BoxReader(std::shared_ptr<const RayVolume> fine, const glm::ivec3& boxes)
        : fine_(std::move(fine)), boxes_(boxes) {}

    void operator()(const CodeBlock& block, const BlockPlace& place) const {
        fillBlock(0, place);
        const glm::ivec3 first = block.position * boxes_;
        const glm::ivec3 size = 8 / boxes_;
        const int lastLayer = std::min(first.x + boxes_.x - 1, fine_->box.max.x >> 3);
        for (int layer = std::max(first.x, fine_->box.min.x >> 3); layer <= lastLayer; ++layer) {
            const std::span<const CodeBlock> blocks = fine_->layer(layer);
            for (int u = first.y; u < first.y + boxes_.y; ++u) {
                const auto isBefore = [&](const CodeBlock& one) {
                    return std::pair(one.position.y, one.position.z) < std::pair(u, first.z);
                };
                auto one = std::partition_point(blocks.begin(), blocks.end(), isBefore);
                for (; one != blocks.end() && one->position.y == u &&
                       one->position.z < first.z + boxes_.z;
                     ++one) {
                    const glm::ivec3 at = (one->position - first) * size;
                    writeMeans(*fine_, *one, boxes_,
                               {place.first + std::size_t(at.x) * place.sliceStep +
                                    std::size_t(at.y) * place.rowStep + at.z,
                                place.sliceStep, place.rowStep});
                }
            }
        }
    }

  private:
    std::shared_ptr<const RayVolume> fine_;
    glm::ivec3 boxes_;
};

}  // namespace

RayVolume coarsened(RayVolume volume, const glm::ivec3& boxes) {
    const auto fine = std::make_shared<const RayVolume>(std::move(volume));
    RayVolume coarse;
    coarse.box = {quotient(fine->box.min, boxes), quotient(fine->box.max, boxes)};
    coarse.sliceAxis = fine->sliceAxis;
    coarse.lowest = fine->lowest;
    coarse.highest = fine->highest;
    coarse.visible = fine->visible;
    std::vector<CodeBlock> blocks;
    const auto isSame = [](const CodeBlock& a, const CodeBlock& b) {
        return a.position == b.position;
    };
    for (const CodeBlock& block : fine->blocks) {
        const CodeBlock ofBoxes{quotient(block.position, boxes)};
        if (blocks.empty() || !isSame(blocks.back(), ofBoxes)) blocks.push_back(ofBoxes);
    }
    parallelSort(blocks, [](const CodeBlock& a, const CodeBlock& b) {
        return std::tuple(a.position.y, a.position.z, a.position.x) <
               std::tuple(b.position.y, b.position.z, b.position.x);
    });
    blocks.erase(std::unique(blocks.begin(), blocks.end(), isSame), blocks.end());
    coarse.takeBlocks(blocks);
    coarse.sourceValues = BoxReader(fine, boxes);
    return coarse;
}

glm::dmat4 indexFromBoxes(const glm::ivec3& boxes) {
    glm::dmat4 matrix(1);
    for (int axis = 0; axis < 3; ++axis) {
        matrix[axis][axis] = boxes[axis];
        matrix[3][axis] = 0.5 * (boxes[axis] - 1);
    }
    return matrix;
}

}  // namespace deltasplat
