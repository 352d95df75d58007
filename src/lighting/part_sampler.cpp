// SPDX-License-Identifier: Apache-2.0
#include "lighting/part_sampler.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <memory>

#include "base/affine.h"
#include "base/memory.h"
#include "deltasplat/ingest/slot.h"
#include "deltasplat/optics/class_table.h"
#include "optics/color_curve.h"
#include "optics/color_digits.h"
#include "optics/color_space.h"
#include "volume/code_blocks.h"
#include "volume/code_tree.h"
#include "volume/leaf_slices.h"

namespace deltasplat {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
// Tolerance, in voxels, for two grids to count as the same.
constexpr double kSameWithin = 1e-3;
// Most samples per axis for the mean of a finer grid's voxels.
constexpr int kMostSamples = 8;

// The largest movement of any voxel of a box, apart from a movement by whole voxels.
double moveWithin(const glm::dmat4& map, const IndexBox& box) {
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = cornerOf(box, corner);
        const glm::dvec3 to(map * glm::dvec4(at, 1));
        const glm::dvec3 away = to - at - glm::round(glm::dvec3(map[3]));
        most = std::max({most, std::abs(away.x), std::abs(away.y), std::abs(away.z)});
    }
    return most;
}

openvdb::Coord coordOf(const glm::dvec3& at) {
    return {int(at.x), int(at.y), int(at.z)};
}

bool isNear(const glm::dvec3& at) {
    constexpr double kFar = 0x1p30;
    return std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) < kFar;
}

IndexBox boxOfSeen(const CodeBlock& block, std::span<const Slot> slotMap) {
    const glm::ivec3 first = 8 * block.position;
    if (!block.leaf) return {first, first + 7};
    BlockSlots slots;
    readLeafSlices(
        *block.leaf, 0, [&](Code code) { return slotMap[std::size_t(code) + 1]; }, slots.data());
    IndexBox box{glm::ivec3(std::numeric_limits<int>::max()),
                 glm::ivec3(std::numeric_limits<int>::min())};
    for (int n = 0; n < 512; ++n) {
        if (slots[std::size_t(n)] == kEmptySlot) continue;
        const glm::ivec3 at = first + glm::ivec3(n / 64, n / 8 % 8, n % 8);
        box.min = glm::min(box.min, at);
        box.max = glm::max(box.max, at);
    }
    return box;
}

// Voxels of a part per voxel of the volume, along each axis of the volume.
glm::dvec3 voxelsPerStep(const glm::dmat4& partFromIndex) {
    glm::dvec3 voxels;
    for (int axis = 0; axis < 3; ++axis)
        voxels[axis] = glm::length(glm::dvec3(partFromIndex[axis]));
    return voxels;
}

// From this ratio on voxels are averaged.
constexpr double kFinerFrom = 1.5;

glm::ivec3 samplesOf(const glm::dmat4& partFromIndex) {
    const glm::dvec3 voxels = voxelsPerStep(partFromIndex);
    glm::ivec3 samples(1);
    for (int axis = 0; axis < 3; ++axis) {
        if (voxels[axis] >= kFinerFrom)
            samples[axis] = std::min(kMostSamples, int(std::ceil(voxels[axis])));
    }
    return samples;
}

}  // namespace

PartFit fitOf(const Volume& part, const glm::dmat4& worldFromIndex) {
    const glm::dmat4 partFromIndex = glm::inverse(part.worldFromIndex()) * worldFromIndex;
    // Map to the voxels of the volume that read the part.
    const glm::dmat4 indexFromPart = glm::inverse(partFromIndex);
    const glm::dvec3 away = glm::round(glm::dvec3(indexFromPart[3]));
    if (isNear(away) && moveWithin(indexFromPart, part.box()) < kSameWithin) return PartFit::kSame;
    const bool isFiner =
        glm::any(glm::greaterThanEqual(voxelsPerStep(partFromIndex), glm::dvec3(kFinerFrom)));
    return isFiner ? PartFit::kFiner : PartFit::kBetween;
}

// Reads single voxels. Not thread-safe.
class PartSampler::Reader {
  public:
    explicit Reader(const CodeTree& codes) : accessor_(codes.tree()) {}

    std::optional<Code> codeAt(const glm::dvec3& at) const {
        Code code = 0;
        if (!isNear(at) || !accessor_.probeValue(coordOf(at), code)) return {};
        return code;
    }

  private:
    openvdb::tree::ValueAccessor<const CodeTree::Tree, false> accessor_;
};

PartSampler::PartSampler(const Volume& part, const glm::dmat4& worldFromIndex, Around around)
    : part_(part),
      codes_(part.codes() ? part.codes() : std::make_shared<const CodeTree>()),
      around_(around),
      partFromIndex_(glm::inverse(part.worldFromIndex()) * worldFromIndex),
      fit_(fitOf(part, worldFromIndex)),
      samples_(samplesOf(partFromIndex_)),
      background_(part.hasBackground() ? part.background() : 0) {
    makeLevels();
}

void PartSampler::makeLevels() {
    levels_ = part_.withoutVoxels();
    if (fit_ == PartFit::kSame) return;
    CodeBook::Range range{std::min(part_.valueMin(), background_),
                          std::max(part_.valueMax(), background_), 0, CodeBook::Values::kDouble};
    const double most = std::max({std::abs(range.low), std::abs(range.high), 1e-300});
    range.least = std::max(most * 0x1p-22, 1e-306);
    double error = 1.25e-4;
    std::optional<CodeBook> book;
    while (!book) {
        book = CodeBook::relative(range, error);
        error *= 1.25;
    }
    VolumeData levels = levels_.data();
    levels.codeBook = *book;
    levels.histogram.assign(kCodeCount, 0);
    std::fill_n(levels.histogram.begin(), book->table->size(), std::uint64_t{1});
    levels_ = Volume(std::move(levels));
    encoder_.emplace(levels_.codeBook());
    valueOfCode_.resize(kCodeCount, kNothing);
    for (std::size_t code = 0; code < part_.histogram().size(); ++code)
        if (part_.histogram()[code] != 0) valueOfCode_[code] = part_.codeBook().valueOf(Code(code));
}

// Interpolates between the eight voxels around a place.
double PartSampler::valueOf(const Reader& reader, const glm::dvec3& at) const {
    const glm::dvec3 first = glm::floor(at);
    const glm::dvec3 share = at - first;
    double sum = 0;
    double active = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 weights = glm::mix(1.0 - share, share, side);
        const double weight = weights.x * weights.y * weights.z;
        if (weight == 0) continue;
        const std::optional<Code> code = reader.codeAt(first + side);
        if (code) active += weight;
        if (code || around_ == Around::kBackground)
            sum += weight * (code ? valueOfCode_[*code] : background_);
    }
    if (active == 0) return kNothing;
    return around_ == Around::kBackground ? sum : sum / active;
}

// Averages the voxels nearest to evenly spaced places.
double PartSampler::meanOf(const Reader& reader, const glm::dvec3& at) const {
    double sum = 0;
    int active = 0;
    const glm::dmat3 steps(partFromIndex_);
    const glm::dvec3 per(samples_);
    for (int x = 0; x < samples_.x; ++x) {
        for (int y = 0; y < samples_.y; ++y) {
            for (int z = 0; z < samples_.z; ++z) {
                const glm::dvec3 within = (glm::dvec3(x, y, z) + 0.5) / per - 0.5;
                const std::optional<Code> code =
                    reader.codeAt(glm::floor(at + steps * within + 0.5));
                if (code) {
                    ++active;
                    sum += valueOfCode_[*code];
                } else if (around_ == Around::kBackground) {
                    sum += background_;
                }
            }
        }
    }
    if (active == 0) return kNothing;
    return sum / (around_ == Around::kBackground ? per.x * per.y * per.z : active);
}

void PartSampler::read(const BlockPlace& place, std::span<Slot, 512> slots) const {
    const Reader reader(*codes_);
    const glm::dvec3 first(partFromIndex_ * glm::dvec4(place.first, 1));
    const glm::dmat3 steps = glm::dmat3(partFromIndex_) * place.steps;
    for (int n = 0; n < 512; ++n) {
        const glm::dvec3 at = first + steps * glm::dvec3(n / 64, n / 8 % 8, n % 8);
        Slot& slot = slots[std::size_t(n)];
        if (fit_ == PartFit::kSame) {
            const std::optional<Code> code = reader.codeAt(glm::floor(at + 0.5));
            slot = code ? *code + 1 : kEmptySlot;
            continue;
        }
        const double value = fit_ == PartFit::kFiner ? meanOf(reader, at) : valueOf(reader, at);
        slot = std::isnan(value) ? kEmptySlot : (*encoder_)(value) + 1;
    }
}

// Returns the volume's voxels that may read any voxel of a box of the grid.
IndexBox PartSampler::reachOf(const IndexBox& box) const {
    const glm::dmat4 indexFromPart = glm::inverse(partFromIndex_);
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(indexFromPart * glm::dvec4(cornerOf(box, corner), 1));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    if (fit_ == PartFit::kSame) return {glm::ivec3(glm::round(low)), glm::ivec3(glm::round(high))};
    // One voxel of the grid per side and, for means, half a voxel of the volume.
    for (int axis = 0; axis < 3; ++axis) {
        double voxel = 0.5;
        for (int i = 0; i < 3; ++i) voxel += std::abs(indexFromPart[i][axis]);
        low[axis] = std::ceil(low[axis] - voxel);
        high[axis] = std::floor(high[axis] + voxel);
    }
    const glm::dvec3 far(0x1p29);
    return {glm::ivec3(glm::clamp(low, -far, far)), glm::ivec3(glm::clamp(high, -far, far))};
}

// Returns a map [kSlotCount] of the visible codes. All codes count as visible if interpolation
// between invisible values may give visible ones.
std::vector<Slot> PartSampler::seenCodes(std::span<const Slot> slotMap) const {
    std::vector<int> before(kSlotCount + 1, 0);
    for (std::size_t slot = 0; slot < kSlotCount; ++slot)
        before[slot + 1] = before[slot] + (slotMap[slot] != kEmptySlot);
    const auto levelOf = [&](std::size_t code) {
        return fit_ == PartFit::kSame ? code + 1 : std::size_t((*encoder_)(valueOfCode_[code])) + 1;
    };
    std::optional<int> side;
    if (fit_ != PartFit::kSame) side = before[std::size_t((*encoder_)(background_)) + 1];
    bool bothSides = false;
    std::vector<Slot> seen(kSlotCount, kEmptySlot);
    std::vector<Slot> all = seen;
    for (std::size_t code = 0; code < part_.histogram().size(); ++code) {
        if (part_.histogram()[code] == 0) continue;
        const std::size_t level = levelOf(code);
        all[code + 1] = Slot(code + 1);
        if (slotMap[level] != kEmptySlot) {
            seen[code + 1] = Slot(code + 1);
            continue;
        }
        bothSides = bothSides || (side && *side != before[level]);
        side = before[level];
    }
    return bothSides && fit_ != PartFit::kSame ? all : seen;
}

void PartSampler::addBlocksSeen(std::span<const Slot> slotMap, PlaceSet& places,
                                IndexBox& box) const {
    const std::vector<Slot> seen = seenCodes(slotMap);
    const BlockReader reader(*codes_, nullptr, 0, seen);
    constexpr double kBytesPerPlace = 96;
    for (const CodeBlock& block : reader.blocks()) {
        const IndexBox reach = reachOf(boxOfSeen(block, seen));
        if (reach.empty()) continue;
        box = boxOfBoth(box, reach);
        const glm::ivec3 low = reach.min >> 3;
        const glm::ivec3 high = reach.max >> 3;
        const glm::dvec3 count(high - low + 1);
        requireMemory("blocks of another grid",
                      kBytesPerPlace * (double(places.size()) + count.x * count.y * count.z));
        for (int x = low.x; x <= high.x; ++x) {
            for (int y = low.y; y <= high.y; ++y) {
                for (int z = low.z; z <= high.z; ++z) places.insert({x, y, z});
            }
        }
    }
}

Volume withRoom(const Volume& volume, const BlockSet& more) {
    if (more.positions.empty()) return volume;
    VolumeData wide = volume.data();
    if (!wide.codes) wide.codes = std::make_shared<const CodeTree>();
    if (volume.empty()) wide.activeCount = 1;
    wide.box = volume.empty() ? more.box : boxOfBoth(volume.box(), more.box);
    return Volume(std::move(wide));
}

namespace {

constexpr std::size_t kMostLooks = 65536;

// Numbers the looks of all values that occur, in increasing order of values.
template <typename LookOf>
PartLooks numbered(const Volume& levels, const LookOf& lookOf) {
    PartLooks result{{PartLook{}}, std::vector<std::uint16_t>(kSlotCount)};
    for (std::size_t code = 0; code < levels.histogram().size(); ++code) {
        if (levels.histogram()[code] == 0) continue;
        const PartLook look = lookOf(levels.codeBook().valueOf(Code(code)));
        if (look == PartLook{}) continue;
        const bool isNew = result.looks.size() == 1 || !(look == result.looks.back());
        // If there are too many looks, the last ones share a number.
        if (isNew && result.looks.size() < kMostLooks) result.looks.push_back(look);
        result.ofSlot[code + 1] = std::uint16_t(result.looks.size() - 1);
    }
    return result;
}

// Range of the grid itself, not of its levels.
glm::dvec2 rangeOf(const MediumPart& part) {
    return part.range.value_or(defaultRange(*part.volume));
}

PartLooks lookUpAbsorption(const MediumPart& part, const Volume& levels) {
    Optics optics;
    optics.transferFunction = part.transferFunction;
    optics.range = rangeOf(part);
    optics.unitDistance = 1;
    optics.extinctionScale = part.strength;
    const ClassTable classes = classify(levels, optics, 1);
    PartLooks result;
    result.ofSlot.assign(classes.slots->begin(), classes.slots->end());
    for (const Look& look : classes.looks)
        result.looks.push_back({look.extinction * part.strength, look.color, {}});
    return result;
}

}  // namespace

PartLook PartLooks::largest() const {
    PartLook most;
    for (const PartLook& look : looks) {
        most.extinction = std::max(most.extinction, look.extinction);
        most.color = glm::max(most.color, look.color);
        most.glow = glm::max(most.glow, look.glow);
    }
    return most;
}

PartLooks lookUpPart(const MediumPart& part, const Volume& levels, double unitDistances) {
    if (part.kind == MediumPart::Kind::kAbsorption) return lookUpAbsorption(part, levels);
    const double least = kLeastGlow / std::max(unitDistances, 1.0);
    const auto seen = [&](const glm::dvec3& glow) {
        const bool isSeen = std::max({glow.x, glow.y, glow.z}) >= least;
        return PartLook{0, {}, isSeen ? glow : glm::dvec3(0)};
    };
    if (part.kind == MediumPart::Kind::kBlackbody) {
        return numbered(levels, [&](double value) {
            const double kelvin = part.kelvinScale * value + part.kelvinOffset;
            return seen(part.strength * blackbodyGlow(std::min(kelvin, kHottestKelvin)));
        });
    }
    const TransferFunction& function = part.transferFunction;
    const ColorCurve colors(function);
    const FunctionPlace placeOf(function, *part.volume, part.range);
    return numbered(levels, [&](double value) {
        const double x = placeOf(value);
        return seen(part.strength * function.opacityAt(x) * colors.at(x));
    });
}

}  // namespace deltasplat
