// SPDX-License-Identifier: Apache-2.0
#include "delta/joined_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "delta/class_index.h"
#include "deltasplat/view/factorization.h"
#include "floor_div.h"
#include "parallel.h"
#include "run_begins.h"

namespace deltasplat {
namespace {

constexpr std::size_t kLines = 256;

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
        Kept& kept = kept_[std::size_t(2 * (position.y & 1) + (position.z & 1))];
        if (kept.position != position) {
            kept.position = position;
            const CodeBlock* const block = columns_.find(position);
            kept.isThere = block != nullptr;
            if (block) classes_.read(*block, std::span(kept.classes));
        }
        const glm::ivec3 within = at & 7;
        return kept.isThere ? kept.classes[std::size_t(64 * within.x + 8 * within.y + within.z)]
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

// What blocks cover: slices, and the base plane.
struct Bounds {
    int firstSlice = std::numeric_limits<int>::max();
    int lastSlice = std::numeric_limits<int>::min();
    glm::dvec2 min{std::numeric_limits<double>::infinity()};
    glm::dvec2 max{-std::numeric_limits<double>::infinity()};

    Bounds(const ColumnFinder& columns, const glm::dvec2& shiftPerSlice) {
        for (std::size_t i = 0; i < columns.count(); ++i) {
            for (const CodeBlock& block : {columns.column(i).front(), columns.column(i).back()}) {
                const glm::ivec3 first = 8 * block.position;
                firstSlice = std::min(firstSlice, first.x);
                lastSlice = std::max(lastSlice, first.x + 7);
                for (const int slice : {first.x, first.x + 7}) {
                    const glm::dvec2 place =
                        glm::dvec2(first.y, first.z) + double(slice) * shiftPerSlice;
                    min = glm::min(min, place);
                    max = glm::max(max, place + 8.0);
                }
            }
        }
    }
};

// What lines of sight that lie beside each other let through.
struct Transmittance {
    double exact = 1;    // the mean
    double squares = 1;  // where their voxels become one
};

class LineTracer {
  public:
    LineTracer(const ColumnFinder& columns, const ClassReader& classes,
               std::span<const double> alphas, const JoinedSquares& squares)
        : columns_(columns),
          classes_(classes),
          alphas_(alphas),
          squares_(squares),
          bounds_(columns, squares.shiftPerSlice) {}

    // Returns what lines from a place of the volume on the base plane let through, 0 to 1 each way.
    Transmittance trace(const glm::dvec2& share) const {
        const glm::ivec2 place(glm::floor(glm::mix(bounds_.min, bounds_.max, share)));
        const glm::ivec2 first(floorDiv(place.x, squares_.within) * squares_.within,
                               floorDiv(place.y, squares_.within) * squares_.within);
        VoxelReader voxels(columns_, classes_);
        std::array<double, kMostLines> all;
        all.fill(1);
        Transmittance through;
        for (int slice = floorDiv(bounds_.firstSlice, squares_.slices) * squares_.slices;
             slice <= bounds_.lastSlice; slice += squares_.slices) {
            std::array<double, kMostLines> some;
            some.fill(1);
            for (int i = 0; i < squares_.slices; ++i) pass(slice + i, first, voxels, some);
            for (std::size_t line = 0; line < lineCount(); ++line) all[line] *= some[line];
            through.squares *= mean(some);
            through.exact = mean(all);
            // More would make no difference.
            if (std::max(through.exact, through.squares) < kLeast) break;
        }
        return through;
    }

  private:
    static constexpr std::size_t kMostLines = kMostJoinedWithin * kMostJoinedWithin;
    static constexpr double kLeast = 0x1p-12;

    std::size_t lineCount() const { return std::size_t(squares_.within * squares_.within); }
    double mean(const std::array<double, kMostLines>& lines) const {
        double sum = 0;
        for (std::size_t line = 0; line < lineCount(); ++line) sum += lines[line];
        return sum / double(lineCount());
    }
    // Lets lines from `first` on pass a slice.
    void pass(int slice, const glm::ivec2& first, VoxelReader& voxels,
              std::array<double, kMostLines>& lines) const {
        const glm::ivec2 moved(glm::floor(double(slice) * squares_.shiftPerSlice + 0.5));
        for (std::size_t line = 0; line < lineCount(); ++line) {
            const glm::ivec2 beside(int(line) / squares_.within, int(line) % squares_.within);
            const ClassIndex seen = voxels.classOf({slice, first - moved + beside});
            if (seen != 0) lines[line] *= 1 - alphas_[seen];
        }
    }

    const ColumnFinder& columns_;
    const ClassReader& classes_;
    std::span<const double> alphas_;
    const JoinedSquares& squares_;
    Bounds bounds_;
};

}  // namespace

DensityChange densityChange(const std::vector<CodeBlock>& blocks, const ClassReader& classes,
                            std::span<const double> alphas, const JoinedSquares& squares) {
    DensityChange change;
    if (blocks.empty()) return change;
    const ColumnFinder columns(blocks);
    const LineTracer tracer(columns, classes, alphas, squares);
    std::vector<Transmittance> lines(kLines);
    parallelFor(kLines, [&](std::size_t i) {
        // The powers of 1 / x, x^3 = x + 1: even over a square.
        const glm::dvec2 place =
            0.5 + double(i) * glm::dvec2(0.75487766624669276, 0.56984029099805327);
        lines[i] = tracer.trace(glm::fract(place));
    });
    double seen = 0;
    for (const Transmittance& through : lines) {
        const double gained = through.exact - through.squares;
        change.gained += gained;
        change.rms += gained * gained;
        seen += 1 - through.exact;
    }
    change.rms = std::sqrt(change.rms / kLines);
    if (seen > 0) change.gained /= seen;
    return change;
}

}  // namespace deltasplat
