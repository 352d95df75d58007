// SPDX-License-Identifier: Apache-2.0
// Based on: C. Zhang, R. Crawfis, Volumetric Shadows Using Splatting, 2002 (a light buffer carried
// from slice to slice), with slices of the volume instead of half-way slices.
#include "lighting/light_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "base/affine.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/threads.h"
#include "deltasplat/view/factorization.h"
#include "lighting/lit_blocks.h"
#include "lighting/point_sweep.h"
#include "lighting/sweep_kernels.h"
#include "optics/voxel_units.h"
#include "volume/leaf_slices.h"

namespace deltasplat {
namespace {

struct LightWay {
    /// @param way  in the world, finite, not 0
    LightWay(const glm::dmat4& worldFromIndex, const glm::dvec3& way);

    int sliceAxis;      ///< most parallel to the way, in voxels
    bool forward;       ///< towards larger slices
    glm::dvec2 shift;   ///< (u, v) from a slice to the next larger one
    double sliceWorld;  ///< world units per slice
};

/// The nodes of the swept plane that a block reads or writes.
struct PlaneReach : PlaneBox {
    int slice;  ///< first slice of the block
    LitBlocks::Along::Place place;
};

/// Extinction on the way of distant light to each voxel. In every slice, from where the light
/// enters, voxels first read the sums of earlier slices and then add their own extinction. The
/// plane of sums moves with the light, so values are blurred only twice, for any number of slices.
class LightSweep {
  public:
    /// @param blocks  along the way's slice axis; must outlive this
    /// @param origin  slice in which the plane coincides with the voxels
    /// @param met     extinction per slice on this way
    LightSweep(const LitBlocks::Along& blocks, const LightWay& way, int origin,
               const MetClasses& met);

    /// Rows of the plane, 0 without blocks. Strips of rows can be swept separately.
    std::int64_t rows() const { return lastRow_ - firstRow_; }
    double bytes(std::int64_t first, std::int64_t last) const {
        return double(sizeof(float)) * (double(last) - first + 1) * columns_;
    }
    /// Returns blocks in parts between which no light passes, if separate sweeps of the parts need
    /// much smaller planes. Sweeps of the parts from the same origin give the same result.
    std::vector<LitBlocks::Along> apart() const;
    /// Sweeps a strip; writes only the voxels that it reaches.
    /// @param first,last  rows [first, last) of [0, rows())
    /// @param depths      per block, `[x][y][z]`: square roots of extinction, in 1 / kDepthSteps
    void run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const;

  private:
    struct Strip;

    glm::dvec2 placeOf(int slice) const { return -(double(slice) - origin_) * way_.shift; }
    std::vector<PlaneReach> reaches() const;
    void findRows();
    void sweepSlice(const LitBlocks::Along::Group& group, int slice, Strip& strip) const;

    const LitBlocks::Along& blocks_;
    LightWay way_;
    int origin_;
    MetClasses met_;
    std::int64_t firstRow_ = 0;
    std::int64_t lastRow_ = 0;
    std::int64_t firstColumn_ = 0;
    std::int64_t columns_ = 0;
};

namespace {

// Extinctions that a slice of a block adds to the plane.
struct MetBlock {
    SweptPlace place;
    int end;  // of rows of the plane
    std::array<float, 64> own;
};

}  // namespace

LightWay::LightWay(const glm::dmat4& worldFromIndex, const glm::dvec3& way) {
    const glm::dvec3 indexWay = glm::inverse(glm::dmat3(worldFromIndex)) * unitVectorOf(way);
    sliceAxis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(indexWay[i]) > std::abs(indexWay[sliceAxis])) sliceAxis = i;
    const glm::ivec3 order = sliceOrder(sliceAxis);
    const double slices = indexWay[sliceAxis];  // in a world unit
    forward = slices > 0;
    shift = glm::dvec2(indexWay[order[1]], indexWay[order[2]]) / slices;
    sliceWorld = 1 / std::abs(slices);
}

// Rows [first, last] of the plane, one row more than the strip: voxels read between two rows.
struct LightSweep::Strip {
    std::int64_t first;
    std::int64_t last;
    std::uint16_t* depths;
    std::vector<float> plane;     // [last - first + 1][columns]
    std::vector<MetBlock> toAdd;  // of the current slice
};

LightSweep::LightSweep(const LitBlocks::Along& blocks, const LightWay& way, int origin,
                       const MetClasses& met)
    : blocks_(blocks), way_(way), origin_(origin), met_(met) {
    if (!blocks.order.empty()) findRows();
}

void LightSweep::findRows() {
    const PlaneBox all = boxOf(reaches());
    firstRow_ = all.least.x;
    lastRow_ = all.most.x;
    firstColumn_ = all.least.y;
    columns_ = all.most.y - all.least.y + 1;
}

std::vector<PlaneReach> LightSweep::reaches() const {
    std::vector<PlaneReach> all;
    all.reserve(blocks_.order.size());
    for (const LitBlocks::Along::Group& group : blocks_.groups) {
        const glm::i64vec2 ends[] = {glm::i64vec2(glm::floor(placeOf(group.firstSlice))),
                                     glm::i64vec2(glm::floor(placeOf(group.firstSlice + 7)))};
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const glm::i64vec2 first(blocks_.order[i].first);
            all.push_back({{first + glm::min(ends[0], ends[1]),
                            first + glm::max(ends[0], ends[1]) + std::int64_t{8}},
                           group.firstSlice,
                           blocks_.order[i]});
        }
    }
    return all;
}

std::vector<LitBlocks::Along> LightSweep::apart() const {
    constexpr double kSmallPlane = 1 << 20;
    std::vector<LitBlocks::Along> parts;
    for (const std::vector<PlaneReach>& some : partsAtGaps(reaches(), kSmallPlane)) {
        LitBlocks::Along& part = parts.emplace_back();
        part.sliceAxis = blocks_.sliceAxis;
        part.classes = blocks_.classes;
        for (const PlaneReach& one : some) part.add(one.slice, one.place);
    }
    return parts;
}

void LightSweep::run(std::int64_t first, std::int64_t last, std::uint16_t* depths) const {
    Strip strip{firstRow_ + first, firstRow_ + last, depths, {}, {}};
    strip.plane.resize(std::size_t(last - first + 1) * std::size_t(columns_));
    const std::size_t groups = blocks_.groups.size();
    for (std::size_t n = 0; n < groups; ++n) {
        const auto& group = blocks_.groups[way_.forward ? n : groups - 1 - n];
        for (int i = 0; i < 8; ++i)
            sweepSlice(group, group.firstSlice + (way_.forward ? i : 7 - i), strip);
    }
}

// All voxels of the slice read before any voxel adds.
void LightSweep::sweepSlice(const LitBlocks::Along::Group& group, int slice, Strip& strip) const {
    const glm::dvec2 place = placeOf(slice);
    const glm::dvec2 whole = glm::floor(place);
    const glm::i64vec2 base(whole);
    const glm::vec2 share(place - whole);
    const glm::ivec3 stride = toSliceOrder(kLeafStride, blocks_.sliceAxis);
    const auto sliceInBlock = std::size_t(slice - group.firstSlice);
    std::array<std::uint16_t, 64> codes;
    strip.toAdd.clear();
    for (std::size_t i = group.begin; i < group.end; ++i) {
        const LitBlocks::Along::Place& block = blocks_.order[i];
        const std::int64_t firstOfStrip = strip.first - (block.first.x + base.x);
        const std::int64_t lastOfStrip = strip.last - (block.first.x + base.x);
        if (lastOfStrip < 0 || firstOfStrip > 8) continue;
        const int begin = int(std::max<std::int64_t>(0, firstOfStrip));
        const int end = int(std::min<std::int64_t>(8, lastOfStrip));
        const std::int64_t column = block.first.y + base.y - firstColumn_;
        const SweptPlace swept{
            &strip.plane[std::size_t((begin - firstOfStrip) * columns_ + column)],
            std::size_t(columns_), begin, share};
        if (begin < end) {
            readSwept(swept, end, codes.data());
            std::uint16_t* out =
                strip.depths + 512 * block.number + sliceInBlock * std::size_t(stride.x);
            const std::uint16_t* code = codes.data() + std::ptrdiff_t{8} * begin;
            for (int u = begin; u < end; ++u) {
                for (int v = 0; v < 8; ++v) out[u * stride.y + v * stride.z] = *code++;
            }
        }
        MetBlock met{swept, int(std::min<std::int64_t>(9, lastOfStrip + 1)), {}};
        const std::uint16_t* classes = &(*blocks_.classes)[512 * block.number + 64 * sliceInBlock];
        if (lookUpMet(met_, classes, met.own.data())) strip.toAdd.push_back(met);
    }
    for (const MetBlock& met : strip.toAdd) addSwept(met.place, met.end, met.own.data());
}

}  // namespace

namespace {

// Sweeps for several lights, in pieces for threads.
class Sweeps {
  public:
    // @param most  extinction beyond which no light is left
    Sweeps(const LitBlocks& blocks, const Volume& volume, const std::vector<float>& extinctions,
           float most)
        : blocks_(blocks), volume_(volume), extinctions_(extinctions), most_(most) {}

    void add(const Light& light, const glm::dvec3& placeIndex);
    // @param depths  in the order of add(), [lights][voxels]
    void run(std::uint16_t* depths) const;

  private:
    using Sweep = std::variant<LightSweep, PointSweep>;
    struct Piece {
        std::size_t sweep;
        std::int64_t first;
        std::int64_t last;
    };

    const LitBlocks::Along& along(int sliceAxis);
    void addPoint(const glm::dvec3& placeIndex);
    std::vector<Piece> pieces() const;

    const LitBlocks& blocks_;
    const Volume& volume_;
    const std::vector<float>& extinctions_;
    float most_;
    std::array<std::optional<LitBlocks::Along>, 3> along_;
    std::deque<LitBlocks::Along> apart_;  // parts that lie far apart
    std::vector<Sweep> sweeps_;
    std::vector<std::size_t> lights_;  // [sweeps]
    std::size_t lightCount_ = 0;
};

const LitBlocks::Along& Sweeps::along(int sliceAxis) {
    auto& along = along_[std::size_t(sliceAxis)];
    if (!along) along.emplace(blocks_.along(sliceAxis));
    return *along;
}

void Sweeps::add(const Light& light, const glm::dvec3& placeIndex) {
    if (light.positionWorld) {
        addPoint(placeIndex);
    } else {
        const LightWay way(volume_.worldFromIndex(), light.direction);
        const auto sweepOf = [&](const LitBlocks::Along& blocks) {
            return LightSweep(blocks, way, volume_.box().min[way.sliceAxis],
                              MetClasses{extinctions_.data(), float(way.sliceWorld), most_});
        };
        const LightSweep all = sweepOf(along(way.sliceAxis));
        constexpr double kLargePlane = 1 << 24;  // bytes
        if (all.bytes(0, all.rows()) <= kLargePlane) {
            sweeps_.emplace_back(all);
        } else {
            for (LitBlocks::Along& part : all.apart())
                sweeps_.emplace_back(sweepOf(apart_.emplace_back(std::move(part))));
        }
    }
    lights_.resize(sweeps_.size(), lightCount_++);
}

// Moves a very far light closer: nearly the same direction, but precise coordinates.
void Sweeps::addPoint(const glm::dvec3& placeIndex) {
    constexpr double kFarthest = 1e9;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(volume_.box().min) + glm::dvec3(volume_.box().max));
    const glm::dvec3 away = placeIndex - middle;
    const glm::dvec3 parts = glm::abs(away);
    const double farthest = std::max({parts.x, parts.y, parts.z});
    const glm::dvec3 place =
        farthest > kFarthest ? middle + kFarthest / farthest * away : placeIndex;
    const glm::dmat3 world(volume_.worldFromIndex());
    for (int axis = 0; axis < 3; ++axis) {
        const double slice = planeDistance(volume_.worldFromIndex(), axis);
        const glm::ivec3 order = sliceOrder(axis);
        const PointPlace light{
            {place[order.x], place[order.y], place[order.z]},
            glm::dmat3(world[order.x] / slice, world[order.y] / slice, world[order.z] / slice)};
        for (const bool forward : {true, false})
            sweeps_.emplace_back(PointSweep(along(axis), light, forward,
                                            MetClasses{extinctions_.data(), float(slice), most_}));
    }
}

// Enough pieces to keep every thread busy, but none so narrow that shared rows at the edges take
// much of the work. Narrow pieces of a plane may need much less memory.
std::vector<Sweeps::Piece> Sweeps::pieces() const {
    constexpr std::size_t kPiecesPerThread = 4;
    constexpr std::int64_t kLeastRows = 16;
    constexpr double kLargePlane = 1 << 26;  // bytes
    constexpr double kMostStrips = 1024;
    const auto threads = std::size_t(threadCount());
    const auto wanted =
        threads == 1 ? 1 : (kPiecesPerThread * threads + lightCount_ - 1) / lightCount_;
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < sweeps_.size(); ++i) {
        const auto rows = std::visit([](const auto& sweep) { return sweep.rows(); }, sweeps_[i]);
        if (rows == 0) continue;
        const double large =
            std::visit([&](const auto& sweep) { return sweep.bytes(0, rows); }, sweeps_[i]) /
            kLargePlane;
        const auto most = std::max<std::int64_t>(1, rows / kLeastRows);
        const auto strips = std::int64_t(
            std::clamp(std::max(double(wanted), std::min(large, kMostStrips)), 1.0, double(most)));
        const auto edge = [&](std::int64_t n) { return rows * n / strips; };
        for (std::int64_t n = 0; n < strips; ++n) pieces.push_back({i, edge(n), edge(n + 1)});
    }
    return pieces;
}

void Sweeps::run(std::uint16_t* depths) const {
    const std::vector<Piece> all = pieces();
    std::vector<double> bytes(all.size() + 1);
    parallelFor(all.size(), [&](std::size_t i) {
        const Piece& piece = all[i];
        bytes[i] = std::visit([&](const auto& s) { return s.bytes(piece.first, piece.last); },
                              sweeps_[piece.sweep]);
    });
    // Each thread holds one piece.
    requireMemory("a plane that light is swept through",
                  *std::max_element(bytes.begin(), bytes.end()) *
                      std::min<double>(threadCount(), double(all.size())));
    parallelFor(all.size(), [&](std::size_t i) {
        const Piece& piece = all[i];
        std::uint16_t* out = depths + 512 * blocks_.size() * lights_[piece.sweep];
        std::visit([&](const auto& s) { s.run(piece.first, piece.last, out); },
                   sweeps_[piece.sweep]);
    });
}

// Per world unit, [classes].
std::vector<float> extinctionsOf(const ClassTable& classes) {
    constexpr double kMost = 1e30;
    std::vector<float> extinctions;
    for (const double depth : depthsOf(classes, 1))
        extinctions.push_back(float(std::min(depth, kMost)));
    return extinctions;
}

}  // namespace

LightDepths::LightDepths(const Volume& volume, const ClassTable& classes,
                         const std::vector<Light>& lights, int octaves)
    : blocks_(volume, classes) {
    const std::size_t voxels = 512 * blocks_.size();
    requireMemory("light on its way to voxels",
                  double(sizeof(std::uint16_t)) * double(voxels) * double(lights.size()));
    depths_ =
        UnclearedArray<std::uint16_t>(voxels * lights.size(), *std::pmr::get_default_resource());
    reaches_.resize(lights.size());
    if (voxels == 0 || lights.empty()) return;
    // Largest extinction of a wall's voxel that matters to the least dimmed octave. Larger values
    // would only widen shadows, because nodes of the plane share them.
    constexpr float kMost = 10;
    const float most = std::min(kMost * float(1 << octaves), 1000.0f);
    const std::vector<float> extinctions = extinctionsOf(classes);
    Sweeps sweeps(blocks_, volume, extinctions, most);
    const glm::dmat3 world(volume.worldFromIndex());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const glm::dvec3 placeIndex =
            glm::inverse(world) *
            (light.positionWorld.value_or(glm::dvec3(0)) - glm::dvec3(volume.worldFromIndex()[3]));
        if (light.positionWorld) reaches_[i] = blocks_.reachFrom(placeIndex, world);
        sweeps.add(light, placeIndex);
    }
    sweeps.run(&depths_[0]);
}

}  // namespace deltasplat
