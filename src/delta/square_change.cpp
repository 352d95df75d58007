// SPDX-License-Identifier: Apache-2.0
#include "delta/square_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "delta/class_index.h"
#include "deltasplat/view/factorization.h"
#include "floor_div.h"
#include "ingest/values/hash_place.h"
#include "parallel.h"
#include "run_begins.h"

namespace deltasplat {
namespace {

constexpr std::size_t kPatches = 192;
constexpr std::size_t kPlaces = std::size_t{1} << 20;  // that chance has

// Where columns of blocks are.
class ColumnFinder {
  public:
    explicit ColumnFinder(const std::vector<CodeBlock>& blocks)
        : blocks_(blocks), begins_(runBegins(blocks, shareColumn)) {
        for (std::size_t i = 0; i < count(); ++i) {
            const glm::ivec3& position = column(i).front().position;
            places_.emplace_back(position.y, position.z);
        }
    }

    std::size_t count() const { return begins_.size() - 1; }
    std::span<const CodeBlock> column(std::size_t i) const {
        return blocks_.subspan(begins_[i], begins_[i + 1] - begins_[i]);
    }
    // Returns the block at a place, or null.
    const CodeBlock* find(const glm::ivec3& position) const {
        const std::pair wanted(position.y, position.z);
        const auto place = std::lower_bound(places_.begin(), places_.end(), wanted);
        if (place == places_.end() || *place != wanted) return nullptr;
        const std::span<const CodeBlock> of = column(std::size_t(place - places_.begin()));
        const auto block = std::partition_point(of.begin(), of.end(), [&](const CodeBlock& one) {
            return one.position.x < position.x;
        });
        return block != of.end() && block->position.x == position.x ? &*block : nullptr;
    }

  private:
    std::span<const CodeBlock> blocks_;
    std::vector<std::size_t> begins_;
    std::vector<std::pair<int, int>> places_;  // u and v of columns
};

// Reads single voxels, most of which lie in blocks of those before.
class VoxelReader {
  public:
    VoxelReader(const ColumnFinder& columns, const ClassReader& classes)
        : columns_(columns), classes_(classes) {}

    // @param at  (slice, u, v)
    ClassIndex classOf(const glm::ivec3& at) {
        const glm::ivec3 position = at >> 3;
        // Neighbours along u and v have places of their own.
        Kept& kept = kept_[2 * std::size_t(position.y & 1) + std::size_t(position.z & 1)];
        if (kept.position != position) {
            kept.position = position;
            const CodeBlock* const block = columns_.find(position);
            kept.isThere = block != nullptr;
            if (block) classes_.read(*block, std::span(kept.classes));
        }
        const glm::ivec3 within = at & 7;
        return kept.isThere ? kept.classes[64 * std::size_t(within.x) + 8 * std::size_t(within.y) +
                                           std::size_t(within.z)]
                            : ClassIndex{0};
    }

  private:
    struct Kept {
        std::optional<glm::ivec3> position;
        bool isThere = false;
        std::array<ClassIndex, 512> classes;
    };

    const ColumnFinder& columns_;
    const ClassReader& classes_;
    std::array<Kept, 4> kept_;
};

// The slices that there are blocks of.
struct SliceRange {
    int first = std::numeric_limits<int>::max();
    int last = std::numeric_limits<int>::min();

    explicit SliceRange(const ColumnFinder& columns) {
        for (std::size_t i = 0; i < columns.count(); ++i) {
            first = std::min(first, 8 * columns.column(i).front().position.x);
            last = std::max(last, 8 * columns.column(i).back().position.x + 7);
        }
    }
};

// What lines of sight that lie beside each other see.
struct Sight {
    glm::dvec4 exact{0.0};    // the mean
    glm::dvec4 squares{0.0};  // where their voxels become one
};

class LineTracer {
  public:
    LineTracer(const ColumnFinder& columns, const ClassReader& classes,
               std::span<const glm::dvec4> lights, const JoinedSquares& squares,
               const SliceRange& range)
        : columns_(columns), classes_(classes), lights_(lights), squares_(squares), range_(range) {}

    // Returns what is seen by squares beside each other, about as many as a pixel averages at
    // least, one of which a voxel is in.
    Sight tracePatch(const glm::ivec3& through) const {
        const glm::ivec2 base = glm::ivec2(through.y, through.z) + movedAt(through.x);
        const glm::ivec2 first(floorDiv(base.x, squares_.within) * squares_.within,
                               floorDiv(base.y, squares_.within) * squares_.within);
        Sight patch;
        for (int u = 0; u < kBeside; ++u) {
            for (int v = 0; v < kBeside; ++v) {
                const Sight sight = trace(first + squares_.within * glm::ivec2(u, v));
                patch.exact += sight.exact / double(kBeside * kBeside);
                patch.squares += sight.squares / double(kBeside * kBeside);
            }
        }
        return patch;
    }

  private:
    static constexpr std::size_t kMostLines = kMostJoinedWithin * kMostJoinedWithin;
    static constexpr double kLeast = 0x1p-12;
    static constexpr int kBeside = 2;
    using Lines = std::array<glm::dvec4, kMostLines>;

    // Returns what is seen along the lines of a square.
    Sight trace(const glm::ivec2& first) const {
        VoxelReader voxels(columns_, classes_);
        Lines all{};
        Sight sight;
        const int firstSlab = floorDiv(range_.first, squares_.slices);
        const int count = floorDiv(range_.last, squares_.slices) - firstSlab + 1;
        for (int i = 0; i < count; ++i) {
            const int slab = firstSlab + (squares_.lastInFront ? count - 1 - i : i);
            Lines some{};
            for (int k = 0; k < squares_.slices; ++k) {
                const int slice = squares_.lastInFront ? squares_.slices - 1 - k : k;
                pass(slab * squares_.slices + slice, first, voxels, some);
            }
            for (std::size_t line = 0; line < lineCount(); ++line) addBehind(some[line], all[line]);
            addBehind(mean(some), sight.squares);
            sight.exact = mean(all);
            // More would make no difference.
            if (std::min(sight.exact.a, sight.squares.a) > 1 - kLeast) break;
        }
        return sight;
    }

    std::size_t lineCount() const {
        return std::size_t(squares_.within) * std::size_t(squares_.within);
    }
    // By how many voxels a slice lies beside its place on the base plane.
    glm::ivec2 movedAt(int slice) const {
        return glm::ivec2(glm::floor(double(slice) * squares_.shiftPerSlice + 0.5));
    }
    static void addBehind(const glm::dvec4& light, glm::dvec4& sum) { sum += (1 - sum.a) * light; }
    glm::dvec4 mean(const Lines& lines) const {
        glm::dvec4 sum(0.0);
        for (std::size_t line = 0; line < lineCount(); ++line) sum += lines[line];
        return sum / double(lineCount());
    }
    // Lets lines from `first` on pass a slice.
    void pass(int slice, const glm::ivec2& first, VoxelReader& voxels, Lines& lines) const {
        const glm::ivec2 place = first - movedAt(slice);
        for (std::size_t line = 0; line < lineCount(); ++line) {
            const glm::ivec2 beside(int(line) / squares_.within, int(line) % squares_.within);
            const ClassIndex seen = voxels.classOf({slice, place + beside});
            if (seen != 0) addBehind(lights_[seen], lines[line]);
        }
    }

    const ColumnFinder& columns_;
    const ClassReader& classes_;
    std::span<const glm::dvec4> lights_;
    const JoinedSquares& squares_;
    SliceRange range_;
};

// Returns a voxel of a block that is seen, one of all at random; empty: there is none.
std::optional<glm::ivec3> anySeen(const CodeBlock& block, const ClassReader& classes,
                                  std::size_t random) {
    std::array<ClassIndex, 512> all;
    classes.read(block, std::span(all));
    const auto isSeen = [](ClassIndex one) { return one != 0; };
    const auto count = std::size_t(std::count_if(all.begin(), all.end(), isSeen));
    if (count == 0) return {};
    std::size_t rest = random % count;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i] != 0 && rest-- == 0)
            return 8 * block.position + glm::ivec3(int(i / 64), int(i / 8 % 8), int(i % 8));
    }
    return {};
}

double largestOf(const glm::dvec4& light) {
    return std::max({light.r, light.g, light.b, light.a});
}

}  // namespace

std::optional<SquareChange> squareChange(const std::vector<CodeBlock>& blocks,
                                         const ClassReader& classes,
                                         std::span<const glm::dvec4> lights,
                                         const JoinedSquares& squares) {
    if (blocks.empty()) return {};
    const ColumnFinder columns(blocks);
    constexpr int kMostSlices = 8192;
    const SliceRange range(columns);
    if (double(range.last) - range.first >= kMostSlices) return {};
    const LineTracer tracer(columns, classes, lights, squares, range);
    std::vector<std::optional<Sight>> patches(kPatches);
    parallelFor(kPatches, [&](std::size_t i) {
        // From every part of the volume as many as it has blocks.
        const std::size_t place = hashPlace(i + 1, kPlaces);
        const double at = (double(i) + double(place) / kPlaces) / kPatches;
        const auto block = std::size_t(at * double(blocks.size()));
        const std::optional<glm::ivec3> voxel = anySeen(blocks[block], classes, place);
        if (voxel) patches[i] = tracer.tracePatch(*voxel);
    });
    glm::dvec4 gained(0.0);
    glm::dvec4 squared(0.0);
    glm::dvec4 seen(0.0);
    double most = 0;
    double count = 0;
    for (const std::optional<Sight>& sight : patches) {
        if (!sight) continue;
        const glm::dvec4 change = sight->squares - sight->exact;
        gained += change;
        squared += change * change;
        seen += sight->exact;
        most = std::max(most, largestOf(sight->exact));
        ++count;
    }
    // Of too few, nothing is known.
    if (4 * count < kPatches || !(most > 0)) return {};
    SquareChange result;
    for (int c = 0; c < 4; ++c) {
        const double share = gained[c] / largestOf(seen);
        if (std::abs(share) > std::abs(result.gained)) result.gained = share;
    }
    result.rms = std::sqrt(largestOf(squared) / count) / most;
    return result;
}

}  // namespace deltasplat
