// SPDX-License-Identifier: Apache-2.0
#include "words/join_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <random>
#include <utility>

#include "base/bits.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "volume/code_math.h"
#include "volume/leaf_slices.h"
#include "words/class_reader.h"

namespace deltasplat {
namespace {

constexpr int kSlabsBeside = 16;         // slabs before and behind the patch
constexpr int kTries = 64;               // per patch
constexpr int kSquares = 5;              // joined voxels of a patch, along u and v
constexpr double kOpaque = 1 - 0x1p-10;  // hides everything behind

// Mean light of a patch's lines.
struct Seen {
    glm::dvec4 single{0.0};  // of separate voxels
    glm::dvec4 joined{0.0};
};

void addBehind(const glm::dvec4& light, glm::dvec4& sum) {
    sum += (1 - sum.a) * light;
}

double largestOf(const glm::dvec4& light) {
    return std::max({light.r, light.g, light.b, light.a});
}

// Returns a random visible voxel (slice, u, v) of a block, if there is one.
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

struct Range {
    int first;
    int last;
};

}  // namespace

// Eight slices around lines of sight. Reads single voxels, because few per block are needed.
class JoinProbe::Layer {
  public:
    // @param sliceAxis  of the lines; blocks may be listed along another
    Layer(const JoinProbe& probe, int sliceAxis)
        : probe_(probe),
          sliceAxis_(sliceAxis),
          leafStrides_(toSliceOrder(kLeafStride, sliceAxis)),
          slotStrides_(toSliceOrder(fromSliceOrder({64, 8, 1}, probe.sliceAxis_), sliceAxis)) {}

    // Finds layer `number`'s blocks at (u, v) from `first` to `last`. Returns whether any exist.
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

    // @param at  (slice, u, v) in a block of find()
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
    glm::ivec3 leafStrides_;  // of a leaf's voxels along the slices, u and v
    glm::ivec3 slotStrides_;
    glm::ivec2 first_{0};
    glm::ivec2 size_{0};
    std::vector<const CodeBlock*> blocks_;
};

// Follows a patch's lines of sight from the front: pixels one voxel apart, and squares.
class JoinProbe::Tracer {
  public:
    // @param through  voxel (slice, u, v) in the patch
    // @param part     place of the voxel in the patch, 0 to 1 each
    Tracer(const JoinProbe& probe, const SightLines& lines, const JoinedVoxels& joined,
           const glm::ivec3& through, const glm::dvec2& part)
        : lines_(lines),
          joined_(joined),
          slants_(joinedSlants(lines.shiftPerSlice, joined.slices, joined.within).slants),
          layer_(probe, lines.sliceAxis),
          single_(kSquares * joined.within),
          squares_(kSquares + 1) {
        // Keeps the voxel's joined square inside of the patch.
        constexpr double kBeside = 1.5;
        const glm::dvec2 base =
            glm::dvec2(through.y, through.z) + double(through.x) * lines.shiftPerSlice;
        const glm::dvec2 first =
            base / double(joined.within) - (kBeside + (kSquares - 2 * kBeside) * part);
        firstSquare_ = glm::floor(first + 0.5);
        // Joined squares are shifted against the patch, so those at both ends count in part.
        const glm::dvec2 moved =
            middleOfJoined(lines.shiftPerSlice,
                           std::span(slants_).first(std::size_t(joined.slices))) /
            double(joined.within);
        for (int axis = 0; axis < 2; ++axis) {
            squaresBefore_[axis] = moved[axis] > 0 ? 1 : 0;
            partOfFirst_[axis] = moved[axis] > 0 ? moved[axis] : 1 + moved[axis];
        }
        const auto ordered = [&](const glm::ivec3& at) {
            return toSliceOrder(fromSliceOrder(at, probe.sliceAxis_), lines.sliceAxis);
        };
        slices_ = slicesWithin(8 * ordered(probe.first_), 8 * ordered(probe.last_) + 7);
        // Longer structures show no larger effect.
        const int most = kSlabsBeside * joined.slices;
        slices_ = {std::max(slices_.first, through.x - most),
                   std::min(slices_.last, through.x + most)};
    }

    Seen trace() {
        const int firstSlab = floorDiv(slices_.first, joined_.slices);
        const int count = floorDiv(slices_.last, joined_.slices) - firstSlab + 1;
        for (int i = 0; i < count; ++i) {
            passSlab(firstSlab + (lines_.frontToBack ? i : count - 1 - i));
            if (std::min(meanOf(single_.seen).a, meanOfSquares().a) > kOpaque) break;
        }
        return {meanOf(single_.seen), meanOfSquares()};
    }

  private:
    using Lights = std::vector<glm::dvec4>;

    // Neighbouring lines, as far apart as the voxels that they read.
    struct Lines {
        explicit Lines(int ofAxis)
            : count(std::size_t(ofAxis)), sheet(pitch() * pitch()), seen(count * count) {}

        std::size_t pitch() const { return count + 1; }
        // Moves the lines through a sheet, with bilinear interpolation.
        // @param part  position between two voxels
        void pass(const glm::dvec2& part) {
            for (std::size_t u = 0; u < count; ++u) {
                for (std::size_t v = 0; v < count; ++v) {
                    const glm::dvec4* const at = &sheet[u * pitch() + v];
                    const glm::dvec4* const behind = at + pitch();
                    const glm::dvec4 light =
                        (1 - part.x) * ((1 - part.y) * at[0] + part.y * at[1]) +
                        part.x * ((1 - part.y) * behind[0] + part.y * behind[1]);
                    addBehind(light, seen[u * count + v]);
                }
            }
        }

        std::size_t count;  // per axis
        Lights sheet;       // [u][v], one more per axis than lines
        Lights seen;        // [u][v]
    };

    static glm::dvec4 meanOf(std::span<const glm::dvec4> lights) {
        glm::dvec4 sum(0.0);
        for (const glm::dvec4& light : lights) sum += light;
        return sum / double(lights.size());
    }

    // Mean within the patch only.
    glm::dvec4 meanOfSquares() const {
        const auto partOf = [&](std::size_t i, int axis) {
            return i == 0 ? partOfFirst_[axis] : i == kSquares ? 1 - partOfFirst_[axis] : 1.0;
        };
        glm::dvec4 sum(0.0);
        for (std::size_t u = 0; u < squares_.count; ++u)
            for (std::size_t v = 0; v < squares_.count; ++v)
                sum += partOf(u, 0) * partOf(v, 1) * squares_.seen[u * squares_.count + v];
        return sum / double(kSquares * kSquares);
    }

    glm::dvec2 firstLine() const { return double(joined_.within) * firstSquare_; }
    glm::dvec2 lastLine() const { return firstLine() + double(kSquares * joined_.within); }
    int reach() const { return 3 * joined_.within; }

    // Returns the slices in which the lines cross voxels `first` to `last`, (slice, u, v).
    Range slicesWithin(const glm::ivec3& first, const glm::ivec3& last) const {
        double least = first.x, most = last.x;
        for (int axis = 0; axis < 2; ++axis) {
            const double shift = lines_.shiftPerSlice[axis];
            if (std::abs(shift) < 1e-9) continue;
            const double to = (firstLine()[axis] - (last[axis + 1] + reach())) / shift;
            const double from = (lastLine()[axis] - (first[axis + 1] - reach())) / shift;
            least = std::max(least, std::min(from, to));
            most = std::min(most, std::max(from, to));
        }
        return {int(std::floor(least)), int(std::ceil(std::max(most, least)))};
    }

    // Reads the layer of a slice. Returns whether it has voxels.
    bool enter(int slice) {
        const int number = slice >> 3;
        if (number == number_) return hasAny_;
        number_ = number;
        const glm::dvec2 near = -double(8 * number) * lines_.shiftPerSlice;
        const glm::dvec2 far = -double(8 * number + 7) * lines_.shiftPerSlice;
        const glm::ivec2 first(glm::floor(firstLine() + glm::min(near, far)));
        const glm::ivec2 last(glm::ceil(lastLine() + glm::max(near, far)));
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
            joinSlice(slice, slants_[std::size_t(of)]);
        }
        if (hasAny) passSquares();
    }

    glm::dvec4 lightOf(const glm::ivec3& voxel) const {
        const ClassIndex seen = layer_.classOf(voxel);
        return seen == 0 ? glm::dvec4(0.0) : lines_.lights[seen];
    }

    void passLines(int slice) {
        const glm::dvec2 at = firstLine() - double(slice) * lines_.shiftPerSlice;
        const glm::dvec2 whole = glm::floor(at);
        const glm::ivec2 first(whole);
        bool hasAny = false;
        glm::dvec4* light = single_.sheet.data();
        for (int u = 0; u < int(single_.pitch()); ++u) {
            for (int v = 0; v < int(single_.pitch()); ++v, ++light) {
                *light = lightOf({slice, first.x + u, first.y + v});
                hasAny = hasAny || light->a > 0;
            }
        }
        if (hasAny) single_.pass(at - whole);
    }

    void beginSquares(int firstSlice) {
        const glm::dvec2 at = firstSquare_ - squaresBefore_ -
                              double(firstSlice) / joined_.within * lines_.shiftPerSlice;
        const glm::dvec2 whole = glm::floor(at);
        squaresAt_ = glm::ivec2(whole);
        squaresPart_ = at - whole;
        slab_.assign(squares_.sheet.size() * voxelsOfSquare(), glm::dvec4(0.0));
    }

    std::size_t voxelsOfSquare() const {
        return std::size_t(joined_.within) * std::size_t(joined_.within);
    }

    // Puts a slice behind the slices that are joined with it.
    void joinSlice(int slice, const glm::ivec2& slant) {
        const int within = joined_.within;
        const glm::ivec2 first = within * squaresAt_ - slant;
        glm::dvec4* light = slab_.data();
        for (int u = 0; u < int(squares_.pitch()); ++u) {
            for (int v = 0; v < int(squares_.pitch()); ++v) {
                const glm::ivec2 square = first + within * glm::ivec2(u, v);
                for (int i = 0; i < within; ++i)
                    for (int k = 0; k < within; ++k)
                        addBehind(lightOf({slice, square + glm::ivec2(i, k)}), *light++);
            }
        }
    }

    void passSquares() {
        const std::size_t voxels = voxelsOfSquare();
        for (std::size_t i = 0; i < squares_.sheet.size(); ++i)
            squares_.sheet[i] = meanOf(std::span(slab_).subspan(i * voxels, voxels));
        squares_.pass(squaresPart_);
    }

    SightLines lines_;
    JoinedVoxels joined_;
    std::array<glm::ivec2, kMostJoined> slants_;
    Layer layer_;
    glm::dvec2 firstSquare_{0.0};  // whole position on the base plane
    glm::dvec2 squaresBefore_{0.0};
    glm::dvec2 partOfFirst_{0.0};  // share of the first squares inside of the patch
    Range slices_{0, 0};
    int number_ = std::numeric_limits<int>::min();  // of the layer
    bool hasAny_ = false;
    Lines single_;
    Lines squares_;
    glm::ivec2 squaresAt_{0};  // first square of the slab
    glm::dvec2 squaresPart_{0.0};
    Lights slab_;  // [square][voxel]
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

std::optional<JoinedChange> JoinProbe::change(const JoinedVoxels& joined,
                                              const LinesThrough& lines) const {
    if (blocks_.empty()) return {};
    const ClassReader classes(classOfSlot_, nullptr, sliceAxis_);
    const std::size_t count = joined.within == 1 ? 128 : joined.within == 2 ? 96 : 48;
    std::vector<std::optional<Seen>> patches(count);
    parallelFor(count, [&](std::size_t i) {
        // Spreads patches over the volume in proportion to its blocks.
        std::mt19937 random{std::mt19937::result_type(i)};
        const auto part = [&] { return double(random()) * 0x1p-32; };
        for (int tried = 0; tried < kTries && !patches[i]; ++tried) {
            const double at = (double(i) + part()) / double(count);
            const CodeBlock& block = blocks_[std::size_t(at * double(blocks_.size()))];
            const std::optional<glm::ivec3> voxel = anySeen(block, classes, random());
            if (!voxel) continue;
            const glm::ivec3 xyz = fromSliceOrder(*voxel, sliceAxis_);
            const SightLines seenBy = lines(xyz);
            const glm::dvec2 within{part(), part()};  // evaluated in this order
            patches[i] =
                Tracer(*this, seenBy, joined, toSliceOrder(xyz, seenBy.sliceAxis), within).trace();
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
    // Too few patches give no estimate.
    if (4 * found < double(count) || !(most > 0)) return {};
    JoinedChange result;
    result.gained = gained / largestOf(seen);
    result.rms = std::sqrt(largestOf(squared) / found) / most;
    return result;
}

}  // namespace deltasplat
