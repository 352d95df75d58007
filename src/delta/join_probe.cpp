// SPDX-License-Identifier: Apache-2.0
#include "delta/join_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <utility>

#include "delta/class_index.h"
#include "delta/class_reader.h"
#include "floor_div.h"
#include "ingest/codes/leaf_slices.h"
#include "parallel.h"
#include "run_begins.h"

namespace deltasplat {
namespace {

constexpr int kSlabsBeside = 16;  // before and behind what lines of sight are seen at
constexpr int kTries = 8;         // to find each
constexpr int kSquares = 4;       // of a patch, along u and along v, that voxels become
constexpr int kMostLines = kSquares * kMostJoinedWithin;
constexpr double kOpaque = 1 - 0x1p-10;  // what is behind makes no difference

// What the lines of a patch see, on average.
struct Seen {
    glm::dvec4 single{0.0};  // of voxels as they are
    glm::dvec4 joined{0.0};
};

void addBehind(const glm::dvec4& light, glm::dvec4& sum) {
    sum += (1 - sum.a) * light;
}

double largestOf(const glm::dvec4& light) {
    return std::max({light.r, light.g, light.b, light.a});
}

// Returns a voxel (slice, u, v) of a block that is seen, one of all at random; empty: there is
// none.
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

// First and last of some numbers.
struct Range {
    int first;
    int last;
};

}  // namespace

// Eight slices of what lies about lines of sight: of each block few voxels are read.
class JoinProbe::Layer {
  public:
    // @param sliceAxis  of the slices, whichever way blocks are listed
    Layer(const JoinProbe& probe, int sliceAxis)
        : probe_(probe),
          sliceAxis_(sliceAxis),
          leafStrides_(toSliceOrder(kLeafStride, sliceAxis)),
          slotStrides_(toSliceOrder(fromSliceOrder({64, 8, 1}, probe.sliceAxis_), sliceAxis)) {}

    // Finds the blocks of slices from 8 * number on that have voxels (u, v) from `first` to `last`.
    // Returns whether there are any.
    bool find(int number, const glm::ivec2& first, const glm::ivec2& last) {
        first_ = first >> 3;
        size_ = (last >> 3) - first_ + 1;
        blocks_.resize(std::size_t(size_.x) * std::size_t(size_.y));
        bool hasAny = false;
        for (int u = 0; u < size_.x; ++u) {
            for (int v = 0; v < size_.y; ++v) {
                const glm::ivec3 position(number, first_ + glm::ivec2(u, v));
                const CodeBlock* const block = probe_.find(
                    toSliceOrder(fromSliceOrder(position, sliceAxis_), probe_.sliceAxis_));
                blocks_[placeOf({u, v})] = block;
                hasAny = hasAny || block;
            }
        }
        return hasAny;
    }

    // @param at  (slice, u, v), of a block that was looked for
    ClassIndex classOf(const glm::ivec3& at) const {
        const CodeBlock* const block = blocks_[placeOf(glm::ivec2(at.y >> 3, at.z >> 3) - first_)];
        if (!block) return 0;
        const glm::ivec3 within = at & 7;
        if (block->leaf) {
            const openvdb::Index n = indexOf(within, leafStrides_);
            if (!block->leaf->getValueMask().isOn(n)) return 0;
            return ClassIndex(
                probe_.classOfSlot_[std::size_t(block->leaf->buffer().data()[n]) + 1]);
        }
        if (block->slots)
            return ClassIndex(probe_.classOfSlot_[block->slots[indexOf(within, slotStrides_)]]);
        return ClassIndex(block->tileSlot);
    }

  private:
    static openvdb::Index indexOf(const glm::ivec3& within, const glm::ivec3& strides) {
        const glm::ivec3 steps = within * strides;
        return openvdb::Index(steps.x + steps.y + steps.z);
    }
    std::size_t placeOf(const glm::ivec2& at) const {
        return std::size_t(at.x) * std::size_t(size_.y) + std::size_t(at.y);
    }

    const JoinProbe& probe_;
    int sliceAxis_;
    glm::ivec3 leafStrides_;  // from voxel to voxel of a block, along the slices, u and v
    glm::ivec3 slotStrides_;
    glm::ivec2 first_{0};
    glm::ivec2 size_{0};
    std::vector<const CodeBlock*> blocks_;
};

// Follows the lines of sight of one patch from the front on.
class JoinProbe::Tracer {
  public:
    // @param through  voxel (slice, u, v) that one of the lines passes
    // @param part     where in the patch, 0 to 1 each
    Tracer(const JoinProbe& probe, std::span<const glm::dvec4> lights, const SightLines& lines,
           const JoinedVoxels& joined, const glm::ivec3& through, const glm::dvec2& part)
        : lights_(lights),
          lines_(lines),
          joined_(joined),
          count_(kSquares * joined.within),
          slants_(joinedSlants(lines.shiftPerSlice, joined.slices, joined.within).slants),
          middle_(middleOfJoined(lines.shiftPerSlice,
                                 std::span(slants_).first(std::size_t(joined.slices)))),
          layer_(probe, lines.sliceAxis) {
        // What the voxel becomes a part of lies in the patch as well.
        const double beside = joined.within;
        const glm::dvec2 first = glm::dvec2(through.y, through.z) +
                                 double(through.x) * lines.shiftPerSlice -
                                 (beside + (count_ - 2 * beside) * part);
        for (int i = 0; i < count_; ++i) linesAt_.push_back(first + (i + 0.5));
        const auto ordered = [&](const glm::ivec3& at) {
            return toSliceOrder(fromSliceOrder(at, probe.sliceAxis_), lines.sliceAxis);
        };
        slices_ = slicesWithin(8 * ordered(probe.first_), 8 * ordered(probe.last_) + 7);
        // What goes on for longer shows no more of it.
        const int most = kSlabsBeside * joined.slices;
        slices_ = {std::max(slices_.first, through.x - most),
                   std::min(slices_.last, through.x + most)};
    }

    Seen trace() {
        const int firstSlab = floorDiv(slices_.first, joined_.slices);
        const int count = floorDiv(slices_.last, joined_.slices) - firstSlab + 1;
        for (int i = 0; i < count; ++i) {
            passSlab(firstSlab + (lines_.frontToBack ? i : count - 1 - i));
            if (std::min(meanOf(single_).a, meanOf(joinedSeen_).a) > kOpaque) break;
        }
        return {meanOf(single_), meanOf(joinedSeen_)};
    }

  private:
    template <typename T>
    using OfLines = std::array<std::array<T, kMostLines>, kMostLines>;
    using OfSquare = std::array<glm::dvec4, kMostJoinedWithin * kMostJoinedWithin>;

    glm::dvec4 meanOf(const OfLines<glm::dvec4>& lines) const {
        glm::dvec4 sum(0.0);
        for (int u = 0; u < count_; ++u)
            for (int v = 0; v < count_; ++v) sum += lines[u][v];
        return sum / double(count_ * count_);
    }

    // How far beside a line lies what is read for it.
    int reach() const { return joined_.within + 1; }

    // Returns the slices in which lines pass voxels from `first` to `last`, (slice, u, v).
    Range slicesWithin(const glm::ivec3& first, const glm::ivec3& last) const {
        double least = first.x, most = last.x;
        for (int axis = 0; axis < 2; ++axis) {
            const double shift = lines_.shiftPerSlice[axis];
            if (std::abs(shift) < 1e-9) continue;
            const double to = (linesAt_.front()[axis] - (last[axis + 1] + reach())) / shift;
            const double from = (linesAt_.back()[axis] - (first[axis + 1] - reach())) / shift;
            least = std::max(least, std::min(from, to));
            most = std::min(most, std::max(from, to));
        }
        return {int(std::floor(least)), int(std::ceil(std::max(most, least)))};
    }

    // Makes the layer that a slice lies in the one that is read. Returns whether it has anything.
    bool enter(int slice) {
        const int number = slice >> 3;
        if (number == number_) return hasAny_;
        number_ = number;
        const glm::dvec2 near = -double(8 * number) * lines_.shiftPerSlice;
        const glm::dvec2 far = -double(8 * number + 7) * lines_.shiftPerSlice;
        const glm::ivec2 first(glm::floor(linesAt_.front() + glm::min(near, far)));
        const glm::ivec2 last(glm::ceil(linesAt_.back() + glm::max(near, far)));
        hasAny_ = layer_.find(number, first - reach(), last + reach());
        return hasAny_;
    }

    void passSlab(int slab) {
        bool hasAny = false;
        for (int i = 0; i < joined_.slices; ++i) {
            const int of = lines_.frontToBack ? i : joined_.slices - 1 - i;
            const int slice = slab * joined_.slices + of;
            if (!enter(slice)) continue;
            if (!hasAny) beginSquares(slab * joined_.slices);
            hasAny = true;
            passLines(slice);
            passSquares(slice, slants_[std::size_t(of)]);
        }
        if (hasAny) endSquares();
    }

    void passLines(int slice) {
        std::array<glm::ivec2, kMostLines> at;
        for (int i = 0; i < count_; ++i) at[i] = voxelAt(linesAt_[i], slice);
        for (int u = 0; u < count_; ++u) {
            for (int v = 0; v < count_; ++v) {
                const ClassIndex seen = layer_.classOf({slice, at[u].x, at[v].y});
                if (seen != 0) addBehind(lights_[seen], single_[u][v]);
            }
        }
    }

    glm::ivec2 voxelAt(const glm::dvec2& line, int slice) const {
        return glm::ivec2(glm::floor(line - double(slice) * lines_.shiftPerSlice + 0.5));
    }

    // Finds the squares of a slab that lines pass: of two that pass one, the first has it.
    void beginSquares(int firstSlice) {
        for (int i = 0; i < count_; ++i) {
            const glm::ivec2 voxel = voxelAt(linesAt_[i] - middle_, firstSlice);
            for (int axis = 0; axis < 2; ++axis) {
                squares_[i][axis] = floorDiv(voxel[axis], joined_.within) * joined_.within;
                const bool isNew = i == 0 || squares_[i][axis] != squares_[i - 1][axis];
                squareOf_[i][axis] = isNew ? i : squareOf_[i - 1][axis];
            }
        }
        for (auto& row : slab_)
            for (OfSquare& square : row) square.fill(glm::dvec4(0.0));
    }

    template <typename Use>
    void forSquares(const Use& use) {
        for (int u = 0; u < count_; ++u) {
            if (squareOf_[u].x != u) continue;
            for (int v = 0; v < count_; ++v)
                if (squareOf_[v].y == v) use(u, v);
        }
    }

    void passSquares(int slice, const glm::ivec2& slant) {
        forSquares([&](int u, int v) {
            const glm::ivec2 first = glm::ivec2(squares_[u].x, squares_[v].y) - slant;
            for (int i = 0; i < joined_.within * joined_.within; ++i) {
                const glm::ivec2 beside(i / joined_.within, i % joined_.within);
                const ClassIndex seen = layer_.classOf({slice, first + beside});
                if (seen != 0) addBehind(lights_[seen], slab_[u][v][std::size_t(i)]);
            }
        });
    }

    void endSquares() {
        OfLines<glm::dvec4> means;
        forSquares([&](int u, int v) {
            glm::dvec4 sum(0.0);
            for (const glm::dvec4& light : slab_[u][v]) sum += light;
            means[u][v] = sum / double(joined_.within * joined_.within);
        });
        for (int u = 0; u < count_; ++u)
            for (int v = 0; v < count_; ++v)
                addBehind(means[squareOf_[u].x][squareOf_[v].y], joinedSeen_[u][v]);
    }

    std::span<const glm::dvec4> lights_;
    SightLines lines_;
    JoinedVoxels joined_;
    int count_;  // of lines along u and along v, a voxel from each other
    std::array<glm::ivec2, kMostJoined> slants_;
    glm::dvec2 middle_;
    Layer layer_;
    Range slices_{0, 0};
    std::vector<glm::dvec2> linesAt_;  // on the base plane
    int number_ = std::numeric_limits<int>::min();
    bool hasAny_ = false;
    OfLines<glm::dvec4> single_{};
    OfLines<glm::dvec4> joinedSeen_{};
    std::array<glm::ivec2, kMostLines> squares_{};  // first voxel of those of a slab
    std::array<glm::ivec2, kMostLines>
        squareOf_{};  // the first line that passes the same, along u, v
    OfLines<OfSquare> slab_{};
};

JoinProbe::JoinProbe(std::vector<CodeBlock> blocks, int sliceAxis,
                     std::span<const Slot> classOfSlot)
    : blocks_(std::move(blocks)),
      sliceAxis_(sliceAxis),
      classOfSlot_(classOfSlot.begin(), classOfSlot.end()),
      begins_(runBegins(blocks_, shareColumn)) {
    if (blocks_.empty()) return;
    first_ = last_ = blocks_.front().position;
    for (const CodeBlock& block : blocks_) {
        first_ = glm::min(first_, block.position);
        last_ = glm::max(last_, block.position);
    }
    columns_.reserve(begins_.size() - 1);
    for (std::size_t i = 0; i + 1 < begins_.size(); ++i) {
        const glm::ivec3& position = blocks_[begins_[i]].position;
        columns_.emplace_back(position.y, position.z);
    }
}

// Returns the block at a place, or null.
const CodeBlock* JoinProbe::find(const glm::ivec3& position) const {
    const std::pair wanted(position.y, position.z);
    const auto place = std::lower_bound(columns_.begin(), columns_.end(), wanted);
    if (place == columns_.end() || *place != wanted) return nullptr;
    const auto i = std::size_t(place - columns_.begin());
    const std::span column = std::span(blocks_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
    const auto block =
        std::partition_point(column.begin(), column.end(),
                             [&](const CodeBlock& one) { return one.position.x < position.x; });
    return block != column.end() && block->position.x == position.x ? &*block : nullptr;
}

std::optional<JoinedChange> JoinProbe::change(const JoinedVoxels& joined, const LinesThrough& lines,
                                              std::span<const glm::dvec4> lights) const {
    if (blocks_.empty()) return {};
    const ClassReader classes(classOfSlot_, nullptr, sliceAxis_);
    // As many lines of sight of large patches as of small ones would take as much longer.
    const std::size_t count = joined.within < 4 ? 192 : 64;
    std::vector<std::optional<Seen>> patches(count);
    parallelFor(count, [&](std::size_t i) {
        // From every part of the volume as many as it has blocks.
        std::mt19937 random{std::mt19937::result_type(i)};
        const auto part = [&] { return double(random()) * 0x1p-32; };
        for (int tried = 0; tried < kTries && !patches[i]; ++tried) {
            const double at = (double(i) + part()) / double(count);
            const CodeBlock& block = blocks_[std::size_t(at * double(blocks_.size()))];
            const std::optional<glm::ivec3> voxel = anySeen(block, classes, random());
            if (!voxel) continue;
            const glm::ivec3 xyz = fromSliceOrder(*voxel, sliceAxis_);
            const SightLines seenBy = lines(xyz);
            const glm::dvec2 within(part(), part());
            patches[i] =
                Tracer(*this, lights, seenBy, joined, toSliceOrder(xyz, seenBy.sliceAxis), within)
                    .trace();
        }
    });
    glm::dvec4 gained(0.0);
    glm::dvec4 squared(0.0);
    glm::dvec4 seen(0.0);
    double most = 0;
    double found = 0;
    for (const std::optional<Seen>& patch : patches) {
        if (!patch) continue;
        const glm::dvec4 change = patch->joined - patch->single;
        gained += change;
        squared += change * change;
        seen += patch->single;
        most = std::max(most, largestOf(patch->single));
        ++found;
    }
    // Of too few, nothing is known.
    if (4 * found < double(count) || !(most > 0)) return {};
    JoinedChange result;
    for (int c = 0; c < 4; ++c) {
        const double share = gained[c] / largestOf(seen);
        if (std::abs(share) <= std::abs(result.gained)) continue;
        result.gained = share;
        const double ofMean = std::max(0.0, squared[c] - gained[c] * gained[c] / found);
        result.gainedError = std::sqrt(ofMean) / largestOf(seen);
    }
    result.rms = std::sqrt(largestOf(squared) / found) / most;
    return result;
}

}  // namespace deltasplat
